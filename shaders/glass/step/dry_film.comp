// dry_film.comp - film evaporates, some rows in each tick.
// One invocation per cell of those rows. Reads: tick. Writes: film, counters.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

shared uint evaporated;

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        evaporated = 0u;
    barrier();
    const uint i = gl_GlobalInvocationID.x;
    if (i < tick.rolling_rows * tick.pane.columns) {
        const uint cell = tick.rolling_row * tick.pane.columns + i, here = film[cell];
        if (here != 0u) {
            const float dries_nl = tick.evaporation_m_s * tick.rolling_s * tick.pane.cell_m * tick.pane.cell_m * 1e12;
            const uint lost = min(round_randomly(dries_nl, virga_hash3(tick.pane.seed, tick.tick, cell)), here);
            film[cell] = here - lost;
            atomicAdd(evaporated, lost);
        }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        count(VIRGA_GLASS_EVAPORATED, evaporated);
}
