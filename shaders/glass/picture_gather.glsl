// picture_gather.glsl - the height map, tile by tile: densities and heights of the balls that reach a texel are
// added up, in whole
// numbers as no order is kept, blended, and compressed. The includer says how a workgroup hands balls around:
// SHUFFLE or not.
//
// Of each ball four sums: its density V; and, with the weight k, k V, k V z and k K, where z is its height, sag and
// all, over the
// highest of the tile, and K = 1 / (1 + x^2)^2. With the weight k = z,
//
//     Z = (sum k V z) / (sum k V)     is the mean height, weighted by density and by height, so that a small ball
// in or under
//                                     a large one makes no dent
//     P = 2 - ((sum k K) / Z)^(-1/2)  is 1 - x^2 for a ball alone, smooth wherever balls merge, and below 2 however
// many do
//
// and Z P the height. Two drops that become one: P = 1.29 in their middle; for caps of one angle it is 2^(1/3) =
// 1.26. Near the rim
// what the density says takes over, the x^2 of a ball alone that has it there, so that the water ends where the
// density is
// 1/2. Both are the same for a ball alone. By Chen and Zhang's weights k = t_i is R_i less the distance, sums are
// divided by
// that of the weights, and P is made of the weighted mean of K.
#define DENSITY_SPECIAL
#include "picture.glsl"
#include "picture_density.glsl"
#include "picture_tiles.glsl"
#include "picture_beads.glsl"

#define LANES 64
#define OWN 4 // texels of a lane, above one another
#define ONE 8388608.0 // 1 in the sums: 255 balls on top of each other do not overflow
#define MOST_CELLS 20 // along a side, that a tile lies on or beside where cells are no smaller than texels

layout(local_size_x = LANES) in;
layout(scalar, set = 0, binding = 8) readonly buffer Entries { uint entries[]; };
layout(scalar, set = 0, binding = 9) buffer Mist { uint mist[]; };
layout(set = 0, binding = 11, rgba32f) uniform writeonly image2D map_out;
layout(set = 0, binding = 20, rgba32f) uniform writeonly image2D relief_out;
layout(scalar, set = 0, binding = 4) readonly buffer Surface { uint surface[]; };
layout(scalar, set = 0, binding = 17) buffer Written { uint written[]; }; // VIRGA_GLASS_BLOCKS, _QUARTER
layout(scalar, set = 0, binding = 18) readonly buffer Work { virga_glass_work_gpu work; uint wet[]; };

struct Ball {
    vec2 middle, sag;
    float inv_radius, height, peak, radius;
};

shared uint highest, widest, narrowest, held, bead_count;
shared float heights[16][16]; // those of the tile, and a texel around it
shared float film_m[MOST_CELLS * MOST_CELLS];
shared vec3 beads[MOST_CELLS * MOST_CELLS * BEADS]; // in any order, as sums have none
#ifndef SHUFFLE
shared Ball batch[LANES];
#endif

ivec4 sums[OWN];
float tile_height, tile_radius; // largest of a tile

Ball ball_of(uint entry)
{
    const virga_glass_ball_gpu b = balls[entries[entry]];
    return Ball(vec2(b.middle[0], b.middle[1]), vec2(b.sag[0], b.sag[1]), 1.0 / b.radius_m, b.height_m / tile_height,
                b.peak, b.radius_m / tile_radius);
}

void add_at(int own, vec2 place, Ball ball, float reach)
{
    const vec2 x = (place - ball.middle) * ball.inv_radius;
    const float x2 = dot(x, x), once = 1.0 / (1.0 + x2);
    const float density = ball.peak * density_at(x2, reach);
    const float height = ball.height * max(1.0 + dot(ball.sag, x), 0.2);
    // Chen and Zhang, equations 7 and 8.
    const float k = WEIGHTED ? ball.radius * max(reach - sqrt(x2), 0.0) / reach : height;
    const float around = ball.peak * k * density_window(x2, reach) * once * once;
    const vec4 each = vec4(WEIGHTED ? k : density, k * density, k * density * height, around);
    sums[own] += x2 < reach * reach ? ivec4(each * ONE + 0.5) : ivec4(0);
}

void add(vec2 place, Ball ball, float reach)
{
    for (int i = 0; i < OWN; i++)
        add_at(i, place + vec2(0.0, look.texel_m[1] * float(i)), ball, reach);
}

// ---- what a tile holds

bool has_film(virga_glass_tile_gpu tile) { return (tile.film & VIRGA_GLASS_HAS_FILM) != 0u; }

void find_largest(virga_glass_tile_gpu tile)
{
    if (gl_LocalInvocationIndex == 0u)
        highest = widest = held = bead_count = 0u;
    if (gl_LocalInvocationIndex == 0u)
        narrowest = floatBitsToUint(1e9);
    barrier();
    if (gl_LocalInvocationIndex < tile.count) {
        float height = 0.0, radius = 0.0, least = 1e9;
        for (uint i = gl_LocalInvocationIndex; i < tile.count; i += LANES) {
            const uint ball = entries[tile.first + i];
            height = max(height, balls[ball].height_m);
            radius = max(radius, balls[ball].radius_m);
            least = min(least, balls[ball].radius_m);
        }
        atomicMin(narrowest, floatBitsToUint(least));
        atomicMax(highest, floatBitsToUint(height));
        atomicMax(widest, floatBitsToUint(radius));
    }
    barrier();
    const float radius = max(uintBitsToFloat(widest), has_film(tile) ? BEAD_CELLS * look.pane.cell_m : 0.0);
    const float height = max(uintBitsToFloat(highest), has_film(tile) ? radius * look.cap_height : 0.0);
    tile_height = max(height * 1.6, 1e-9); // the fatter side of one that sags
    tile_radius = max(radius, 1e-9);
}

void add_balls(virga_glass_tile_gpu tile, vec2 place)
{
    const float reach = density_reach();
#ifdef SHUFFLE
    // Each lane looks at one ball; those that reach none of the subgroup's texels are left out.
    const vec2 low = subgroupMin(place), high = subgroupMax(place) + vec2(0.0, look.texel_m[1] * float(OWN - 1));
    for (uint from = 0u; from < tile.count; from += gl_SubgroupSize) {
        const uint some = min(tile.count - from, gl_SubgroupSize);
        const Ball mine = ball_of(tile.first + from + min(gl_SubgroupInvocationID, some - 1u));
        const vec2 apart = (mine.middle - clamp(mine.middle, low, high)) * mine.inv_radius;
        const vec4 ends = vec4(mine.middle, mine.sag);
        const vec4 sizes = vec4(mine.inv_radius, mine.height, mine.peak, mine.radius);
        uvec4 near = subgroupBallot(gl_SubgroupInvocationID < some && dot(apart, apart) < reach * reach);
        while (near != uvec4(0u)) {
            const uint i = subgroupBallotFindLSB(near);
            near &= ~(uvec4(i / 32u == 0u, i / 32u == 1u, i / 32u == 2u, i / 32u == 3u) << (i % 32u));
            const vec4 e = subgroupShuffle(ends, i), s = subgroupShuffle(sizes, i);
            add(place, Ball(e.xy, e.zw, s.x, s.y, s.z, s.w), reach);
        }
    }
#else
    for (uint from = 0u; from < tile.count; from += LANES) {
        const uint some = min(tile.count - from, LANES);
        barrier();
        if (gl_LocalInvocationIndex < some)
            batch[gl_LocalInvocationIndex] = ball_of(tile.first + from + gl_LocalInvocationIndex);
        barrier();
        for (uint i = 0u; i < some; i++)
            add(place, batch[i], reach);
    }
#endif
}

// ---- film

bool cells_are_wide() { return look.pane.cell_m >= max(look.texel_m[0], look.texel_m[1]); }

ivec2 first_cell(ivec2 tile) { return ivec2(floor((vec2(tile) * tile_m() - texel_m()) / look.pane.cell_m)) - 1; }

float sheet_m(uint cell)
{
    return float(film[cell]) * film_fresh(cell) * 1e-12 / (look.pane.cell_m * look.pane.cell_m);
}

bool is_cell(ivec2 cell)
{
    return all(greaterThanEqual(cell, ivec2(0))) && cell.x < int(look.pane.columns) && cell.y < int(look.pane.rows);
}

// The tile's cells, and those beside it, with those of their beads that have a shape.
void load_cells(ivec2 tile)
{
    const ivec2 corner = first_cell(tile);
    const ivec2 span = min(ivec2(floor((vec2(tile + 1) * tile_m() + texel_m()) / look.pane.cell_m)) + 2 - corner,
        ivec2(MOST_CELLS));
    for (uint i = gl_LocalInvocationIndex; i < uint(span.x * span.y); i += LANES) {
        const ivec2 at = ivec2(int(i) % span.x, int(i) / span.x), cell = corner + at;
        const uint number = uint(cell.x) + uint(cell.y) * look.pane.columns;
        const bool wet_cell = is_cell(cell) && film[number] != 0u;
        film_m[at.x + at.y * MOST_CELLS] = 0.0;
        if (wet_cell) {
            film_m[at.x + at.y * MOST_CELLS] = sheet_m(number);
            const float broken_nl = float(film[number]) * (1.0 - film_fresh(number));
            for (uint k = 0u; k < BEADS; k++) {
                const vec3 bead = bead_of(cell, number, k, broken_nl);
                if (shape_share(bead.z) > 0.0)
                    beads[atomicAdd(bead_count, 1u)] = bead;
            }
        }
    }
}

uint shared_cell(ivec2 cell)
{
    const ivec2 at = clamp(cell, ivec2(0), ivec2(MOST_CELLS - 1));
    return uint(at.x) + uint(at.y) * MOST_CELLS;
}

void add_beads(vec2 place)
{
    const float reach = density_reach();
    for (uint i = 0u; i < bead_count; i++) {
        const vec3 bead = beads[i];
        add(place, Ball(bead.xy, vec2(0.0), 1.0 / bead.z, bead.z * look.cap_height / tile_height,
                        shape_share(bead.z), bead.z / tile_radius), reach);
    }
}

// Thickness of the sheet, between the middles of four cells.
float sheet_at(ivec2 tile, vec2 place)
{
    if (!cells_are_wide()) {
        const ivec2 cell = ivec2(floor(place / look.pane.cell_m));
        return is_cell(cell) ? sheet_m(uint(cell.x) + uint(cell.y) * look.pane.columns) : 0.0;
    }
    const vec2 at = place / look.pane.cell_m - 0.5, low = floor(at), t = at - low;
    const ivec2 cell = ivec2(low) - first_cell(tile);
    return mix(mix(film_m[shared_cell(cell)], film_m[shared_cell(cell + ivec2(1, 0))], t.x),
               mix(film_m[shared_cell(cell + ivec2(0, 1))], film_m[shared_cell(cell + ivec2(1, 1))], t.x), t.y);
}

// ---- what sums come to

// x: density as blended; y: height of the water over the glass (m), below 0 beside it.
vec2 blended(ivec4 sum)
{
    const vec4 s = vec4(sum);
    if (sum.y <= 0)
        return vec2(WEIGHTED ? 0.0 : s.x / ONE, 0.0);
    const bool weighted = WEIGHTED;
    const float density = weighted ? s.y / s.x : s.x / ONE, mean = s.z / s.y;
    const float around = max(weighted ? s.w / s.x : s.w / ONE / max(mean, 1e-6), 1e-4);
    const float inner = 2.0 - inversesqrt(around), rim = 1.0 - density_inverse(density);
    const float profile = mix(rim, inner, smoothstep(0.55, 0.9, density));
    return vec2(density, tile_height * mean * clamp(profile, -1.0, 2.0));
}

// Red: density, compressed. Green: height (m). Blue: mist. Alpha: thickness of the sheet of film (m).
vec4 texel_of(ivec4 sum, float sheet, float mist_share)
{
    const vec2 water = blended(sum);
    const float film_there = smoothstep(0.0, 3e-6, sheet);
    return vec4(compressed(water.x), mix(water.y, max(water.y, 0.0), film_there) + sheet, mist_share, sheet);
}

bool on_tile(ivec2 at) { return all(greaterThan(at, ivec2(0))) && all(lessThanEqual(at, ivec2(VIRGA_GLASS_TILE))); }

// Taken away as it is read, so that the next view finds none. Looked up without a branch, as is_glass.
float take_mist(ivec2 texel, bool there)
{
    const uint at = there ? uint(texel.x) + uint(texel.y) * look.map_columns : 0u;
    const uint held_there = mist[at], found = there ? held_there : 0u;
    if (found != 0u)
        mist[at] = 0u;
    return min(float(found) / float(VIRGA_GLASS_MIST_ONE), 1.0);
}

// The least density that a texel beside a rim has, or less. Where beads may be, or other densities than Goto's, as for
// the
// smallest drops.
float shown_from()
{
    const float step = max(look.texel_m[0], look.texel_m[1]) / max(uintBitsToFloat(narrowest), 1e-6);
    const float x = 1.0 + 1.1 * step, x2 = x * x;
    return look.threshold * (FILM || DENSITY != DENSITY_GOTO ? 0.2 : clamp(2.0 / (1.0 + x2 * x2), 0.1, 0.7));
}

// What the draws read: see picture_surface.glsl.
vec4 relief_of(vec4 texel, vec2 slope, float bend)
{
    const float film_cover = look.style != 0u ? smoothstep(1e-6, 4e-6, texel.w) : 0.0; // the paper has no film
    const float density = max(texel.x, 2.0 * look.threshold * film_cover);
    const float inner = look.opaque != 0u ? max(texel.y, 0.0) : bend;
    return vec4(density, slope, density > 0.7 * look.threshold ? -inner : texel.z);
}

// Looked up without a branch: in one, software Vulkan reads lane by lane.
bool is_glass(ivec2 texel)
{
    const vec2 at = (vec2(texel) + 0.5) * texel_m() / look.pane.cell_m;
    const uvec2 cell = uvec2(clamp(at, vec2(0.0), vec2(look.pane.columns, look.pane.rows) - 1.0));
    const uint known = surface[look.masked != 0u ? cell.x + cell.y * look.pane.columns : 0u];
    return look.masked == 0u || (known & 0x1000000u) != 0u;
}

void gather()
{
    const uint number = wet[gl_WorkGroupID.x + (FILM ? look.max_tiles : 0u)], lane = gl_LocalInvocationIndex;
    const ivec2 tile = ivec2(number % look.tile_columns, number / look.tile_columns);
    const virga_glass_tile_gpu at = tiles[number];
    const ivec2 own = ivec2(lane % 16u, lane / 16u * OWN), first = tile * VIRGA_GLASS_TILE + own - 1;
    const vec2 place = (vec2(first) + 0.5) * texel_m();
    find_largest(at);
    for (int i = 0; i < OWN; i++)
        sums[i] = ivec4(0);
    add_balls(at, place);
    if (FILM) {
        if (cells_are_wide())
            load_cells(tile);
        barrier();
        add_beads(place);
    }
    vec4 texels[OWN];
    for (int i = 0; i < OWN; i++) {
        float sheet = 0.0;
        if (FILM)
            sheet = sheet_at(tile, place + vec2(0.0, look.texel_m[1] * float(i)));
        const bool misty = (at.film & VIRGA_GLASS_HAS_MIST) != 0u && on_tile(own + ivec2(0, i));
        const float share = take_mist(first + ivec2(0, i), misty);
        texels[i] = texel_of(sums[i], sheet, share);
        heights[own.y + i][own.x] = look.style == 0u ? texels[i].x : texels[i].y;
    }
    barrier();
    bool any = false, shown = false;
    const int left = max(own.x - 1, 0), right = min(own.x + 1, 15), below = max(own.y - 1, 0),
        above = min(own.y + OWN, 15);
    float column[OWN + 2];
    column[0] = heights[below][own.x];
    column[OWN + 1] = heights[above][own.x];
    for (int i = 0; i < OWN; i++)
        column[i + 1] = look.style == 0u ? texels[i].x : texels[i].y;
    for (int i = 0; i < OWN; i++) {
        const int row = own.y + i;
        const vec2 before = vec2(heights[row][left], column[i]), after = vec2(heights[row][right], column[i + 2]);
        const vec2 slope = 0.5 * (after - before) / texel_m();
        const vec2 bend = abs(after + before - 2.0 * column[i + 1]) / (texel_m() * texel_m());
        const vec4 relief = is_glass(first + ivec2(0, i)) ? relief_of(texels[i], slope, max(bend.x,
            bend.y)) : vec4(0.0);
        if (on_tile(ivec2(own.x, row))) {
            imageStore(relief_out, first + ivec2(0, i), relief);
            if (WITH_MAP)
                imageStore(map_out, first + ivec2(0, i), texels[i]);
            any = any || dot(abs(texels[i]), vec4(1.0)) > 0.0;
            // Below the threshold, as a neighbour's rim may reach over.
            shown = shown || relief.x > shown_from() || relief.w > 0.0;
        }
    }
    const uint quarter = VIRGA_GLASS_QUARTER << (own.x > 7 ? 1 : 0);
    if (any)
        atomicOr(held, VIRGA_GLASS_WRITTEN | (shown ? quarter << (lane >= 32u ? 2 : 0) : 0u));
    barrier();
    if (lane == 0u)
        written[uint(tile.x) + uint(tile.y) * look.written_columns] = held;
}
