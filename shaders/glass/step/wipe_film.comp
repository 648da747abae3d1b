// wipe_film.comp - a blade takes up the film that it sweeps, into bins along the blade. A thin film stays, thicker in
// the streaks of a worn blade. One dispatch per blade, over the rectangle of cells around it.
// One invocation per cell. Reads: the blade. Writes: film, passed, the blade's bins.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "blades.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant) uniform Box
{
    uint blade;
    uint low_column, low_row, columns, rows;
};

// How much more or less film than its mean a blade leaves at a position along it. Streaks are some millimetres wide and
// always at the same positions.
float streak_factor(uint i, float along_m)
{
    const uint stripe = uint(int(floor(along_m / 0.003)) + 4096);
    const float random = virga_unit(virga_hash2(tick.blades[i].random, stripe));
    return mix(1.0, random > 0.85 ? 6.0 : 0.4, tick.blades[i].wear);
}

void main()
{
    if (gl_GlobalInvocationID.x >= columns || gl_GlobalInvocationID.y >= rows)
        return;
    const uint cell = low_column + gl_GlobalInvocationID.x + (low_row + gl_GlobalInvocationID.y) * tick.pane.columns;
    const vec2 middle = cell_middle(cell);
    const uint here = film[cell];
    if (here == 0u || !is_swept(blade, middle, middle, 0.0))
        return;
    const vec2 local = to_blade_now(blade, middle);
    const float kept_nl =
        tick.blades[blade].film_m * streak_factor(blade, local.y) * tick.pane.cell_m * tick.pane.cell_m * 1e12;
    const uint kept = min(here, uint(kept_nl));
    film[cell] = kept;
    passed[cell] = tick.tick;
    atomicAdd(state.bins_nl[bin_at(blade, local.y)], here - kept);
}
