// part_sum.frag - adds up the colors of parts of surfels that lie on the nearest surface of water.
// One invocation per pixel of a part. Writes: sums of color and weight.
#version 460
layout(location = 0) in vec2 position;
layout(location = 1) flat in vec4 color_weight;

layout(location = 0) out vec4 sums;

void main()
{
    const float inside = max(1.0 - dot(position, position), 0.0);
    sums = vec4(color_weight.rgb, 1.0) * (color_weight.w * inside * inside);
}
