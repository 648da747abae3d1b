// wipe_film.comp - a blade takes up the film that it sweeps, into bins along the blade, but for a thin film that it
// leaves behind. Where there is less than that, it asks its bins for water: lay_film.comp.
// One invocation per cell. Reads: the blade. Writes: film, passed, the blade's bins and what they are asked for.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "blades.glsl"
#include "blade_film.glsl"

void main()
{
    uint cell;
    vec2 middle;
    if (!find_cell(cell, middle))
        return;
    const float along_m = to_blade_now(blade, middle).y;
    const uint here = film[cell], left = left_on(cell, along_m), bin = bin_at(blade, along_m);
    if (here < left)
        atomicAdd(state.asked_nl[bin], left - here);
    if (here == 0u)
        return;
    film[cell] = min(here, left);
    passed[cell] = wetted_now();
    if (here > left)
        atomicAdd(state.bins_nl[bin], here - left);
}
