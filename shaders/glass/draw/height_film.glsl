// height_film.glsl - what film adds to a tile of the height map: the sheet on its cells, beads with a shape (added as
// balls like those of drops), and the mist map. Include it after the buffers, texels and add() of height.glsl.

// Thickness of the sheet on a cell. Software Vulkan has no branch here: inside one it reads lane by lane.
float sheet_m(ivec2 cell)
{
    const ivec2 last = ivec2(look.pane.columns, look.pane.rows) - 1, clamped = clamp(cell, ivec2(0), last);
    const uint number = uint(clamped.x) + uint(clamped.y) * look.pane.columns;
    const uint water = film[number], wetted = passed[number];
    if (FOR_GPU && water == 0u)
        return 0.0;
    const float nl = float(water) * film_fresh(water, wetted) * (WITH_BEADS ? 1.0 - thread_share(water, wetted) : 1.0);
    return cell == clamped ? nl * 1e-12 / (look.pane.cell_m * look.pane.cell_m) : 0.0;
}

bool interpolates_film() { return look.pane.cell_m >= max(look.texel_m[0], look.texel_m[1]); }

#ifndef SHUFFLE
// The sheet on the cells that a tile's texels lie between: a texel has four of them, and a cell has many texels. Cells
// are no smaller than texels there, so those of a tile are in SHEETS columns and rows. They are kept in place of beads
// and balls, which have been added by then: more shared memory would mean fewer workgroups at once.
#define SHEETS (TILE + 2)
#define SHEET(column, row) beads[(column) + (row) * SHEETS].x
ivec2 sheets_low;
#endif

void load_sheets(ivec2 first)
{
#ifndef SHUFFLE
    if (!FILM || !interpolates_film())
        return;
    barrier();
    sheets_low = ivec2(floor(middle_of(first) / look.pane.cell_m - 0.5));
    const ivec2 span = min(ivec2(texel_m() * float(TILE - 1) / look.pane.cell_m) + 3, ivec2(SHEETS));
    for (int y = int(gl_LocalInvocationID.y); y < span.y; y += LANES / TILE)
        for (int x = int(gl_LocalInvocationID.x); x < span.x; x += TILE)
            SHEET(x, y) = sheet_m(sheets_low + ivec2(x, y));
    barrier();
#endif
}

#if LANES == 8
// An invocation has a column of texels. Going up, two rows of cells at a time lie below and above its texels, and the
// upper one becomes the lower one. So the sheet is interpolated along u once for each row of cells, and not for each
// texel: two cells are read for a row of cells, where each of its texels would read four.
//
// The row of cells below a texel. Where cells are smaller than texels, the texel's own row.
int sheet_row(ivec2 texel)
{
    if (!FILM)
        return 0;
    return interpolates_film() ? int(floor(middle_of(texel).y / look.pane.cell_m - 0.5)) : texel.y;
}

// The sheet on such a row, interpolated along u between two cells; or that on the nearest cell.
float sheet_along(int column, int row)
{
    if (!FILM)
        return 0.0;
    const bool between = interpolates_film();
    const vec2 at = middle_of(ivec2(column, row)) / look.pane.cell_m - 0.5;
    const float low = floor(between ? at.x : at.x + 0.5);
    const ivec2 cell = ivec2(low, between ? row : int(floor(at.y + 0.5)));
    return mix(sheet_m(cell), sheet_m(cell + ivec2(1, 0)), between ? at.x - low : 0.0);
}

// The sheet at a texel between the rows below and above it.
float sheet_between(ivec2 texel, float below, float above)
{
    const float at = middle_of(texel).y / look.pane.cell_m - 0.5;
    return FILM ? mix(below, above, interpolates_film() ? at - floor(at) : 0.0) : 0.0;
}
#else // 64
// That on a cell, and on the three above and to the right of it.
vec4 sheets_from(ivec2 cell)
{
#ifdef SHUFFLE
    return vec4(sheet_m(cell), sheet_m(cell + ivec2(1, 0)), sheet_m(cell + ivec2(0, 1)), sheet_m(cell + 1));
#else
    const ivec2 at = cell - sheets_low;
    return vec4(SHEET(at.x, at.y), SHEET(at.x + 1, at.y), SHEET(at.x, at.y + 1), SHEET(at.x + 1, at.y + 1));
#endif
}

// Interpolated between the centers of four cells; the nearest cell where cells are smaller than texels.
float sheet_at(vec2 point)
{
    if (!FILM)
        return 0.0;
    const vec2 at = point / look.pane.cell_m - 0.5, low = floor(at), t = at - low;
    if (!interpolates_film())
        return sheet_m(ivec2(floor(at + 0.5)));
    const vec4 four = sheets_from(ivec2(low));
    return mix(mix(four.x, four.y, t.x), mix(four.z, four.w, t.x), t.y);
}
#endif

// Loads the balls of a cell's thread. They get thinner as it breaks.
void load_thread(ivec2 cell, uint water, vec2 link, float fresh)
{
    float radius;
    const uint count = thread_balls(water, link, radius);
    const float left = radius * pow(fresh, 1.0 / 3.0);
    if (bead_shapes(vec2(left)).x <= 0.0)
        return;
    for (uint k = 0u; k < count; k++) {
        const vec2 at = on_way(vec2(cell), link, (float(k) + 0.5) / float(count));
        beads[atomicAdd(bead_count, 1u)] = vec3(at * look.pane.cell_m, left);
    }
}

// Loads the beads with a shape, of the tile's cells and of those beside it.
void load_beads(ivec2 tile)
{
    const ivec2 corner = ivec2(floor(vec2(tile) * tile_m() / look.pane.cell_m)) - 1;
    const ivec2 span = min(ivec2(floor(vec2(tile + 1) * tile_m() / look.pane.cell_m)) + 2 - corner, ivec2(MAX_CELLS));
    const ivec2 size = ivec2(look.pane.columns, look.pane.rows);
    for (uint i = gl_LocalInvocationIndex; i < uint(span.x * span.y); i += LANES) {
        const ivec2 cell = corner + ivec2(int(i) % span.x, int(i) / span.x);
        if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, size)))
            continue;
        const uint number = uint(cell.x) + uint(cell.y) * look.pane.columns;
        const uint water = film[number], wetted = passed[number];
        const float nl = float(water), fresh = film_fresh(water, wetted), broken_nl = nl * (1.0 - fresh);
        const vec2 link = film_link(wetted), shapes = bead_shapes(bead_radii(number, nl, link, broken_nl));
        for (uint k = 0u; k < BEADS; k++)
            if (shapes[k] > 0.0)
                beads[atomicAdd(bead_count, 1u)] = bead_of(cell, number, nl, link, k, broken_nl);
        load_thread(cell, water, link, fresh);
    }
}

void add_beads(ivec2 tile)
{
    if (gl_LocalInvocationIndex == 0u)
        bead_count = 0u;
    barrier();
    load_beads(tile);
    barrier();
    for (uint i = 0u; i < bead_count; i++) {
        const vec3 bead = beads[i];
        add(Ball(bead.xy, vec2(0.0), 1.0 / bead.z, bead.z * look.cap_height / unit_m, bead_shapes(bead.zz).x, 0.0,
                 vec2(0.0)));
    }
}

// (If the host reads the map) the mist map there, filtered as the draw filters it.
float film_mist(ivec2 texel)
{
    if (!WITH_MAP)
        return 0.0;
    const vec2 last_texel = vec2(look.mist_columns, look.mist_rows) - 1.0;
    const vec2 at = clamp((vec2(texel) + 0.5) * texel_m() / (look.pane.cell_m * float(look.mist_cells)) - 0.5,
                          vec2(0.0), last_texel);
    const uvec2 low = uvec2(at), high = min(low + 1u, uvec2(last_texel));
    vec4 four;
    for (uint i = 0u; i < 4u; i++) {
        const uvec2 from = uvec2((i & 1u) != 0u ? high.x : low.x, (i & 2u) != 0u ? high.y : low.y);
        four[i] = unpackUnorm4x8(mist[(from.x + from.y * look.mist_pitch) / 4u])[from.x & 3u];
    }
    const vec2 t = at - vec2(low);
    return mix(mix(four.x, four.y, t.x), mix(four.z, four.w, t.x), t.y);
}
