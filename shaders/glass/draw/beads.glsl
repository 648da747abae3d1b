// beads.glsl - film on cells. Fresh film is a sheet; later it breaks into fine beads at random positions.
layout(scalar, set = 0, binding = 2) readonly buffer Film { uint film[]; };     // nl
layout(scalar, set = 0, binding = 3) readonly buffer Passed { uint passed[]; }; // tick of the last wetting; 0: never

#define BEADS 2 // max in a cell

// A random number of a cell: virga_hash3 of the pane's seed, BEAD_STREAM and the cell. The first two are the same for
// all cells, so the host has absorbed them.
uint bead_random(uint number) { return virga_hash_absorb(look.bead_seed, number); }

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

// ---- how a thread breaks
//
// A thread is a part of a circle between two contact lines, flat enough to be a parabola: with the half width a and the
// height c a in its middle its cross-section is 4/3 c a^2. So the water w on a way of the length L has
// a = sqrt(3 w / (4 c L)).
//
// It is not stable: a wave of its width takes water from where it is narrow, at the higher pressure. A small change of
// height z that has the wave number q along the thread keeps the pressure even if z'' = q^2 z across it: z = cosh(q y).
// It moves the line by z a / (2 h), and the slope there stays that of the contact angle if z' = z / a. So
// q a tanh(q a) = 1, q a = 1.2: longer waves than 5.24 a grow (Davis 1980; Sekimoto, Oguma and Kawasaki 1987), and
// fastest those that are the root of 2 longer, as where growth goes with q^2 (1 - q^2 / q0^2): 7.4 a. Rayleigh's jet in
// air has 9 a. (These sources are from memory, the formula follows from the lines above.)
//
// So beads of a thread are 7.4 a apart and have the water of so long a piece of it: a wide thread has few large ones, a
// thin one many small ones. A cell has two at most, and one at least: where waves are longer than a cell, its water
// becomes one bead.
//
// Lines move at a speed that goes with their angle alone, and the waves have to move them by a part of their width. So
// the time until a thread breaks goes with a: film_break_s is for one with USUAL_M.
#define WAVE 7.4
#define USUAL_M 3e-4
#define SLOWEST 3.0 // times film_break_s, for the widest threads
#define FASTEST 0.3

float thread_half_width(float nl, vec2 link)
{
    return sqrt(nl * 0.75e-12 / max(look.cap_height * length(link) * look.pane.cell_m, 1e-12));
}

// The part of a cell's film that is still a sheet or a thread, by its water and the word of its wetting. By whole
// ticks, so that views within a tick have the same film, see tiles.glsl.
float film_fresh(uint nl, uint wetted)
{
    const float age = float((look.tick - wetted) & VIRGA_GLASS_WETTED) * look.tick_s;
    const vec2 link = film_link(wetted);
    const float wide = clamp(thread_half_width(float(nl), link) / USUAL_M, FASTEST, SLOWEST);
    const float lasts = look.film_break_s * (link == vec2(0.0) ? 1.0 : wide);
    const float fresh = 1.0 - smoothstep(0.7, 1.3, age / max(lasts, 1e-6));
    return look.film_break_s <= 0.0 || wetted == 0u ? 0.0 : fresh;
}

// How far a thread's cell is from having one bead (0) to having two alike (1): by the waves on its way, gradually, as
// water dries. Not fewer than hold its water.
float two_beads(float nl, vec2 link)
{
    const float waves = length(link) * look.pane.cell_m / max(WAVE * thread_half_width(nl, link), 1e-9);
    const float widest = VIRGA_GLASS_BEAD_CELLS * look.pane.cell_m;
    const float most = look.drop_nl_of_m3 * widest * widest * widest;
    return max(smoothstep(1.2, 1.8, waves), clamp(2.0 - 2.0 * most / max(nl, 1e-6), 0.0, 1.0));
}

// Radii of a cell's beads, of whose water `broken_nl` has broken; 0: no such bead.
vec2 bead_radii(uint number, float nl, vec2 link, float broken_nl)
{
    const float first =
        link == vec2(0.0) ? 0.55 + 0.45 * virga_unit(bead_random(number)) : 1.0 - 0.5 * two_beads(nl, link);
    const vec2 radii = pow(broken_nl / look.drop_nl_of_m3 * vec2(first, 1.0 - first), vec2(1.0 / 3.0));
    return min(radii, vec2(VIRGA_GLASS_BEAD_CELLS * look.pane.cell_m));
}

// Position of bead i of a cell, and in z its radius. What a drop left breaks where it lies, on the way of that drop or
// a little beside it, at distances that are not quite even.
vec3 bead_of(ivec2 cell, uint number, float nl, vec2 link, uint i, float broken_nl)
{
    const uint random = bead_random(number);
    const vec2 at = vec2(virga_unit(virga_hash2(random, 2u * i)), virga_unit(virga_hash2(random, 2u * i + 1u)));
    const vec2 beside = 0.2 * (at.y - 0.5) * vec2(link.y, -link.x);
    const float part = (i == 0u ? 0.5 - 0.25 * two_beads(nl, link) : 0.75) + 0.3 * (at.x - 0.5);
    const vec2 place = link == vec2(0.0) ? vec2(cell) + at : on_way(vec2(cell), link, part) + beside;
    return vec3(place * look.pane.cell_m, bead_radii(number, nl, link, broken_nl)[i]);
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
#define THREAD_CELLS 0.33 // max radius of one
#define APART 1.9
#define JOINED 1.17 // water of a row on the map over that of its balls; test_glass_map.c measures it

// The number of balls of a cell's thread, and their radius before the film breaks. 0: it has none.
uint thread_balls(uint nl, vec2 link, out float radius)
{
    const float far_m = length(link) * look.pane.cell_m, water_m3 = float(nl) / (JOINED * look.drop_nl_of_m3);
    const float wide = sqrt(APART * water_m3 / max(far_m, 1e-6));
    const float widest = THREAD_CELLS * look.pane.cell_m, least = water_m3 / (widest * widest * widest);
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
