// height.glsl - the height map, tile by tile: densities and heights of the balls that reach a texel are added
// up, in whole numbers as no order is kept, blended, and compressed. The includer says how a workgroup hands balls
// around: SHUFFLE, where every lane of a subgroup is known to exist, or not.
//
// Of each ball four sums: its density V; and, with the weight k, k V, k V z and k K, where z is its height, sag and
// all, over the highest of the view, and K = 1 / (1 + x^2)^2. With the weight k = z,
//
//     Z = (sum k V z) / (sum k V)     is the mean height, weighted by density and by height, so that a small ball in
//                                     or under a large one makes no dent
//     P = 2 - ((sum k K) / Z)^(-1/2)  is 1 - x^2 for a ball alone, smooth wherever balls merge, and below 2 however
//                                     many do
//
// and Z P the height. Two drops that become one: P = 1.29 in their middle; for caps of one angle it is 2^(1/3) = 1.26.
// Near the rim what the density says takes over, the x^2 of a ball alone that has it there, so that the water ends
// where the density is 1/2. Both are the same for a ball alone. By Chen and Zhang's weights k = t_i is R_i less the
// distance, sums are divided by that of the weights, and P is made of the weighted mean of K.
//
// A fifth sum is the mist of drops too small for a shape: each spread over the four texels around its middle by how
// near they are, all of its area, wherever it lies.
//
// Slopes need neighbours: they are the next pass's, relief.comp, or for the paper's style, which shows nothing
// but densities and mist, the draw's: a texel is a word then, see paper_texel.glsl.
//
// A lane has as many texels above one another as it takes; the includer says in LANES how many lanes there are.
#define DENSITY_SPECIAL
#include "view.glsl"
#include "density.glsl"
#include "tiles.glsl"
#include "beads.glsl"
#include "paper_texel.glsl"
#include "mask.glsl"

#define ONE 8388608.0 // 1 in the sums: 255 balls on top of each other do not overflow
#define MOST_CELLS 14 // along a side, that a tile lies on or beside where beads have a shape

layout(local_size_x = LANES) in;
layout(scalar, set = 0, binding = 8) readonly buffer Entries { uint entries[]; };
layout(scalar, set = 0, binding = 9) readonly buffer Mist { uint mist[]; }; // four texels of its map to a word
layout(set = 0, binding = 11, rgba32f) uniform writeonly image2D map_out;
layout(set = 0, binding = 26, r32ui) uniform writeonly uimage2D words_out;
layout(scalar, set = 0, binding = 17) buffer Written { uint written[]; }; // VIRGA_GLASS_HOLDS_..., tile by tile

struct Ball {
    vec2 middle, sag;
    float inv_radius, height, peak, mist;
};

// Not in an array, which would go to memory: compilers do not unroll a loop that has another of unknown length in it.
struct Texel {
    vec2 place;
    ivec4 sums;
    int mist;
};

#if LANES == 8
Texel texel0, texel1, texel2, texel3, texel4, texel5, texel6, texel7;
#define FOR_EACH(what) what(0) what(1) what(2) what(3) what(4) what(5) what(6) what(7)
#else // 64
Texel texel0;
#define FOR_EACH(what) what(0)
#endif

float unit_m, reach; // heights are over the first, distances over a ball's radius below the second

#ifndef SHUFFLE
shared Ball batch[LANES];
#endif
shared uint bead_count, found_by_all;
shared vec3 beads[MOST_CELLS * MOST_CELLS * BEADS]; // in any order, as sums have none

Ball ball_of(uint entry)
{
    const virga_glass_ball_gpu b = balls[entries[entry]];
    return Ball(vec2(b.middle[0], b.middle[1]), vec2(b.sag[0], b.sag[1]), 1.0 / b.radius_m,
                b.radius_m * look.cap_height / unit_m, b.peak, b.mist);
}

// What a ball adds to a texel's sums: V, or by Chen and Zhang k; k V; k V z; k K.
vec4 parts_of(Ball ball, vec2 x, float x2, float density)
{
    if (!HEIGHTS && !WEIGHTED)
        return vec4(density, 0.0, 0.0, 0.0);
    const float once = 1.0 / (1.0 + x2);
    const float height = ball.height * max(1.0 + dot(ball.sag, x), 0.2);
    // Chen and Zhang, equations 7 and 8. Radii are over the largest as heights are.
    const float k = WEIGHTED ? ball.height * max(reach - sqrt(x2), 0.0) / reach : height;
    const float inner = ball.peak * k * density_window(x2, reach) * once * once;
    const vec4 each = vec4(WEIGHTED ? k : density, k * density, k * density * height, inner);
    return HEIGHTS ? each : vec4(each.xy, 0.0, 0.0);
}

void add_to(inout Texel texel, Ball ball)
{
    const vec2 off = texel.place - ball.middle, x = off * ball.inv_radius;
    const float x2 = dot(x, x);
    const vec4 parts = parts_of(ball, x, x2, ball.peak * density_at(x2, reach));
    texel.sums += x2 < reach * reach && ball.peak > 0.0 ? ivec4(parts * ONE + 0.5) : ivec4(0);
    const vec2 near = max(1.0 - abs(off) / texel_m(), 0.0);
    texel.mist += int(ball.mist * near.x * near.y * ONE + 0.5);
}

void add(Ball ball)
{
#define ADD(i) add_to(texel##i, ball);
    FOR_EACH(ADD)
}

void add_balls(virga_glass_tile_gpu tile)
{
#ifdef SHUFFLE
    // Each lane looks at one ball: software Vulkan reads lane by lane, and would read one ball as often. The first are
    // read outside of the loop, where that is quicker.
    Ball mine = ball_of(tile.first + min(gl_SubgroupInvocationID, max(tile.count, 1u) - 1u));
    for (uint from = 0u; from < tile.count;) {
        const uint some = min(tile.count - from, gl_SubgroupSize);
        const vec4 ends = vec4(mine.middle, mine.sag);
        const vec4 sizes = vec4(mine.inv_radius, mine.height, mine.peak, mine.mist);
        for (uint i = 0u; i < some; i++) {
            const vec4 e = subgroupShuffle(ends, i), s = subgroupShuffle(sizes, i);
            add(Ball(e.xy, e.zw, s.x, s.y, s.z, s.w));
        }
        from += gl_SubgroupSize;
        if (from < tile.count)
            mine = ball_of(tile.first + min(from + gl_SubgroupInvocationID, tile.count - 1u));
    }
#else
    for (uint from = 0u; from < tile.count; from += LANES) {
        const uint some = min(tile.count - from, LANES);
        barrier();
        if (gl_LocalInvocationIndex < some)
            batch[gl_LocalInvocationIndex] = ball_of(tile.first + from + gl_LocalInvocationIndex);
        barrier();
        for (uint i = 0u; i < some; i++)
            add(batch[i]);
    }
#endif
}

#include "height_film.glsl"

// ---- what sums come to

// x: density as blended; y: height of the water over the glass (m), below 0 beside it, or where none is wanted 0.
vec2 blended(ivec4 sum)
{
    const vec4 s = vec4(sum);
    const bool weighted = WEIGHTED;
    const float density = weighted ? s.y / max(s.x, 1.0) : s.x / ONE;
    if (!HEIGHTS)
        return vec2(density, 0.0);
    const float mean = s.z / max(s.y, 1.0);
    const float inside = max(weighted ? s.w / max(s.x, 1.0) : s.w / ONE / max(mean, 1e-6), 1e-4);
    const float inner = 2.0 - inversesqrt(inside), rim = 1.0 - density_inverse(density);
    const float profile = mix(rim, inner, smoothstep(0.55, 0.9, density));
    const float height = unit_m * mean * clamp(profile, -1.0, 2.0);
    return sum.y > 0 ? vec2(density, height) : vec2(weighted ? 0.0 : s.x / ONE, 0.0);
}

#define SHOWN 1u // there may be something to show
#define WET   2u // there is any water

// Writes a texel; returns SHOWN and WET. Red: density, compressed. Green: height (m). Blue: mist. Alpha: thickness of
// the sheet of film (m).
uint put(ivec2 at, Texel texel)
{
    const vec2 water = blended(texel.sums);
    const float density = compressed(water.x), drops_mist = min(float(texel.mist) / ONE, 1.0);
    // Below the threshold, as a pixel between this texel and a neighbour may be above it.
    const bool shown = density > 0.2 * look.threshold || drops_mist > 1.0 / 512.0;
    if (PAPER)
        imageStore(words_out, at, uvec4(word_of(density, drops_mist, is_glass(at))));
    const uint found = (shown ? SHOWN : 0u) | (density > 0.0 || drops_mist > 0.0 ? WET : 0u);
    if (!HEIGHTS)
        return found;
    const float sheet = sheet_at(texel.place), film_there = smoothstep(0.0, 3e-6, sheet);
    imageStore(map_out, at, vec4(density, mix(water.y, max(water.y, 0.0), film_there) + sheet,
                                 WITH_MAP ? min(drops_mist + film_mist(at), 1.0) : drops_mist, sheet));
    return PAPER || sheet <= 0.0 ? found : found | WET | (sheet > 1e-6 ? SHOWN : 0u);
}

// Lists the tile for the next pass. By one lane, which does it once for a tile that is done twice.
void list_tile(uint number, uint before)
{
    if (PAPER || (before & VIRGA_GLASS_LISTED) != 0u)
        return;
    const uint turn = atomicAdd(work.relief_tiles, 1u);
    wet[2u * look.max_tiles + look.max_blocks + turn] = number;
    atomicMax(work.relief_groups[0], min(turn + 1u, VIRGA_GLASS_TILE_ROW));
    atomicMax(work.relief_groups[1], turn / VIRGA_GLASS_TILE_ROW + 1u);
}

// The tile of this workgroup. One beyond the list's end does the last tile once more.
uint tile_of_group()
{
    const uint turn = gl_WorkGroupID.x + gl_WorkGroupID.y * VIRGA_GLASS_TILE_ROW;
    return wet[min(turn, (FILM ? work.film_tiles : work.tiles) - 1u) + (FILM ? look.max_tiles : 0u)];
}

void begin_texels(ivec2 first)
{
#define BEGIN(i) texel##i = Texel((vec2(first + ivec2(0, i)) + 0.5) * texel_m(), ivec4(0), 0);
    FOR_EACH(BEGIN)
}

#define SHOWN_BIT 16

// Columns and rows of the tile that have water; and whether any may have something to show.
uint put_texels(ivec2 first)
{
    const uint column = gl_LocalInvocationIndex % TILE, row = gl_LocalInvocationIndex / TILE;
    uint rows = 0u, shown = 0u;
#define PUT(i)                                                                                                         \
    {                                                                                                                  \
        const uint found = put(first + ivec2(0, i), texel##i);                                                         \
        shown |= found & SHOWN;                                                                                        \
        rows |= (found & WET) / WET << i;                                                                              \
    }
    FOR_EACH(PUT)
    return rows == 0u ? 0u : 1u << column | rows << (8u + row) | shown << SHOWN_BIT;
}

// All bits that any lane has.
uint of_all(uint own)
{
#if defined(SHUFFLE) && LANES == 8
    // To software Vulkan both are constants, and this is three instructions.
    if (gl_SubgroupSize == LANES) {
        for (uint apart = 1u; apart < LANES; apart *= 2u)
            own |= subgroupShuffle(own, gl_SubgroupInvocationID ^ apart);
        return own;
    }
#endif
    if (gl_LocalInvocationIndex == 0u)
        found_by_all = 0u;
    barrier();
    atomicOr(found_by_all, own);
    barrier();
    return found_by_all;
}

// No branch around all of it: in one, software Vulkan reads lane by lane.
void gather()
{
    const uint number = tile_of_group();
    const ivec2 tile = ivec2(number % look.tile_columns, number / look.tile_columns);
    const ivec2 first = tile * TILE + ivec2(gl_LocalInvocationIndex % TILE, gl_LocalInvocationIndex / TILE);
    const uint count = tiles[number].count;
    const uint holds = uint(tile.x) + uint(tile.y) * look.written_columns, held = written[holds];
    reach = density_reach();
    // 1.6: the fatter side of one that sags.
    unit_m = max(uintBitsToFloat(work.highest), WITH_BEADS ? VIRGA_GLASS_BEAD_CELLS * look.pane.cell_m : 1e-6) *
             look.cap_height * 1.6;
    begin_texels(first);
    add_balls(tiles[number]);
    if (WITH_BEADS)
        add_beads(tile);
    const uint found = of_all(put_texels(first)), relief = PAPER ? 0u : held & VIRGA_GLASS_HOLDS_RELIEF;
    const bool shown = found >> SHOWN_BIT != 0u;
    if (gl_LocalInvocationIndex != 0u)
        return;
    written[holds] = relief | (FILM || count != 0u ? VIRGA_GLASS_HOLDS_WATER : 0u);
    const uint before =
        atomicOr(tiles[number].film, VIRGA_GLASS_LISTED | (shown ? VIRGA_GLASS_SHOWN : 0u) |
                                         (found & 0xffffu) << VIRGA_GLASS_SPANS_BIT);
    if (shown || relief != 0u)
        list_tile(number, before);
}
