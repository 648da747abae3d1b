// plate_copy.comp - copies the plate to 256 x 256 texels, each the mean of the pixels of its part. A workgroup has one
// row of texels: so a CPU reads a few rows of the plate from end to end. Square workgroups, which jump from row to row,
// took half as long again.
// One invocation per texel. Reads: the plate. Writes: the largest copy.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/host_color.glsl"

layout(local_size_x = VIRGA_GLASS_COPY) in;
layout(set = 0, binding = 13, rgba16f) uniform image2D copies_out;
layout(set = 0, binding = 16) uniform sampler2D scene_color;

void main()
{
    const ivec2 size = textureSize(scene_color, 0), at = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 low = at * size / VIRGA_GLASS_COPY;
    const ivec2 high = max(((at + 1) * size + VIRGA_GLASS_COPY - 1) / VIRGA_GLASS_COPY, low + 1);
    vec3 sum = vec3(0.0);
    for (int y = low.y; y < high.y; y++)
        for (int x = low.x; x < high.x; x++)
            sum += min(host_color(texelFetch(scene_color, ivec2(x, y), 0).rgb, view.color_given), vec3(60000.0));
    const ivec2 count = high - low;
    imageStore(copies_out, at, vec4(sum / float(count.x * count.y), 1.0));
}
