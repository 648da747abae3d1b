// break_film.comp - film that water has left breaks up: what is on a site becomes a drop, in one of the site's cells. A
// part stays as the finest drops. Sites are squares of three sizes at random, so drops have many sizes: the largest
// run and take the small ones up.
// One invocation per smallest site of some rows; all rows have their turn. Reads: what water does on cells. Writes:
// that, film, seeds.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "flood.glsl"
#include "seeds.glsl"

layout(local_size_x = VIRGA_GLASS_SMALL_GROUP) in;

#define LARGE 0.3  // share of the largest squares that are one site
#define MIDDLE 0.5 // share of the squares of half their side, among the others
#define STAYS 20u  // one in so many parts of the film stays
// When it breaks, in units of the mean time of the picture's sheets: while it still shows as one.
#define SOONEST 0.35
#define LATEST 0.65

// Sites along the side of the site that a smallest site belongs to.
uint span_of(uvec2 site)
{
    const uvec2 large = site / VIRGA_GLASS_SITE_SPAN, middle = site / (VIRGA_GLASS_SITE_SPAN / 2u);
    if (virga_unit(virga_hash4(tick.pane.seed, 0x73697465u, large.x, large.y)) < LARGE)
        return VIRGA_GLASS_SITE_SPAN;
    return virga_unit(virga_hash4(tick.pane.seed, 0x73697466u, middle.x, middle.y)) < MIDDLE
               ? VIRGA_GLASS_SITE_SPAN / 2u
               : 1u;
}

// Counts the cells of a rectangle with film that waits to break, and the water that would break. False: some of them
// have to wait.
bool is_ripe(uvec2 from, uvec2 to, float wait_ticks, out uint cells, out uint water)
{
    const uint mask = (1u << VIRGA_GLASS_PHASE) - 1u;
    cells = water = 0u;
    for (uint y = from.y; y < to.y; y++)
        for (uint x = from.x; x < to.x; x++) {
            const uint cell = cell_number(ivec2(x, y)), word = occupants[flood_word(cell)];
            if (flood_phase(word) != VIRGA_GLASS_BREAKS)
                continue;
            if (float((tick.tick - word) & mask) < wait_ticks)
                return false;
            cells++;
            water += film[cell] - film[cell] / STAYS;
        }
    return true;
}

// Takes the film off these cells, if it becomes a drop. Returns the cell with the number `chosen`.
uint take_film(uvec2 from, uvec2 to, bool drop, uint chosen)
{
    uint found = 0u, number = 0u;
    for (uint y = from.y; y < to.y; y++)
        for (uint x = from.x; x < to.x; x++) {
            const uint cell = cell_number(ivec2(x, y));
            if (flood_phase(occupants[flood_word(cell)]) != VIRGA_GLASS_BREAKS)
                continue;
            if (number++ == chosen)
                found = cell;
            if (drop)
                film[cell] /= STAYS;
            occupants[flood_word(cell)] = 0u;
        }
    return found;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= tick.sites)
        return;
    const uint number = seed_count() - tick.fog_sites - tick.sites + i;
    seeds[number].water_nl = 0u;
    const uvec2 site = uvec2(i % tick.site_columns, tick.first_site_row + i / tick.site_columns);
    const uint span = span_of(site);
    if (site % span != uvec2(0u))
        return;
    const uvec2 all = uvec2(tick.pane.columns, tick.pane.rows);
    const uvec2 from = min(site * tick.site_cells, all), to = min((site + span) * tick.site_cells, all);
    const uint hash = virga_hash4(tick.pane.seed, tick.tick, site.x, site.y);
    const float share = virga_unit(virga_hash4(tick.pane.seed, 0x77616974u, site.x, site.y));
    const float wait = tick.break_ticks * mix(SOONEST, LATEST, share);
    uint cells, water;
    if (!is_ripe(from, to, wait, cells, water) || cells == 0u)
        return;
    const bool drop = float(water) >= max(tick.mist_nl, 1.0);
    const uint cell = take_film(from, to, drop, hash % cells);
    if (!drop)
        return;
    const vec2 shift = vec2(virga_unit(virga_hash2(hash, 1u)), virga_unit(virga_hash2(hash, 2u))) - 0.5;
    seeds[number] = virga_glass_seed_gpu(to_array(to_pane(cell_middle(cell) + 0.8 * shift * tick.pane.cell_m)),
                                         float[2](0.0, 0.0), water, 0u, 0u, cell, hash, VIRGA_GLASS_DROP);
}
