// picture_beads.glsl - film on cells: fresh it is a sheet, later it has broken into fine beads at hashed places.
layout(scalar, set = 0, binding = 2) readonly buffer Film { uint film[]; };     // nl
layout(scalar, set = 0, binding = 3) readonly buffer Passed { uint passed[]; }; // tick of the last wetting; 0: never

#define BEADS 2          // at most in a cell
#define BEAD_CELLS 0.33  // largest radius in cells, so that none reaches beyond the neighbours

// The share of a cell's film that is still a sheet.
float film_fresh(uint cell)
{
    if (look.film_break_s <= 0.0 || passed[cell] == 0u)
        return 0.0;
    const float age = float(look.tick - passed[cell]) * look.tick_s + look.late_s;
    return 1.0 - smoothstep(0.7, 1.3, age / look.film_break_s);
}

// Place in the cell (x, y) and radius of one of its beads; radius 0: it has not got so many.
vec3 bead_of(ivec2 cell, uint number, uint i, float water_nl)
{
    const uint random = virga_hash3(look.pane.seed, 0x6265u, number);
    const float first = 0.55 + 0.45 * virga_unit(random);
    const float radius = cap_radius(water_nl * (i == 0u ? first : 1.0 - first));
    const vec2 at = vec2(virga_unit(virga_hash2(random, 2u * i)), virga_unit(virga_hash2(random, 2u * i + 1u)));
    return vec3((vec2(cell) + 0.1 + 0.8 * at) * look.pane.cell_m, min(radius, BEAD_CELLS * look.pane.cell_m));
}
