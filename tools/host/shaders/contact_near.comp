#version 460
// contact_near.comp - for each workgroup of contact.comp, the highest top of anything that its shade may come from. It
// is found in two runs: with TILES for what stands on the workgroup's own texels, then for all workgroups within reach.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"
#include "contact_maps.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef TILES
layout(set = 0, binding = 6, r32f) uniform writeonly image2D highest;

float highest_of(ivec2 tile)
{
    float most = 0.0;
    for (int i = 0; i < CONTACT_TILE * CONTACT_TILE; i++)
        most = max(most, over_at(tile * CONTACT_TILE + ivec2(i % CONTACT_TILE, i / CONTACT_TILE)));
    return most;
}
#else
layout(set = 0, binding = 7) uniform sampler2D tiles;
layout(set = 0, binding = 8, r32f) uniform writeonly image2D highest;

float highest_of(ivec2 tile)
{
    const int reach = int(ceil(CONTACT_REACH_M / (push.texel_m * CONTACT_TILE))) + 1;
    const ivec2 last = textureSize(tiles, 0) - 1;
    const ivec2 from = max(tile - reach, ivec2(0)), to = min(tile + reach, last);
    float most = 0.0;
    for (int y = from.y; y <= to.y; y++)
        for (int x = from.x; x <= to.x; x++)
            most = max(most, texelFetch(tiles, ivec2(x, y), 0).r);
    return most;
}
#endif

void main()
{
    const ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(tile, imageSize(highest))))
        imageStore(highest, tile, vec4(highest_of(tile)));
}
