// fog_begin.comp - the fog that is on the pane when condensation begins.
// One invocation per cell. Reads: the surface. Writes: fog, counters.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "fog.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

shared uint condensed[2]; // pl: the rest, and millions

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        condensed[0] = condensed[1] = 0u;
    barrier();
    const uint cell = gl_GlobalInvocationID.x;
    if (cell < cell_count() && on_pane(cell_coordinates(cell))) {
        const uint water = round_randomly(tick.fog_start_pl, virga_hash3(tick.pane.seed, 0x666f67u, cell));
        film[fog_word(cell)] += water;
        atomicAdd(condensed[0], water % 1000000u);
        atomicAdd(condensed[1], water / 1000000u);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        count_pl(VIRGA_GLASS_CONDENSED, condensed[1], condensed[0]);
}
