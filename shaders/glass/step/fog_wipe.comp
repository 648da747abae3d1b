// fog_wipe.comp - a blade takes up the fog that it sweeps, into its bins. As wipe_film.comp, before lay_film.comp.
// One invocation per cell. Reads: the blade. Writes: fog, the blade's bins, counters.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "blades.glsl"
#include "blade_film.glsl"
#include "fog.glsl"

void main()
{
    begin_fog_sums();
    uint cell;
    vec2 middle;
    if (find_cell(cell, middle)) {
        const uint water = take_fog(cell);
        if (water != 0u)
            atomicAdd(state.bins_nl[bin_at(blade, to_blade_now(blade, middle).y)], water);
    }
    end_fog_sums();
}
