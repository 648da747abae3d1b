// rings.glsl - rings on puddles: where their records lie, how deep a crater a drop opens, how rough water gets. A
// vertex shader defines RINGS_ACCESS readonly.
#ifndef RINGS_ACCESS
#define RINGS_ACCESS
#endif

// Variance of slope by cell, in millionths.
layout(scalar, set = 0, binding = 5) RINGS_ACCESS buffer Stirs { uint stirs[]; };
layout(scalar, set = 0, binding = 15) RINGS_ACCESS buffer Rings
{
    virga_rings_gpu rings_head;
    virga_ring_gpu rings[VIRGA_RINGS];
};

#define LEAST_WATER_M 0.0008 // what is thinner carries no wave

// The crater of a drop of 2.5 mm is half as deep as that wide; it grows with the drop's surface (energy over the area
// of the crater), and is no deeper than half of the water.
float crater_depth(float diameter_m, float water_m)
{
    return min(0.5 * diameter_m * diameter_m / 0.0025, 0.5 * water_m);
}

// Variance of slope that a drop's waves give a cell: the square of the crater's slope over its area, 4 pi (3 / 8) of
// its depth squared whatever its width (see ring_table.h: slope^2 = (2 r / a^2 (2 - x))^2 exp(-2 x), x = r^2 / a^2),
// over the cell's area. Waves carry it to the cells around as much as theirs come here.
float crater_variance(float crater_m) { return 4.71239 * crater_m * crater_m * tick.inv_cell_m * tick.inv_cell_m; }

// Time (s) in which a cell under steady rain keeps the variance that its drops bring: a fit within 7 % to
// ring_calm_time in engine/ground/ring_table.c. Shallow water is calmed by its floor.
float calm_time(float water_m) { return 0.333 * (1.0 - exp(-pow(max(water_m, 1e-4) / 0.0029, 1.5))); }
