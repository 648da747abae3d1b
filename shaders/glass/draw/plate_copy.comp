// plate_copy.comp - copies the plate to 256 x 256 texels, each the mean of the pixels of its part. A pixel that lies in
// two parts counts by its area in each, so the copies have all light of a lamp wherever it is. A workgroup has one row
// of texels: so a CPU reads a few rows of the plate from end to end. Square workgroups, which jump from row to row,
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
    const vec2 part = vec2(size) / float(VIRGA_GLASS_COPY), from = vec2(at) * part, to = from + part;
    vec3 sum = vec3(0.0);
    for (int y = low.y; y < high.y; y++) {
        const float tall = min(float(y) + 1.0, to.y) - max(float(y), from.y);
        for (int x = low.x; x < high.x; x++) {
            const vec3 color = host_color(texelFetch(scene_color, ivec2(x, y), 0).rgb, view.color_given);
            const float wide = min(float(x) + 1.0, to.x) - max(float(x), from.x);
            sum += wide * tall * min(color, vec3(60000.0));
        }
    }
    imageStore(copies_out, at, vec4(sum / (part.x * part.y), 1.0));
}
