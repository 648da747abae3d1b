// beads.glsl - film on cells. Fresh film is a sheet; later it breaks into fine beads at random positions.
layout(scalar, set = 0, binding = 2) readonly buffer Film { uint film[]; };     // nl
layout(scalar, set = 0, binding = 3) readonly buffer Passed { uint passed[]; }; // tick of the last wetting; 0: never

#define BEADS 2 // max in a cell

// A random number of a cell: virga_hash3 of the pane's seed, BEAD_STREAM and the cell. The first two are the same for
// all cells, so the host has absorbed them.
uint bead_random(uint number) { return virga_hash_absorb(look.bead_seed, number); }

// The part of a cell's film that is still a sheet, by the tick in which it was wetted.
float film_fresh(uint wetted)
{
    const float age = float(look.tick - wetted) * look.tick_s + look.late_s;
    const float fresh = 1.0 - smoothstep(0.7, 1.3, age / max(look.film_break_s, 1e-6));
    return look.film_break_s <= 0.0 || wetted == 0u ? 0.0 : fresh;
}

// Radii of a cell's beads, whose water is `broken_nl`; 0: no such bead.
vec2 bead_radii(uint number, float broken_nl)
{
    const float first = 0.55 + 0.45 * virga_unit(bead_random(number));
    const vec2 radii = pow(broken_nl / look.drop_nl_of_m3 * vec2(first, 1.0 - first), vec2(1.0 / 3.0));
    return min(radii, vec2(VIRGA_GLASS_BEAD_CELLS * look.pane.cell_m));
}

// Position of bead i of a cell, and in z its radius.
vec3 bead_of(ivec2 cell, uint number, uint i, float broken_nl)
{
    const uint random = bead_random(number);
    const vec2 at = vec2(virga_unit(virga_hash2(random, 2u * i)), virga_unit(virga_hash2(random, 2u * i + 1u)));
    return vec3((vec2(cell) + at) * look.pane.cell_m, bead_radii(number, broken_nl)[i]);
}

// The part of each bead that is shape; the rest is mist. A single bead shows as a shape from one half on, where its
// density reaches the threshold, so below that half of it is mist.
vec2 bead_shapes(vec2 radii)
{
    return smoothstep(VIRGA_GLASS_BEAD_SEEN, 1.25, radii / max(look.texel_m[0], look.texel_m[1]));
}
