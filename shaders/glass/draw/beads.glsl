// beads.glsl - film on cells. Fresh film is a sheet; later it breaks into fine beads at random positions.
layout(scalar, set = 0, binding = 2) readonly buffer Film { uint film[]; };     // nl
layout(scalar, set = 0, binding = 3) readonly buffer Passed { uint passed[]; }; // tick of the last wetting; 0: never

#define BEADS 2 // max in a cell

// A random number of a cell: virga_hash3 of the pane's seed, BEAD_STREAM and the cell. The first two are the same for
// all cells, so the host has absorbed them.
uint bead_random(uint number) { return virga_hash_absorb(look.bead_seed, number); }

// The part of a cell's film that is still a sheet or a thread, by the word of its wetting.
float film_fresh(uint wetted)
{
    const float age = float((look.tick - wetted) & VIRGA_GLASS_WETTED) * look.tick_s + look.late_s;
    const float fresh = 1.0 - smoothstep(0.7, 1.3, age / max(look.film_break_s, 1e-6));
    return look.film_break_s <= 0.0 || wetted == 0u ? 0.0 : fresh;
}

// The way, in cells, that the drop went which left a cell's film. 0: no drop did.
vec2 film_link(uint wetted)
{
    const int link = int(wetted >> VIRGA_GLASS_LINK_BIT) - 1;
    return link < 0 ? vec2(0.0) : vec2(link % 3, link / 3) - 1.0;
}

// Where in a cell (in cells) the water lies that a drop left: drops do not run straight through the middles of cells.
// It changes smoothly from cell to cell, in waves of about 10 and 4 cells.
vec2 way_through(vec2 cell)
{
    const vec2 slow = vec2(0.71 * cell.x + 0.61 * cell.y, 0.67 * cell.x - 0.57 * cell.y);
    const vec2 fast = vec2(1.63 * cell.y - 1.13 * cell.x, 1.27 * cell.x + 1.51 * cell.y);
    return 0.5 + 0.27 * sin(slow) + 0.11 * sin(fast);
}

// A place on the way, from 0 at its begin to 1 where the next cell's begins (in cells of the pane).
vec2 on_way(vec2 cell, vec2 link, float part)
{
    return mix(cell + way_through(cell), cell + link + way_through(cell + link), part);
}

// Radii of a cell's beads, whose water is `broken_nl`; 0: no such bead.
vec2 bead_radii(uint number, float broken_nl)
{
    const float first = 0.55 + 0.45 * virga_unit(bead_random(number));
    const vec2 radii = pow(broken_nl / look.drop_nl_of_m3 * vec2(first, 1.0 - first), vec2(1.0 / 3.0));
    return min(radii, vec2(VIRGA_GLASS_BEAD_CELLS * look.pane.cell_m));
}

// Position of bead i of a cell, and in z its radius. What a drop left breaks where it lies, on the way of that drop or
// a little beside it.
vec3 bead_of(ivec2 cell, uint number, vec2 link, uint i, float broken_nl)
{
    const uint random = bead_random(number);
    const vec2 at = vec2(virga_unit(virga_hash2(random, 2u * i)), virga_unit(virga_hash2(random, 2u * i + 1u)));
    const vec2 beside = 0.3 * (at.y - 0.5) * vec2(link.y, -link.x);
    const vec2 place = link == vec2(0.0) ? vec2(cell) + at : on_way(vec2(cell), link, at.x) + beside;
    return vec3(place * look.pane.cell_m, bead_radii(number, broken_nl)[i]);
}

// The part of each bead that is shape; the rest is mist. A single bead shows as a shape from one half on, where its
// density reaches the threshold, so below that half of it is mist.
vec2 bead_shapes(vec2 radii)
{
    return smoothstep(VIRGA_GLASS_BEAD_SEEN, 1.25, radii / max(look.texel_m[0], look.texel_m[1]));
}

// ---- threads
//
// The film that a drop leaves draws together at once: until it breaks it is a thread, as wide as its water and the
// contact angle give. It is drawn as a row of balls from cell to cell, each at most APART radii from the next, so that
// their densities join. A row of caps of radius r, APART radii apart, has f r^3 of water each, with f = drop_nl_of_m3.
// So a cell with the water w and the way L to the next has r = sqrt(APART w / (f L)), and L / (APART r) balls. Where
// the balls of a row join, the height map has more than their water: they are smaller by that.

#define THREAD_BALLS 6u   // max of a cell
// Cells with fewer texels along a side have none. So a tile lies on or beside 6 x 6 cells with threads at most, whose 6
// balls and 2 beads each fit the array of height.glsl.
#define THREAD_TEXELS 3.0
#define APART 1.9
#define JOINED 1.17 // water of a row on the map over that of its balls; test_glass_map.c measures it

// The number of balls of a cell's thread, and their radius before the film breaks. 0: it has none.
uint thread_balls(uint nl, vec2 link, out float radius)
{
    const float far_m = length(link) * look.pane.cell_m, water_m3 = float(nl) / (JOINED * look.drop_nl_of_m3);
    const float wide = sqrt(APART * water_m3 / max(far_m, 1e-6));
    const float widest = VIRGA_GLASS_BEAD_CELLS * look.pane.cell_m, least = water_m3 / (widest * widest * widest);
    const float count = clamp(ceil(max(far_m / max(APART * wide, 1e-6), least)), 1.0, float(THREAD_BALLS));
    radius = min(pow(water_m3 / count, 1.0 / 3.0), widest);
    const bool there = look.sheets != 0u && link != vec2(0.0) && nl != 0u &&
                       look.pane.cell_m >= THREAD_TEXELS * max(look.texel_m[0], look.texel_m[1]);
    return there ? uint(count) : 0u;
}

// The part of a cell's fresh film that is shown as a thread. The rest, where a thread is too thin for the texels, is a
// sheet.
float thread_share(uint nl, uint wetted)
{
    float radius;
    const uint count = thread_balls(nl, film_link(wetted), radius);
    return count == 0u ? 0.0 : bead_shapes(vec2(radius)).x;
}
