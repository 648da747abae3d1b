// lay_film.comp - the water in a blade's bins becomes the film that the blade leaves behind. If a bin holds less than
// its cells ask for, each gets the same share. What is given is summed apart from the bins, so that all cells see the
// same bin; empty_bins.comp takes it out.
// One invocation per cell. Reads: the blade, its bins. Writes: film, passed, what the bins have given.
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
    const uint held = state.bins_nl[bin], asked = state.asked_nl[bin];
    // A little less than its share: the sum of roundings up could be more than there is.
    const float share = held >= asked ? 1.0 : float(held) / float(asked) * 0.999999;
    const uint given = here < left ? uint(float(left - here) * share) : 0u;
    if (given == 0u)
        return;
    film[cell] = here + given;
    mark_film(cell);
    passed[cell] = wetted_now();
    atomicAdd(state.given_nl[bin], given);
}
