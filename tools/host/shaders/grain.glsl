// grain.glsl - stones and pores of wet ground, finer than its cells: a height that the water's depth is measured
// against. Noise on four lattices, each 2.8 times finer than the one before, every second of them turned by an eighth
// so that rows do not show. What a pixel is too wide for is not drawn but counted: its heights blur the shore, its
// slopes roughen the water. So the ground is as bright far away, and nothing crawls.

struct Grain {
    float height_mm;    // above the mean; what is drawn of it
    vec2 slope;         // of that
    float spread_mm;    // standard deviation of all heights
    float lost_mm;      // and of those that are not drawn
    float drawn_slope2; // variance of the slopes that are, along an axis
    vec2 stirred;       // slope of water that runs over them
    float stirred2;     // variance of that which is not drawn
};

const int GRAIN_LATTICES = 4;
const float GRAIN_SIDE_M = 0.1; // of the widest lattice, or nearly: cells are a power of two of it
// Standard deviations of asphalt's heights on lattices of 100, 35, 12.5 and 4.4 mm: half a millimetre together, as sand
// patches have it of a dense road, and slopes of 0.08.
const float GRAIN_MM[GRAIN_LATTICES] = float[](0.30, 0.32, 0.28, 0.15);
const float GRAIN_UNIT = 2.21;  // 1 / the deviation of such noise
const float GRAIN_SLOPE = 1.91; // deviation of its slope along an axis, over its own, on a lattice of side 1
// By virga_material (virga/material.h), times asphalt's. What grows hides the water, what is painted or polished has
// none.
const float GRAIN_OF[17] = float[](0.35, 1.0, 0.35, 0.6, 0.5, 0.0, 1.0, 1.0, 0.25, 0.0, 0.0, 0.0, 0.0, 0.3, 0.0,
                                           0.1, 0.0);
// Setts stand out of their joints, as wide as the widest lattice; and as they are what gutters are made of, the water
// on them runs, and shows a part of their slopes: waves of a bed that depth d takes e^(-k d) of.
const float SETTS_MM = 1.5, SETTS_STIR = 0.4;
const int SETTS_FIRST = 3, SETTS_LAST = 4; // VIRGA_MATERIAL_STONE, _BRICK

bool grain_of_setts(int material) { return material >= SETTS_FIRST && material <= SETTS_LAST; }

float grain_of(int material)
{
    return material < 0 ? 0.0 : GRAIN_OF[material < GRAIN_OF.length() ? material : 0];
}

float grain_corner(ivec2 at, uint lattice)
{
    uint x = uint(at.x) * 0x9e3779b1u + lattice;
    x = (x ^ (x >> 15)) * 0xed5ad4bbu + uint(at.y) * 0x85ebca77u;
    x = (x ^ (x >> 13)) * 0xac4c1b51u;
    return float((x ^ (x >> 16)) & 0xffffu) * (2.0 / 65535.0) - 1.0;
}

// Noise of deviation 1 and its slope, around again after `period` (a power of two).
vec3 grain_noise(vec2 at, int period, uint lattice)
{
    const ivec2 low = ivec2(floor(at));
    const vec2 t = at - vec2(low), f = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    const vec2 slope = 30.0 * t * t * (t - 1.0) * (t - 1.0);
    const int wrap = period - 1;
    const float a = grain_corner(low & wrap, lattice), b = grain_corner((low + ivec2(1, 0)) & wrap, lattice),
                c = grain_corner((low + ivec2(0, 1)) & wrap, lattice), d = grain_corner((low + 1) & wrap, lattice);
    const float along = mix(b - a, d - c, f.y), down = mix(c - a, d - b, f.x);
    return GRAIN_UNIT * vec3(mix(mix(a, b, f.x), mix(c, d, f.x), f.y), slope * vec2(along, down));
}

// At a place in cells from the window's low corner, whose number modulo `cells` is low_cell (ground_map.glsl).
Grain grain_at(vec2 at, vec2 low_cell, int cells, float cell_m, float pixel_m, int material, float depth_mm)
{
    const float share = grain_of(material);
    const bool setts = grain_of_setts(material);
    const float widest = exp2(floor(log2(cell_m / GRAIN_SIDE_M) + 0.5)); // lattice points to a cell
    Grain grain = Grain(0.0, vec2(0.0), 0.0, 0.0, 0.0, vec2(0.0), 0.0);
    for (int i = 0; i < GRAIN_LATTICES && share > 0.0; i++) {
        const bool turned = (i & 1) == 1;
        const float points = widest * float(turned ? 2 << (i / 2 * 3) : 1 << (i / 2 * 3));
        const float side_m = cell_m / (points * (turned ? 1.41421356 : 1.0));
        const float mm = setts && i == 0 ? SETTS_MM : share * GRAIN_MM[i];
        const float stir = setts ? SETTS_STIR * exp(-3.14159265e-3 * depth_mm / side_m) : 0.0;
        const float drawn = 1.0 - smoothstep(0.35, 1.0, pixel_m / side_m);
        const float slope = GRAIN_SLOPE * mm * 1e-3 / side_m, lost = 1.0 - drawn * drawn;
        grain.spread_mm += mm * mm;
        grain.lost_mm += lost * mm * mm;
        grain.drawn_slope2 += drawn * drawn * slope * slope;
        grain.stirred2 += lost * slope * slope * stir * stir;
        if (drawn > 0.0) {
            const vec2 p = (low_cell + at) * points;
            const vec3 noise = grain_noise(turned ? vec2(p.x + p.y, p.y - p.x) : p,
                                           max(int(float(cells) * points), 1), uint(i));
            const vec2 rising = turned ? vec2(noise.y - noise.z, noise.y + noise.z) : noise.yz;
            grain.height_mm += drawn * mm * noise.x;
            const vec2 drawn_slope = drawn * mm * 1e-3 * points / cell_m * rising;
            grain.slope += drawn_slope;
            grain.stirred += stir * drawn_slope;
        }
    }
    grain.spread_mm = sqrt(grain.spread_mm);
    grain.lost_mm = sqrt(grain.lost_mm);
    return grain;
}
