// rings.glsl - rings on puddles: their records, the depth of a drop's crater, and the roughness of the water. A vertex
// shader defines RINGS_ACCESS readonly.
#ifndef RINGS_ACCESS
#define RINGS_ACCESS
#endif

// Variance of the slope per cell, in millionths.
layout(scalar, set = 0, binding = 5) RINGS_ACCESS buffer Stirs { uint stirs[]; };
layout(scalar, set = 0, binding = 15) RINGS_ACCESS buffer Rings
{
    virga_rings_gpu rings_head;
    virga_ring_gpu rings[VIRGA_MAX_RINGS];
};

#define MIN_WATER_M 0.0008 // min depth of water that has waves

// The crater of a drop of 2.5 mm is half as deep as the drop is wide. It grows with the drop's surface (energy over the
// area of the crater), and is at most half as deep as the water.
float crater_depth(float diameter_m, float water_m)
{
    return min(0.5 * diameter_m * diameter_m / 0.0025, 0.5 * water_m);
}

// Variance of slope from a drop's waves on a cell: the square of the crater's slope over its area, 4 pi (3 / 8) of its
// depth squared for any width (see ring_table.h: slope^2 = (2 r / a^2 (2 - x))^2 exp(-2 x), x = r^2 / a^2), over the
// cell's area. Waves leave the cell as much as they come from the cells around.
float crater_variance(float crater_m) { return 4.71239 * crater_m * crater_m * tick.inv_cell_m * tick.inv_cell_m; }

// Time (s) for which a cell in steady rain keeps the variance that its drops bring: a fit within 7 % to ring_calm_time
// in engine/ground/ring_table.c. In shallow water, friction at the floor calms it.
float calm_time(float water_m) { return 0.333 * (1.0 - exp(-pow(max(water_m, 1e-4) / 0.0029, 1.5))); }
