// splat_sum.frag - adds up the splats that lie on the nearest surface of water.
//
// Where a part of the water is not there (see surface/cover.comp), its surface lets so much of what is behind it
// through: its splats count by their share, and what is missing of their weights is subtracted from the sum of the
// weights of specks. See missing_of in surface.glsl.
//
// One invocation per pixel of a splat. Writes: sums of facing, view depth and weight; sums of motion, and of weight and
// view depth of specks, see specks.glsl.
#version 460
layout(location = 0) in vec2 position;
layout(location = 1) flat in vec4 facing_weight; // w: the share that is there
layout(location = 2) flat in vec2 motion;

layout(location = 0) out vec4 sums;
layout(location = 1) out vec4 motion_sums;

void main()
{
    const float inside = max(1.0 - dot(position, position), 0.0);
    const float weight = abs(facing_weight.z) * inside * inside, depth = 1.0 / gl_FragCoord.w;
    const bool is_speck = facing_weight.z < 0.0;
    const float there = facing_weight.w * weight;
    sums = vec4(facing_weight.xy, depth, 1.0) * (is_speck ? 0.0 : there);
    motion_sums = vec4(motion * there, is_speck ? vec2(weight, weight * depth) : vec2(there - weight, 0.0));
}
