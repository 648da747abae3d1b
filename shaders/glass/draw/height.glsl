// height.glsl - the height map, tile by tile. For each texel the densities and heights of the balls that reach it are
// summed, as integers because the order is not defined; then blended and compressed. With SHUFFLE the balls are passed
// between invocations by subgroup shuffles, else through shared memory. LANES is the workgroup's size; each invocation
// has 64 / LANES texels in a column.
//
// Of each ball four sums are taken: its density V, V^2, V / z and h^2. Here z is its height with its sag, relative to
// the view's highest ball, x the distance from its middle over its radius, and h = z (1 - x^2) how high it is, 0
// outside of its rim. From them
//
//     I = (sum h^2)^(1/2)          is the height of a single ball, smooth where balls meet, and hardly more than that
//                                  of a large one where a small one lies in or under it
//     Z = (sum V) / (sum V / z)    is a mean height in which the lowest counts most, as 1 / z does
//     D = (sum V^2)^(1/2)          is the density of the outline, 1/2 at the rim of a single ball. Smooth as the sum,
//                                  it joins drops that touch, not yet those that are near: equal ones up to
//                                  2.33 radii apart, by Goto et al.'s density; by the sum it would be 2.63. Beads and
//                                  threads of film count as one ball that has the sum of theirs
//     P = Z p(E)                   where p is the 1 - x^2 at which a single ball has that density, up to 1/2; then
//                                  less, and 1 at 1.5. E is D at the rim and the sum of V inside, so that P closes the
//                                  crease between two drops
//
// P ends where the water ends, at a density of 1/2, and fills necks, where no ball is high. For a single ball it is
// nowhere above I, and both agree up to p = 1/2. So the height is P at the rim, and I with what P is above it,
// smoothly: I + d^3 / (d^2 + I^2 / 10), with d = P - I > 0.
//
// So a drop gives to one beside it a height, never a factor: with a mean that the highest rules, a bead beside a large
// drop was raised by the ratio of both, with walls ten times as steep as a drop's at its rim. Where water of one
// pressure meets the glass at one angle, it is nowhere steeper than there. Here two caps are at most 1.8 times as steep
// (Goto et al.'s density, sizes up to 1 : 10, by the formula), outside of the larger one at most 1.6 times.
//
// With Chen and Zhang's weights, k = t_i, R_i minus the distance, there are sums of k, k V, k V z and k K, where
// K = 1 / (1 + x^2)^2, for weighted means. Their height is (sum k V z) / (sum k V) times 2 - (mean of K)^(-1/2), which
// is 1 - x^2 for a single ball; near the rim it follows the density.
//
// One more sum is the mist of drops that are too small for a shape: each is spread over the four texels around its
// middle, by their distance, so that its whole area is kept.
//
// Slopes need neighbours. The next pass (relief.comp) computes them; in the paper's style, which shows only densities
// and mist, the draw does. A texel is then one word, see paper_texel.glsl.
#define DENSITY_SPECIAL
#include "view.glsl"
#include "density.glsl"
#include "tiles.glsl"
#include "beads.glsl"
#include "pinning.glsl"
#include "paper_texel.glsl"
#include "mask.glsl"

#define ONE 8388608.0 // 1 in the sums: 255 balls on top of each other do not overflow
#define SQUARED 16777216.0 // and in that of squares of heights: the view's highest ball has 0.4 there
#define MAX_INVERSE 128.0 // of heights; lower balls count as if they were so high
#define INVERSE (ONE / MAX_INVERSE)
#define MAX_CELLS 14 // max cells along a side that a tile lies on or beside, where beads have a shape

layout(local_size_x = TILE, local_size_y = LANES / TILE) in;
layout(scalar, set = 0, binding = 8) readonly buffer Entries { uint entries[]; };
layout(scalar, set = 0, binding = 9) readonly buffer Mist { uint mist[]; }; // four texels of the mist map in a word
layout(set = 0, binding = 11, rgba32f) uniform writeonly image2D map_out;
layout(set = 0, binding = 26, r32ui) uniform writeonly uimage2D paper_out;
layout(scalar, set = 0, binding = 17) buffer Written { virga_glass_written_gpu written[]; };

struct Ball {
    vec2 middle, sag;
    float inv_radius, height, peak, mist;
    vec2 stretch; // of its outline, see virga_glass_ball_gpu
};

// Not in an array, which would be kept in memory: compilers do not unroll a loop that contains one of unknown length.
struct Texel {
    vec2 position;
    ivec4 sums;
    int mist;
    ivec2 drops; // of the sums of V and V^2, what is not of beads and threads
};

#if LANES == 8
Texel texel0, texel1, texel2, texel3, texel4, texel5, texel6, texel7;
#define FOR_EACH(what) what(0) what(1) what(2) what(3) what(4) what(5) what(6) what(7)
#else // 64
Texel texel0;
#define FOR_EACH(what) what(0)
#endif

float unit_m, reach; // heights are divided by the first; distances in radii are below the second

shared uint bead_count, group_bits;
// Beads in any order: sums do not depend on it. Before them the balls of a batch, BALL_PLACES for each: more shared
// memory would mean fewer workgroups at once.
#define BALL_PLACES 4u
const uint PLACES = WITH_BEADS ? uint(MAX_CELLS * MAX_CELLS * BEADS) : BALL_PLACES * LANES;
shared vec3 beads[PLACES];

#ifndef SHUFFLE
void put_ball(uint i, Ball ball)
{
    beads[BALL_PLACES * i] = vec3(ball.middle, ball.inv_radius);
    beads[BALL_PLACES * i + 1u] = vec3(ball.sag, ball.height);
    beads[BALL_PLACES * i + 2u] = vec3(ball.stretch, ball.peak);
    beads[BALL_PLACES * i + 3u].x = ball.mist;
}

Ball ball_from(uint i)
{
    const vec3 a = beads[BALL_PLACES * i], b = beads[BALL_PLACES * i + 1u], c = beads[BALL_PLACES * i + 2u];
    return Ball(a.xy, b.xy, a.z, b.z, c.z, beads[BALL_PLACES * i + 3u].x, c.xy);
}
#endif

Ball ball_of(uint entry)
{
    const virga_glass_ball_gpu b = balls[entries[entry]];
    return Ball(vec2(b.middle[0], b.middle[1]), vec2(b.sag[0], b.sag[1]), 1.0 / b.radius_m,
                b.radius_m * look.cap_height / unit_m, b.peak, b.mist,
                PINNED ? vec2(b.stretch[0], b.stretch[1]) : vec2(0.0));
}

// What a ball adds to a texel's sums: V, V / z, h^2, V^2; by Chen and Zhang k, k V, k V z, k K. A ball that appears has
// a part of its density, `peak`; its height is then 0 near where that is 1/2.
ivec4 contributions(Ball ball, vec2 x, float x2, float density)
{
    if (!HEIGHTS && !WEIGHTED)
        return ivec4(int(density * ONE + 0.5), 0, 0, 0);
    const float height = ball.height * max(1.0 + dot(ball.sag, x), 0.2);
    if (!WEIGHTED) {
        const float high = height * max(2.0 - (1.0 + x2) * inversesqrt(max(ball.peak, 1e-4)), 0.0);
        const float inverse = density * min(1.0 / height, MAX_INVERSE);
        return ivec4(vec4(density * ONE, inverse * INVERSE, high * high * SQUARED, density * density * ONE) + 0.5);
    }
    // Chen and Zhang, equations 7 and 8. Radii are relative to the largest, as heights are.
    const float falloff = 1.0 / (1.0 + x2), k = ball.height * max(reach - sqrt(x2), 0.0) / reach;
    const float inner = ball.peak * k * density_window(x2, reach) * falloff * falloff;
    const vec4 each = ONE * vec4(k, k * density, k * density * height, inner) + 0.5;
    return ivec4(HEIGHTS ? each : vec4(each.xy, 0.0, 0.0));
}

void add_to(inout Texel texel, Ball ball)
{
    const vec2 off = texel.position - ball.middle, x = off * ball.inv_radius;
    const vec2 square = x * x;
    float x2 = square.x + square.y;
    if (PINNED) // the squared distance over that of the ellipse's rim
        x2 = sqrt(1.0 + dot(ball.stretch, ball.stretch)) * x2 + ball.stretch.x * (square.x - square.y) +
             2.0 * ball.stretch.y * x.x * x.y;
    const ivec4 parts = contributions(ball, x, x2, ball.peak * density_at(x2, reach));
    texel.sums += x2 < reach * reach && ball.peak > 0.0 ? parts : ivec4(0);
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
    // Each invocation reads one ball: software Vulkan reads lane by lane, and would read a shared ball as often. The
    // first batch is read outside of the loop, where reads are faster.
    Ball own_ball = ball_of(tile.first + min(gl_SubgroupInvocationID, max(tile.count, 1u) - 1u));
    for (uint from = 0u; from < tile.count;) {
        const uint batch_size = min(tile.count - from, gl_SubgroupSize);
        const vec4 ends = vec4(own_ball.middle, own_ball.sag);
        const vec4 sizes = vec4(own_ball.inv_radius, own_ball.height, own_ball.peak, own_ball.mist);
        for (uint i = 0u; i < batch_size; i++) {
            const vec4 e = subgroupShuffle(ends, i), s = subgroupShuffle(sizes, i);
            add(Ball(e.xy, e.zw, s.x, s.y, s.z, s.w, 
                     PINNED ? subgroupShuffle(own_ball.stretch, i) : vec2(0.0)));
        }
        from += gl_SubgroupSize;
        if (from < tile.count)
            own_ball = ball_of(tile.first + min(from + gl_SubgroupInvocationID, tile.count - 1u));
    }
#else
    for (uint from = 0u; from < tile.count; from += LANES) {
        const uint batch_size = min(tile.count - from, LANES);
        barrier();
        if (gl_LocalInvocationIndex < batch_size)
            put_ball(gl_LocalInvocationIndex, ball_of(tile.first + from + gl_LocalInvocationIndex));
        barrier();
        for (uint i = 0u; i < batch_size; i++)
            add(ball_from(i));
    }
#endif
}

vec2 middle_of(ivec2 texel) { return (vec2(texel) + 0.5) * texel_m(); }

#include "height_film.glsl"

// ---- results of the sums

// p: see above. What is taken off leaves Goto et al.'s, which has a vertical tangent at 1, the slope 1 there.
float neck_profile(float density)
{
    const float rim = 1.0 - density_inverse(density), over = max(rim - 0.5, 0.0);
    const float t = clamp(2.0 * (density - 1.0), 0.0, 1.0), off = DENSITY == DENSITY_GOTO ? 1.0 : 0.5;
    return max(rim - off * (over * over - 0.25 * t * (2.0 - t)), -1.0);
}

const float FAINT[2] = float[](0.01, 0.02); // far from any rim: squares of densities below are too coarse

// D. The paper's style has the paper's sum.
float outline_density(ivec4 sum, ivec2 drops)
{
    const float all = float(sum.x) / ONE, beads = float(sum.x - drops.x) / ONE;
    return PAPER ? all : mix(all, sqrt(float(drops.y) / ONE + beads * beads), smoothstep(FAINT[0], FAINT[1], all));
}

// x: blended density. y: height of the water over the glass (m), below 0 beside the water; 0 if heights are not needed.
vec2 summed(ivec4 sum, ivec2 drops)
{
    const float all = float(sum.x) / ONE;
    if (!HEIGHTS)
        return vec2(all, 0.0);
    if (FOR_GPU && sum == ivec4(0))
        return vec2(0.0); // what follows gives the same, and no ball reaches most texels of film
    const float density = outline_density(sum, drops), within = mix(density, all, smoothstep(0.5, 1.0, density));
    const float neck = float(sum.x) / float(max(sum.y, 1)) / MAX_INVERSE * neck_profile(within);
    const float high = sqrt(float(sum.z) / SQUARED), above = max(neck - high, 0.0);
    const float inner = high + above * above * above / max(above * above + 0.1 * high * high, 1e-12);
    return vec2(density, unit_m * mix(neck, inner, smoothstep(0.5, 0.7, density)));
}

vec2 weighted(ivec4 sum)
{
    const vec4 s = vec4(sum);
    const float density = s.y / max(s.x, 1.0);
    if (!HEIGHTS || sum.y <= 0)
        return vec2(density, 0.0);
    const float mean = s.z / s.y, inner = 2.0 - inversesqrt(max(s.w / max(s.x, 1.0), 1e-4));
    const float profile = mix(1.0 - density_inverse(density), inner, smoothstep(0.55, 0.9, density));
    return vec2(density, unit_m * mean * clamp(profile, -1.0, 2.0));
}

#define SHOWN 1u // there may be something to draw
#define WET 2u   // there is any water

// Writes a texel; returns SHOWN and WET. Red: density, compressed. Green: height (m). Blue: mist. Alpha: thickness of
// the sheet of film (m), which is given.
uint write_texel(ivec2 at, Texel texel, float sheet)
{
    const vec2 water = WEIGHTED ? weighted(texel.sums) : summed(texel.sums, texel.drops);
    const float density = compressed(water.x), drops_mist = min(float(texel.mist) / ONE, 1.0);
    // A lower bound than the threshold, because a pixel between this texel and its neighbour may be above the
    // threshold.
    const bool shown = density > 0.2 * look.threshold || drops_mist > 1.0 / 512.0;
    if (PAPER)
        imageStore(paper_out, at, uvec4(pack_paper_texel(density, drops_mist, is_glass(at))));
    const uint found = (shown ? SHOWN : 0u) | (density > 0.0 || drops_mist > 0.0 ? WET : 0u);
    if (!HEIGHTS)
        return found;
    const float film_there = smoothstep(0.0, 3e-6, sheet);
    imageStore(map_out, at,
               vec4(density, mix(water.y, max(water.y, 0.0), film_there) + sheet,
                    WITH_MAP ? min(drops_mist + film_mist(at), 1.0) : drops_mist, sheet));
    return PAPER || sheet <= 0.0 ? found : found | WET | (sheet > 1e-6 ? SHOWN : 0u);
}

// Adds a tile to the list of the next pass.
void list_tile(uvec2 tile)
{
    const uint index = atomicAdd(work.relief_tiles, 1u);
    work_list[2u * look.max_tiles + look.max_blocks + index] = packed_tile(tile);
    if (index < VIRGA_GLASS_TILE_ROW)
        atomicMax(work.relief_groups[0], index + 1u);
    if (index % VIRGA_GLASS_TILE_ROW == 0u) // the first of a row
        atomicMax(work.relief_groups[1], index / VIRGA_GLASS_TILE_ROW + 1u);
}

// By the invocations 0 to 4: lists the tile, and the four beside it. Where a tile has changed, slopes change in it and
// at the sides of those beside it: of these, all that have slopes already. Others list themselves if they get any. Each
// is listed once.
void list_around(ivec2 tile, uint i, bool itself)
{
    const ivec2 there = tile + (i == 0u ? ivec2(0) : i == 1u ? ivec2(1, 0) : i == 2u ? ivec2(-1, 0)
                                                          : i == 3u ? ivec2(0, 1) : ivec2(0, -1));
    if (there != clamp(there, ivec2(0), ivec2(look.tile_columns, look.tile_rows) - 1))
        return;
    const uint number = tile_number(uvec2(there));
    if (i == 0u ? !itself : (atomicOr(tiles[number].film, 0u) & VIRGA_GLASS_HAS_SLOPES) == 0u)
        return;
    if ((atomicOr(tiles[number].film, VIRGA_GLASS_LISTED) & VIRGA_GLASS_LISTED) == 0u)
        list_tile(uvec2(there));
}

// The tile of this workgroup, packed. A workgroup beyond the end of the list processes the last tile again.
uint tile_of_group()
{
    const uint index = gl_WorkGroupID.x + gl_WorkGroupID.y * VIRGA_GLASS_TILE_ROW;
    return work_list[min(index, (FILM ? work.film_tiles : work.tiles) - 1u) + (FILM ? look.max_tiles : 0u)];
}

// Balls are summed at displaced points.
void begin_texels(ivec2 first, bool displaced)
{
#define BEGIN(i)                                                      \
    {                                                                 \
        const vec2 at = middle_of(first + ivec2(0, i));               \
        texel##i = Texel(displaced ? at + pinned(at) : at, ivec4(0), 0, ivec2(0)); \
    }
    FOR_EACH(BEGIN)
}

// Keeps the sums of drops, before those of film are added.
void keep_drops()
{
#define KEEP(i) texel##i.drops = texel##i.sums.xw;
    FOR_EACH(KEEP)
}

// The texels' own places, for film.
void place_texels(ivec2 first)
{
#define PLACE(i) texel##i.position = middle_of(first + ivec2(0, i));
    FOR_EACH(PLACE)
}

#define SHOWN_BIT 16

// Returns bits: columns and rows of the tile that have water, and whether there may be something to draw. In a loop:
// with a copy of all this for each of eight texels software Vulkan takes four times as long to compile the pass.
uint write_texels(ivec2 first)
{
    const uint column = gl_LocalInvocationID.x, row = gl_LocalInvocationID.y;
    uint rows = 0u, shown = 0u;
#define PICK(k) \
    if (i == k) \
        texel = texel##k;
#if LANES == 8
    int cells = sheet_row(first);
    float above = sheet_along(first.x, cells);
    for (int i = 0; i < 8; cells++) { // each row of cells, and the texels between it and the next
        const float below = above;
        above = sheet_along(first.x, cells + 1);
        for (; i < 8 && sheet_row(first + ivec2(0, i)) == cells; i++) {
            Texel texel = texel0;
            FOR_EACH(PICK)
            const ivec2 at = first + ivec2(0, i);
            const uint found = write_texel(at, texel, sheet_between(at, below, above));
            shown |= found & SHOWN;
            rows |= (found & WET) / WET << i;
        }
    }
#else // 64: one texel
    const uint found = write_texel(first, texel0, sheet_at(texel0.position));
    shown = found & SHOWN;
    rows = (found & WET) / WET;
#endif
    return rows == 0u ? 0u : 1u << column | rows << (8u + row) | shown << SHOWN_BIT;
}

// The bits that any invocation of the workgroup has.
uint or_reduce(uint own)
{
#if defined(SHUFFLE) && LANES == 8
    // For software Vulkan both are constants, and this is three instructions.
    if (gl_SubgroupSize == LANES) {
        for (uint apart = 1u; apart < LANES; apart *= 2u)
            own |= subgroupShuffle(own, gl_SubgroupInvocationID ^ apart);
        return own;
    }
#endif
    if (gl_LocalInvocationIndex == 0u)
        group_bits = 0u;
    barrier();
    atomicOr(group_bits, own);
    barrier();
    return group_bits;
}

// Without a branch around everything: inside a branch software Vulkan reads lane by lane.
void gather()
{
    const ivec2 tile = unpacked_tile(tile_of_group());
    const uint number = tile_number(uvec2(tile));
    const ivec2 first = tile * TILE + ivec2(gl_LocalInvocationID.xy);
    const uint count = tiles[number].count;
    reach = density_reach();
    // 1.6: the higher side of a ball that sags.
    unit_m = max(widest_m(), WITH_BEADS ? VIRGA_GLASS_BEAD_CELLS * look.pane.cell_m : 1e-6) *
             look.cap_height * 1.6;
    begin_texels(first, PINNED);
    add_balls(tiles[number]);
    keep_drops();
    if (PINNED)
        place_texels(first);
    if (WITH_BEADS)
        add_beads(tile);
    load_sheets(tile * TILE);
    const uint found = or_reduce(write_texels(first));
    const uint slopes = PAPER ? 0u : tiles[number].film & VIRGA_GLASS_HAS_SLOPES;
    const bool shown = found >> SHOWN_BIT != 0u;
    const uint seen = (shown ? VIRGA_GLASS_SHOWN : 0u) | (found & 0xffffu) << VIRGA_GLASS_SPANS_BIT;
    if (!PAPER && gl_LocalInvocationIndex < 5u)
        list_around(tile, gl_LocalInvocationIndex, shown || slopes != 0u);
    if (gl_LocalInvocationIndex != 0u)
        return;
    atomicOr(tiles[number].film, seen);
    written[uint(tile.x) + uint(tile.y) * look.written_columns] =
        virga_glass_written_gpu(seen | (slopes != 0u ? VIRGA_GLASS_HOLDS_RELIEF : 0u) |
                                    (FILM || count != 0u ? VIRGA_GLASS_HOLDS_WATER : 0u),
                                tiles[number].content);
}
