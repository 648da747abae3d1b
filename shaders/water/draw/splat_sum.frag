// splat_sum.frag - adds up the splats that lie on the nearest surface of water.
// One invocation per pixel of a splat. Writes: sums of facing, view depth and weight; sums of motion, and of weight and
// view depth of specks, see specks.glsl.
#version 460
layout(location = 0) in vec2 position;
layout(location = 1) flat in vec3 facing_weight;
layout(location = 2) flat in vec2 motion;

layout(location = 0) out vec4 sums;
layout(location = 1) out vec4 motion_sums;

void main()
{
    const float inside = max(1.0 - dot(position, position), 0.0);
    const float weight = abs(facing_weight.z) * inside * inside, depth = 1.0 / gl_FragCoord.w;
    const float of_surface = facing_weight.z < 0.0 ? 0.0 : weight;
    sums = vec4(facing_weight.xy, depth, 1.0) * of_surface;
    motion_sums = vec4(motion, vec2(1.0, depth) * step(facing_weight.z, 0.0)) * weight;
}
