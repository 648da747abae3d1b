// volume_merge.comp - the thickness of the water, from all levels of the pyramid.
// One invocation per texel of the finest level. Reads: pyramid, prepared.levels. Writes: thickness (m).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "pyramid.glsl"
#include "prepared.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 13, r32f) uniform writeonly image2D thickness;

float units_at(uint level, ivec2 texel, ivec2 size)
{
    const ivec2 inside = clamp(texel, ivec2(0), size - 1);
    return float(pyramid[look.volume_first[level] + uint(inside.y * size.x + inside.x)]);
}

void main()
{
    const ivec2 here = ivec2(gl_GlobalInvocationID.xy);
    if (here.x >= int(look.volume_columns) || here.y >= int(look.volume_rows))
        return;
    float units = 0.0;
    for (uint level = 0u; level < VIRGA_WATER_VOLUME_LEVELS; level++) {
        if ((prepared.levels & 1u << level) == 0u)
            continue;
        const ivec2 size = ivec2(level_size(level));
        const vec2 at = (vec2(here) + 0.5) / float(1u << level) - 0.5, low = floor(at), share = at - low;
        const ivec2 texel = ivec2(low);
        const vec2 rows = mix(vec2(units_at(level, texel, size), units_at(level, texel + ivec2(0, 1), size)),
                              vec2(units_at(level, texel + ivec2(1, 0), size),
                                   units_at(level, texel + ivec2(1, 1), size)), share.x);
        units += mix(rows.x, rows.y, share.y);
    }
    imageStore(thickness, here, vec4(units / VIRGA_WATER_VOLUME_UNITS));
}
