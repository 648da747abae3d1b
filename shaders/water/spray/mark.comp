// mark.comp - the list of splash particles, first pass: picks particles of low density.
// One invocation per sorted particle. Reads: densities. Writes: picks.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#include "water/spray_part.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_PICKS_BINDING 7
#define COMPACT_LIST_BINDING 9
#include "gpu/compact_mark.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint own = gl_GlobalInvocationID.x;
    bool picked = false;
    if (own < grid.sorted)
        picked = spray_part(densities[sorted_indices[own]]) > 0.0;
    mark_pick(picked ? FIRST_KIND : NOT_PICKED);
}
