// narrow.glsl - (half resolution, on GPUs) what reach.comp, sample.comp and gather.comp do, in one pass, if no disc is
// wider than VIRGA_LENS_FINE texels and no layer lies on the scene. In a small picture each wait for the pass before
// costs as much as the pass does. And samples that are read 50 times are read from shared memory.
//
// ALONE (in place) it does what tile.comp does as well: a workgroup looks itself at all depths
// from which a disc may reach its tiles. Then it is the only pass before the draw. It gives each tile its kind, in an
// entry of its own in place of lists, which somebody would have to empty first.
//
// Wider discs (in place) come from the same pass at a quarter of the resolution: COARSE, whose
// texels have 4 x 4 pixels. A disc of 22 px is 5.5 texels there, as smooth as one of 11 px at half resolution. Where
// discs are narrower than VIRGA_LENS_COARSE_FROM px all comes from half resolution (FINER), and from
// VIRGA_LENS_COARSE_TO px on all from a quarter, so that nothing pops as a disc grows. A texel in front of the focus
// spreads its light in shares in both, and a pixel behind the focus or in it mixes both far fields by its own circle.
// Both are one pass (WIDE_PASS): a wait would cost more than it does where most of the picture is in focus or wide. A
// workgroup does its two coarse tiles, COARSE, and then those of the finer tiles in them that have anything to do, two
// at a time, FINER. So it never needs the coarse fields of others: the draw mixes both.
//
// Bytes that have to move, for each pixel of 8 bytes that is out of focus: depth 4, color 8, the far field written and
// read 2 x 4 / 4 (half resolution, in 32 bits) or 2 x 8 / 16 (a quarter), the picture 8. These are 22 bytes or 21, so
// 2.75 fills of half floats where all is out of focus, 2.63 with wide discs, and half a fill where nothing is. With
// layers, and where narrow and wide discs are together, the finer far field has 64 bits.
//
// A workgroup has two tiles beside each other, and keeps the samples of those that something reaches, and of so much
// around them as reaches them. Tiles that nothing reaches have an empty rim, which is read with the fields of the tiles
// beside them; nothing is mixed there. A draw that has an entry for every tile reads nothing across a side beyond which
// there is nothing, so ALONE (and FINER) only the corners are empty: each is beyond two sides, which may both have
// fields.
// One workgroup per two tiles. Reads: tiles, color, depth, state, aperture. Writes: fields, reaches, lists, and what
// tiles were told, for the next view; ALONE: fields, lists, state.
// The includer says WIDE_PASS if it is so. In loops a specialisation constant would be a branch.
#extension GL_EXT_control_flow_attributes : require
#include "lens.glsl"
#include "pixels.glsl"
#define SCENE_LINEAR ((OWN_FORM & VIRGA_LENS_NARROW_LINEAR) != 0u)
#include "scene_color.glsl"
#define AREAS_OF_VIEW
#include "spread.glsl"
#include "texels.glsl"
#include "sample.glsl"
#define LISTS_ACCESS
#include "lists.glsl"
#include "levels.glsl"
#include "reach.glsl"
#include "aperture.glsl"

// The largest radius that this pass gathers. FINER cuts samples to it, after it found out which pixels belong together.
#define OWN_MOST (FINER ? min(view.max_radius, float(VIRGA_LENS_FINE)) : MAX_RADIUS)

const bool ALONE = (OWN_FORM & VIRGA_LENS_ALONE) != 0u;
#define CORNERS_ARE_READ (ALONE && !COARSE)

const int TILE = VIRGA_LENS_TILE, TILES = 2; // of a workgroup, beside each other
const ivec2 REGION = ivec2(TILES * TILE, TILE);
const int TILE_BITS = 4, REGION_BITS = 5; // a product costs four times as much

layout(local_size_x = 16, local_size_y = 8) in; // two pairs of texels each
const int LANES = 128;
layout(std430, set = 0, binding = 1) writeonly buffer Written { virga_lens_state_gpu written; };
layout(scalar, set = 0, binding = 9) buffer Tiles { virga_lens_tile_gpu tiles[]; };
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;
#ifdef WIDE_PASS
layout(set = 0, binding = 33, rgba16f) uniform writeonly image2DArray coarse_fields;
layout(set = 0, binding = 41, rgba16f) uniform writeonly image2D near_circles; // of what is in the finer near field
#else
layout(set = 0, binding = 36, r32ui) uniform writeonly uimage2D packed_far; // see is_packed in lens_prepare.c
#include "shared_exponent.glsl"
#endif

const int MOST = (TILES * TILE + 2 * VIRGA_LENS_FINE) * (TILE + 2 * VIRGA_LENS_FINE); // texels
// Of a sample: its color, half of it as half floats; its radius, where they would move the edge of a lamp's disc; and a
// spread. That
// is 1 / area on the grid in front of the focus, whose sum is a coverage: half floats would let a thousandth of a lamp
// through what hides it. Else it is 1 / disc_area, and 0 for what is in focus. One load has all of it.
shared uvec4 kept[MOST];
// Of each tile. Words of floats that are not negative are in the same order as the floats.
shared uint found_near[TILES], found_far[TILES];
shared bool needs_rim[TILES], has_hard[TILES]; // it is read; a pixel of it is not from the fields alone
// Of the finer tiles in the coarse ones, in rows: what is found, as bits, and what they are told of it.
const int FINE_COLUMNS = 2 * TILES, FINE_TILES = 2 * FINE_COLUMNS;
shared uint needs_fine, has_wide, has_others;
shared uint told_fine[FINE_TILES];

uvec2 group; // of two tiles
int first_told; // FINER: of the two tiles, in told_fine
ivec2 first_texel; // of the tiles, in the work image
ivec2 kept_first;
ivec2 kept_size;
float kept_reach; // no texel may gather from farther away: there are no samples

// Where a texel of this row would be if it were in the work image's first column. Each lane would multiply for a texel.
int row_of(ivec2 texel) { return (texel.y - kept_first.y) * kept_size.x - kept_first.x; }

vec3 color_of(uvec4 words) { return vec3(unpackHalf2x16(words.x), uintBitsToFloat(words.y)); }
float radius_at(int at) { return uintBitsToFloat(kept[at].z); }

// The circle of a texel that gathers. FINER keeps no samples for the reach of wide ones, whose texels are read between
// those beside them. Elsewhere a circle may be longer than what was told of it, by the rounding of both.
float gathering_circle(float radius) { return clamp(radius, -kept_reach, kept_reach); }

vec4 sample_in(int row, ivec2 texel)
{
    const uvec4 words = kept[row + texel.x];
    return vec4(color_of(words), uintBitsToFloat(words.z));
}

float spread_in(int row, ivec2 texel) { return uintBitsToFloat(kept[row + texel.x].w); }

#ifdef WIDE_PASS
float finer_nearness, all_nearness; // of the samples behind a texel: that are not wide, and of all; see fill_of_both
float finer_circle = 0.0; // (texels) the mean of what is in the near field, which layers are before or behind
#endif

void write_field(ivec3 at, vec4 value)
{
#ifdef WIDE_PASS
    if (COARSE) {
        imageStore(coarse_fields, at, value);
        return;
    }
#else
    if (ALONE && view.layers == 0u && at.z == VIRGA_LENS_FAR) {
        imageStore(packed_far, at.xy, uvec4(shared_exponent(value.rgb)));
        return;
    }
#endif
    imageStore(fields, at, value);
#ifdef WIDE_PASS
    if (at.z == VIRGA_LENS_NEAR && (view.fine_layers | view.coarse_layers) != 0u)
        imageStore(near_circles, at.xy, vec4(finer_circle));
#endif
}

bool has_near; // circles of confusion from in front of the focus reach the tile
#define NEAR has_near
#define ON_SCENE false
#define NARROW

vec4 on_scene_mean(ivec2 texel) { return vec4(0.0); }
#include "gather.glsl"
#include "even.glsl"

// ---- what reaches the tiles

const float MARGIN = 2.5; // texels, as in tile.comp

bool is_tile(int i)
{
    return int(group.x) * TILES + i < int(TILE_COLUMNS) && (!FINER || group.y < view.tile_rows);
}

uint tile_at(int i) { return group.y * TILE_COLUMNS + group.x * uint(TILES) + uint(i); }

void take_told(int i)
{
    const virga_lens_tile_gpu told = tiles[tile_at(i)];
    tiles[tile_at(i)] = virga_lens_tile_gpu(told.levels, 0u, 0u, 0u, 0u);
    reach_tile(tile_at(i), told);
    found_near[i] = told.near;
    found_far[i] = told.far;
    needs_rim[i] = (told.told & VIRGA_LENS_SAMPLED) != 0u;
}

// How far (texels) a tile is from a place along an axis, which is relative to the tile's first texel.
float gap_to(float at) { return max(max(-at, at - float(TILE - 1)), 0.0); }

// What a square of 2 x 2 pixels tells the tiles: how far (texels) its discs reach in front of the focus and behind it.
// `ends`: its nearest circle of confusion and its farthest one. Where they are on both sides of a limit, there may be
// any in between.
vec2 told_reach(vec2 ends, float farthest)
{
    const vec2 most = vec2(OWN_MOST, min(farthest, OWN_MOST));
    const vec2 reach = clamp(vec2(-ends.x, ends.y), vec2(-farthest), most);
    if (COARSE)
        return mix(vec2(0.0), reach, greaterThan(reach, vec2(0.25 * VIRGA_LENS_COARSE_FROM)));
    if (FINER && (ends.x >= OWN_MOST || ends.y <= -OWN_MOST))
        return vec2(0.0); // all of it comes from the coarse fields
    return reach;
}

// COARSE: the finer tiles that pixels reach whose discs are not all wide, as bits. `from_first`: texels
// from the first one of the tiles to the middle of the square.
uint finer_tiles(vec2 from_first, vec2 ends)
{
    const float wide = 0.25 * VIRGA_LENS_COARSE_TO;
    if (ends.x >= wide || ends.y <= -wide)
        return 0u;
    const float far = min(max(-ends.x, ends.y), wide) + 0.5 * MARGIN + 0.5; // MARGIN is in finer texels
    const ivec2 low = max(ivec2(floor((from_first - far) * (2.0 / float(TILE)))), ivec2(0));
    const ivec2 high = min(ivec2(floor((from_first + far) * (2.0 / float(TILE)))), ivec2(FINE_COLUMNS, 2) - 1);
    if (any(greaterThan(low, high)))
        return 0u;
    const uint columns = (2u << high.x) - (1u << low.x);
    return (low.y == 0 ? columns : 0u) | (high.y == 1 ? columns << FINE_COLUMNS : 0u);
}

// COARSE: the finer tile that a texel is in, as a bit.
uint own_tile(ivec2 from_first)
{
    const ivec2 tile = from_first >> (TILE_BITS - 1);
    return tile == clamp(tile, ivec2(0), ivec2(FINE_COLUMNS, 2) - 1) ? 1u << (tile.y * FINE_COLUMNS + tile.x) : 0u;
}

// The nearest and the farthest circle of confusion of pixels, from their least and their greatest depths.
vec2 ends_between(vec2 less, vec2 more, depth_line line)
{
    const vec2 depths = vec2(min(less.x, less.y), max(more.x, more.y));
    const vec2 ends = (depths + view.depth_a) * line.slope + line.at_infinity;
    return vec2(min(ends.x, ends.y), max(ends.x, ends.y));
}

vec2 ends_of(vec4 stored, depth_line line)
{
    return ends_between(min(stored.xy, stored.zw), max(stored.xy, stored.zw), line);
}

vec2 both_ends(vec2 a, vec2 b) { return vec2(min(a.x, b.x), max(a.y, b.y)); }

// How depths around the tiles are read: in texture coordinates, the corner between four pixels.
struct depth_places {
    vec2 start, step_of, low, high;
};

depth_places places_around(int around)
{
    const vec2 per_pixel = 1.0 / vec2(textureSize(scene_depth, 0)), origin = vec2(view.left, view.top);
    const int pixels = BY_SCALE(4, 2);
    return depth_places((origin + vec2(pixels * (first_texel - around) + 1)) * per_pixel, float(pixels) * per_pixel,
                        (origin + 1.0) * per_pixel,
                        (origin + max(vec2(view.width, view.height) - 1.0, 1.0)) * per_pixel);
}

vec4 depths_of_four(vec2 place, depth_places from)
{
    return textureGather(scene_depth, clamp(place, from.low, from.high));
}

// What all looked-at texels tell.
struct told_around {
    vec2 near, far; // by tile
    uint finer, wide;
};

// `margin`: a tile is told of what ends so far (texels) before it.
void look_at_ends(vec2 from_first, vec2 ends, float farthest, float margin, inout told_around told)
{
    const vec2 reach = told_reach(ends, farthest);
    if (COARSE && max(reach.x, reach.y) > 0.0)
        told.wide |= own_tile(ivec2(from_first));
    const vec2 along = vec2(gap_to(from_first.x), gap_to(from_first.x - float(TILE)));
    const vec2 gaps = max(along, vec2(gap_to(from_first.y))) - margin;
    told.near = max(told.near, mix(vec2(0.0), vec2(reach.x), lessThanEqual(gaps, vec2(reach.x))));
    told.far = max(told.far, mix(vec2(0.0), vec2(reach.y), lessThanEqual(gaps, vec2(BY_SCALE(0.0, reach.y)))));
}

// COARSE: the depths of a texel, of 2 x 2 pixels each.
struct depths_16 {
    vec4 a, b, c, d;
};

depths_16 depths_at(vec2 place, depth_places from)
{
    const vec2 half_step = 0.5 * from.step_of;
    return depths_16(depths_of_four(place, from), depths_of_four(place + vec2(half_step.x, 0.0), from),
                     depths_of_four(place + vec2(0.0, half_step.y), from), depths_of_four(place + half_step, from));
}

void look_at_16(depths_16 of, vec2 from_first, depth_line line, inout told_around told)
{
    const vec2 a = ends_of(of.a, line), b = ends_of(of.b, line), c = ends_of(of.c, line), d = ends_of(of.d, line);
    const vec2 ends = both_ends(both_ends(a, b), both_ends(c, d));
    const float wide = 0.25 * VIRGA_LENS_COARSE_TO;
    if (max(-ends.x, ends.y) <= 0.5 * SHARP_REACH)
        return;
    look_at_ends(from_first, ends, line.most, MARGIN, told);
    if (ends.x >= wide || ends.y <= -wide)
        return;
    told.finer |= finer_tiles(from_first + vec2(0.25), a) | finer_tiles(from_first + vec2(0.75, 0.25), b) |
                  finer_tiles(from_first + vec2(0.25, 0.75), c) | finer_tiles(from_first + vec2(0.75), d);
}

// 2 x 2 texels at once: 16 depths have a least and a greatest one before any circle is computed. `place` is that of the
// first, and `from_first` its distance.
void look_at_four(vec2 place, vec2 from_first, depth_places from, depth_line line, inout told_around told)
{
    const vec2 first = clamp(place, from.low, from.high), last = clamp(place + from.step_of, from.low, from.high);
    const vec4 a = textureGather(scene_depth, first), b = textureGather(scene_depth, vec2(last.x, first.y));
    const vec4 c = textureGather(scene_depth, vec2(first.x, last.y)), d = textureGather(scene_depth, last);
    const vec4 less = min(min(a, b), min(c, d)), more = max(max(a, b), max(c, d));
    const vec2 ends = ends_between(min(less.xy, less.zw), max(more.xy, more.zw), line);
    if (max(-ends.x, ends.y) > SHARP_REACH)
        look_at_ends(from_first + 0.5, ends, line.most, MARGIN + 0.5, told);
}

// Column and row of the i-th of them in rows.
vec2 in_rows(float i, float columns, float per_row)
{
    const float row = floor((i + 0.5) * per_row);
    return vec2(i - row * columns, row);
}

// All texels whose discs may reach the tiles, in squares of two, or one by one if COARSE. A disc has the radius of the
// square's nearest pixel, or of its farthest one. Loops over so many are most of what tiles in focus cost, so this one
// computes with floats, which fuse, and decides by depths alone. The last pixels of an odd side are looked at with
// those before them, and towards a corner a disc is taken for a square.
//
// COARSE: wide discs from behind the focus cover only what is as far out of focus itself, so that they are looked for
// no farther than fields are read.
void look_around()
{
    const int bits = BY_SCALE(0, 1), around = ((int(OWN_MOST + MARGIN) >> bits) + 1) << bits;
    const ivec2 squares = (REGION + 2 * around) >> bits;
    const float columns = float(squares.x), count = columns * float(squares.y);
    const float per_row = 1.0 / columns;
    const depth_line line = line_of_depths();
    const depth_places from = places_around(around);
    const float side = float(1 << bits);
    const vec2 step_of = side * from.step_of;
    told_around told = told_around(vec2(0.0), vec2(0.0), 0u, 0u);
    const float each_turn = BY_SCALE(2.0, 1.0) * float(LANES);
    for (float i = float(gl_LocalInvocationIndex); i < count; i += each_turn) {
        const vec2 at = in_rows(i, columns, per_row);
        const vec2 place = at * step_of + from.start, from_first = at * side - float(around);
        if (COARSE) {
            // Two texels in a turn, all depths at once, so that half as much is waited for. A texel after the last one
            // is below all of `around`, and reaches nothing.
            const vec2 other = in_rows(i + float(LANES), columns, per_row);
            const depths_16 of = depths_at(place, from), of_other = depths_at(other * step_of + from.start, from);
            look_at_16(of, from_first, line, told);
            look_at_16(of_other, other * side - float(around), line, told);
        } else {
            look_at_four(place, from_first, from, line, told);
        }
    }
    for (int i = 0; i < TILES; i++) {
        if (told.near[i] > SHARP_REACH)
            atomicMax(found_near[i], floatBitsToUint(told.near[i]));
        if (told.far[i] > SHARP_REACH)
            atomicMax(found_far[i], floatBitsToUint(told.far[i]));
    }
    if (COARSE && (told.finer | told.wide) != 0u) {
        atomicOr(needs_fine, told.finer);
        atomicOr(has_wide, told.wide);
    }
}

// ---- the samples

// Of a tile: whether each pixel is from the fields alone, see `blurriness`. A texel with pixels on both sides of the
// focus is taken for one that has others.
void look_at_own(ivec2 at, texel_circles of)
{
    if (of.nearest < 1.0 && of.farthest > -1.0)
        if (at == clamp(at, ivec2(0), REGION - 1))
            has_hard[at.x / TILE] = true;
}

// COARSE: likewise, of a finer tile, and from the coarse fields alone.
void look_at_wide(ivec2 at, float least)
{
    if (least < 0.25 * VIRGA_LENS_COARSE_TO)
        if (at == clamp(at, ivec2(0), REGION - 1)) {
            const ivec2 tile = at >> (TILE_BITS - 1);
            atomicOr(has_others, 1u << (tile.y * FINE_COLUMNS + tile.x));
        }
}

// How much of the light of a texel in front of the focus goes to this pass. COARSE: wide_sample knows.
float own_share(float radius) { return FINER ? 1.0 - coarseness(radius * (1.0 / TEXELS)) : 1.0; }

// COARSE: the four pixels at a place.
vec4 four_circles(depth_line line, ivec2 low, ivec2 more, vec2 per_pixel)
{
    return depth_circles(line, textureGather(scene_depth, (vec2(low) + 0.5 + 0.5 * vec2(more)) * per_pixel).wzxy);
}

float least_of(vec4 four) { return min(min(four.x, four.y), min(four.z, four.w)); }

// COARSE: the nearest one that is wide.
float nearest_wide(vec4 radii) { return least_of(mix(vec4(1e9), radii, greaterThanEqual(abs(radii), vec4(BESIDE)))); }

// COARSE: how much of each of four pixels is in a texel: those that are about as near as the nearest one.
vec4 weights_near(vec4 radii, float nearest, float per_radius)
{
    return max(1.0 - abs(radii - nearest) * per_radius, 0.0);
}

vec3 stored_color(ivec2 pixel) { return texelFetch(scene_picture, pixel, 0).rgb; }

// COARSE: four pixels as they are stored, and their weighted sum.
struct stored_four {
    vec3 a, b, c, d;
};

stored_four stored_colors(ivec2 low, ivec2 more)
{
    const ivec2 high = low + more;
    return stored_four(stored_color(low), stored_color(ivec2(high.x, low.y)), stored_color(ivec2(low.x, high.y)),
                       stored_color(high));
}

vec3 weighted(stored_four of, vec4 weights)
{
    return weights.x * of.a + weights.y * of.b + weights.z * of.c + weights.w * of.d;
}

// COARSE: likewise, as light.
vec3 light_sum(ivec2 low, ivec2 more, vec4 weights)
{
    const ivec2 high = low + more;
    return weights.x * scene_color(low) + weights.y * scene_color(ivec2(high.x, low.y)) +
           weights.z * scene_color(ivec2(low.x, high.y)) + weights.w * scene_color(high);
}

float sum_of(vec4 four) { return dot(four, vec4(1.0)); }
float before_of(vec4 radii) { return dot(vec4(lessThan(radii, vec4(-BESIDE))), vec4(1.0 / 16.0)); }

// COARSE: a sample of the 4 x 4 pixels of a texel. As in sample.glsl, but of those that are about as near as the
// nearest wide one: a pole in focus hides no lamp behind it, and what is not wide is seen in the other fields. `least`:
// its smallest circle of confusion.
texel_sample wide_sample(ivec2 texel, depth_line line, vec2 per_pixel, out float least)
{
    const ivec2 origin = ivec2(view.left, view.top), last = ivec2(view.width, view.height) - 1;
    const ivec2 more = min(last, ivec2(1)), end = last - more;
    const ivec2 low = origin + clamp(texel << 2, ivec2(0), end), high = origin + clamp((texel << 2) + 2, ivec2(0), end);
    const ivec2 right = ivec2(high.x, low.y), below = ivec2(low.x, high.y);
    const vec4 a = four_circles(line, low, more, per_pixel), b = four_circles(line, right, more, per_pixel);
    const vec4 c = four_circles(line, below, more, per_pixel), d = four_circles(line, high, more, per_pixel);
    least = least_of(min(min(abs(a), abs(b)), min(abs(c), abs(d))));
    float nearest = least_of(min(min(a, b), min(c, d)));
    if (least < BESIDE) {
        const float of_wide = min(min(nearest_wide(a), nearest_wide(b)), min(nearest_wide(c), nearest_wide(d)));
        nearest = of_wide < 1e8 ? of_wide : nearest;
    }
    const float per_radius = 1.0 / max(abs(nearest), 1.0);
    const vec4 of_a = weights_near(a, nearest, per_radius), of_b = weights_near(b, nearest, per_radius);
    const vec4 of_c = weights_near(c, nearest, per_radius), of_d = weights_near(d, nearest, per_radius);
    const float per_weight = 1.0 / sum_of(of_a + of_b + of_c + of_d);
    const float radius = dot(of_a, a) + dot(of_b, b) + dot(of_c, c) + dot(of_d, d);
    float before = 0.0;
    if (nearest < -BESIDE) // as much of its light as of the nearest: the other pass has single ones
        before = (before_of(a) + before_of(b) + before_of(c) + before_of(d)) * coarseness(nearest * (1.0 / TEXELS));
    vec3 sum = vec3(0.0);
    // Eight at once, so that they are waited for twice: sixteen would spill registers on some cards.
    [[dont_unroll]] for (int lower = 0; SCENE_LINEAR && lower < 2; lower++)
        sum += weighted(stored_colors(lower == 0 ? low : below, more), lower == 0 ? of_a : of_c) +
               weighted(stored_colors(lower == 0 ? right : high, more), lower == 0 ? of_b : of_d);
    if (!SCENE_LINEAR || !(max(max(abs(sum.r), abs(sum.g)), abs(sum.b)) <= 65504.0) || isnan(sum.r + sum.g + sum.b))
        sum = light_sum(low, more, of_a) + light_sum(right, more, of_b) + light_sum(below, more, of_c) +
              light_sum(high, more, of_d);
    return texel_sample(sum * per_weight, radius * per_weight, before);
}

// From colors as they are stored. Where one of them is infinite or no number, so is their sum, or what is left of it.
// Where their sum is no more than the largest half float, nothing has to be done about them.
texel_sample stored_sample(stored_four from, texel_circles of)
{
    if (!SCENE_LINEAR)
        return mean_sample(scene_light(from.a), scene_light(from.b), scene_light(from.c), scene_light(from.d), of);
    texel_sample own = mean_sample(from.a, from.b, from.c, from.d, of);
    const float most = max(max(abs(own.color.r), abs(own.color.g)), abs(own.color.b));
    if (!(of.weight * most <= 65504.0) || isnan(own.color.r + own.color.g + own.color.b))
        own = mean_sample(finite(from.a), finite(from.b), finite(from.c), finite(from.d), of);
    return own;
}

void keep_samples()
{
    const float columns = float(kept_size.x), per_row = 1.0 / columns, half_row = 0.5 * per_row;
    const ivec2 offset = kept_first - first_texel;
    // Whether every texel of the picture has four pixels.
    const bool whole = ((view.width | view.height) & 1u) == 0u;
    const ivec2 low_pixel = ivec2(view.left, view.top);
    const ivec2 high_pixel = low_pixel + ivec2(view.width, view.height) - 2;
    const ivec2 first_pixel = low_pixel + (kept_first << 1);
    const vec2 per_pixel = 1.0 / vec2(textureSize(scene_depth, 0));
    const depth_line line = line_of_depths();
    vec2 least_and_most = vec2(MAX_RADIUS, 0.0);
    for (int i = int(gl_LocalInvocationIndex); i < kept_size.x * kept_size.y; i += LANES) {
        const float row = floor(float(i) * per_row + half_row);
        const ivec2 at = ivec2(float(i) - row * columns, row);
        texel_circles of;
        texel_sample own;
        if (COARSE) {
            float least;
            own = wide_sample(kept_first + at, line, per_pixel, least);
            look_at_wide(at + offset, least);
        } else if (whole) {
            const ivec2 low = clamp(first_pixel + (at << 1), low_pixel, high_pixel);
            // All are read at once, so that they are waited for once.
            const vec4 depths = textureGather(scene_depth, vec2(low) * per_pixel + per_pixel).wzxy;
            const stored_four colors = stored_colors(low, ivec2(1));
            of = circles_of(depth_circles(line, depths));
            own = stored_sample(colors, of);
        } else {
            const ivec2 texel = inside(kept_first + at);
            of = circles_of(circles_at(texel));
            own = sample_with(texel, of);
        }
        if (ALONE && !COARSE)
            look_at_own(at + offset, of);
        if (FINER)
            own.radius = clamp(own.radius, -OWN_MOST, OWN_MOST);
        float spread_of = own.radius > POINT ? 1.0 / disc_area(own.radius) : 0.0;
        if (own.radius < -POINT)
            spread_of = own.share * spread(own.radius) * own_share(own.radius);
        least_and_most = vec2(min(least_and_most.x, own.radius), max(least_and_most.y, own.radius));
        kept[i] = uvec4(packHalf2x16(own.color.rg), floatBitsToUint(vec3(own.color.b, own.radius, spread_of)));
    }
    note_kept(least_and_most);
}

// ---- the fields

// Texels of a tile: each invocation has two beside each other, and two below them.
ivec2 first_of_pair(int pair)
{
    return first_texel + (ivec2(gl_LocalInvocationID.xy) << ivec2(1, 0)) + ivec2(0, pair << (TILE_BITS - 1));
}

// Adds a sample to two texels. `room`: half a texel less how far it is from each.
void gather_one(uvec4 words, vec2 room, vec2 cut, vec2 areas, inout vec4 sums[2])
{
    const vec4 source = vec4(color_of(words), 1.0);
    const vec2 covers = clamp(min(vec2(uintBitsToFloat(words.z)), cut) + room, 0.0, 1.0);
    const vec2 weights = covers * max(vec2(uintBitsToFloat(words.w)), areas);
    sums[0] += weights.x * source;
    sums[1] += weights.y * source;
}

// What gather_far finds for two texels whose circles of confusion are `own`, where is_known says so. Both read the same
// samples. A sample is cut to the circle of the texel, and min(radius, cut) has the larger of both weights.
//
// A sample in front of the focus covers nothing, as its radius is negative. One in focus covers no more than itself,
// where it is not gathered if the texel looks for what is behind it: it has no spread, and such a texel no area.
// A row has an even number of samples: two in each turn.
void gather_two(ivec2 texel, vec2 own, float largest, out vec4 sums[2])
{
    const bvec2 beside = lessThanEqual(abs(own), vec2(BESIDE));
    const vec2 circles = max(own, vec2(POINT)), reaches_far = mix(circles, vec2(largest), beside);
    const vec2 cut = mix(circles, vec2(MAX_RADIUS), beside);
    const vec2 areas = mix(vec2(1.0 / disc_area(cut.x), 1.0 / disc_area(cut.y)), vec2(0.0), beside);
    const float least = BY_SCALE(BESIDE, -POINT); // see is_known
    const float reach = max(own.x < least ? 0.0 : reaches_far.x, own.y < least ? 0.0 : reaches_far.y);
    const int rows = max(own.x, own.y) < least ? -1 : disc_rows(reach);
    const float edge = max(reach, 0.5) + 0.5;
    int middle = row_of(texel - ivec2(0, rows)) + texel.x;
    sums[0] = sums[1] = vec4(0.0);
    for (float y = -float(rows); y <= float(rows); y += 1.0) {
        const float down = y * y;
        const int columns = int(sqrt(max(edge * edge - down, 0.0))); // as row_reach
        const int end = middle + columns;
        float x = -float(columns), before = 0.5 - sqrt((x - 1.0) * (x - 1.0) + down); // from the second texel
        for (int at = middle - columns; at <= end; at += 2) {
            const float one = 0.5 - sqrt(x * x + down), next = x + 1.0, two = 0.5 - sqrt(next * next + down);
            gather_one(kept[at], vec2(one, before), cut, areas, sums);
            gather_one(kept[at + 1], vec2(two, one), cut, areas, sums);
            before = two;
            x += 2.0;
        }
        middle += kept_size.x;
    }
}

bool is_there(ivec2 texel) { return all(lessThan(texel, WORK_SIZE)); }

void empty_rim(int pair)
{
    const ivec2 texel = first_of_pair(pair), in_tile = texel & (TILE - 1);
    const bool row = in_tile.y == 0 || in_tile.y == TILE - 1;
    if ((row || in_tile.x == 0) && is_there(texel))
        write_field(ivec3(texel, VIRGA_LENS_NEAR), vec4(0.0));
    if ((row || in_tile.x == TILE - 2) && is_there(texel + ivec2(1, 0)))
        write_field(ivec3(texel + ivec2(1, 0), VIRGA_LENS_NEAR), vec4(0.0));
}

// `corner`: of all tiles. FINER: what is behind wide near discs is read there as well, and all of it is coarse.
void empty_corner(int corner)
{
    const ivec2 side = ivec2(corner & 1, corner >> 1 & 1);
    const ivec2 texel = first_texel + (ivec2(corner >> 2, 0) << TILE_BITS) + side * (TILE - 1);
    if (!is_there(texel))
        return;
    write_field(ivec3(texel, VIRGA_LENS_NEAR), vec4(0.0));
    if (FINER)
        write_field(ivec3(texel, VIRGA_LENS_FAR), vec4(0.0, 0.0, 0.0, 1.0));
}

// The far fields of two texels, where there is nothing else. FINER: of a wide one the draw adds the coarse field, see
// fill_of_both.
void store_even(ivec2 texel, int at, vec4 sums[2])
{
    const float per_weight = 1.0 / sums[0].a; // the same of both
    for (int i = 0; i < 2; i++) {
        const float wide = FINER ? coarseness(radius_at(at + i) * float(STEP)) : 0.0;
        if (is_there(texel + ivec2(i, 0)))
            store(texel + ivec2(i, 0), vec4((1.0 - wide) * per_weight * sums[i].rgb, wide), vec4(0.0), vec4(0.0));
    }
}

void gather_both(int pair, vec2 reach)
{
    const ivec2 texel = first_of_pair(pair);
    const int at = row_of(texel) + texel.x;
    vec4 known[2] = vec4[2](vec4(0.0), vec4(0.0));
    const vec2 own = vec2(gathering_circle(radius_at(at)), gathering_circle(radius_at(at + 1)));
    const bool gathers = !SHAPED && max(reach.x, reach.y) > POINT;
    if (gathers && is_even()) {
        gather_even(texel, 0.5 * (own.x + own.y), known);
        if (reach.x <= POINT) { // nothing but that is here
            store_even(texel, at, known);
            return;
        }
    } else if (gathers) {
        gather_two(texel, own, reach.y, known);
    }
    for (int i = 0; i < 2; i++) {
        if (COARSE || FINER) // what the other pass has is not told, but what is behind it is filled in
            has_near = reach.x > POINT || radius_at(at + i) < -BESIDE;
        if (is_there(texel + ivec2(i, 0)))
            gather_texel(texel + ivec2(i, 0), reach, level_bit(0u, 0u) | level_bit(1u, 0u), known[i]);
    }
}

// FINER: the kind of a tile, with the coarse fields.
uint kind_of_both(uint told, uint kind)
{
    const bool coarse = (told & VIRGA_LENS_HAS_COARSE) != 0u;
    if (!coarse)
        return kind;
    if (kind == VIRGA_LENS_TILES_SHARP && (told & VIRGA_LENS_HAS_OTHERS) == 0u)
        return VIRGA_LENS_TILES_WIDE;
    return VIRGA_LENS_TILES_BLURRED;
}

// ALONE: the kind of a tile.
void enter(int i, vec2 reach)
{
    uint kind = kind_of(reach), beside = reach.x > POINT ? VIRGA_LENS_HAS_NEAR : 0u;
    if (kind != VIRGA_LENS_TILES_SHARP) {
        beside |= VIRGA_LENS_HAS_FINE;
        if (!has_hard[i])
            kind = VIRGA_LENS_TILES_SOFT;
    }
    if (FINER) {
        const uint told = told_fine[first_told + i];
        kind = kind_of_both(told, kind);
        beside |= told & (VIRGA_LENS_HAS_COARSE | VIRGA_LENS_HAS_COARSE_NEAR);
    }
    listed[tile_at(i)] = kind | beside;
}

// COARSE: what is known of a finer tile.
void tell_finer(int i)
{
    const bool has_near = uintBitsToFloat(found_near[i % FINE_COLUMNS < 2 ? 0 : 1]) > POINT;
    uint told = (needs_fine >> i & 1u) * VIRGA_LENS_NEEDS_FINE | (has_others >> i & 1u) * VIRGA_LENS_HAS_OTHERS;
    told |= has_near ? VIRGA_LENS_HAS_COARSE | VIRGA_LENS_HAS_COARSE_NEAR : 0u;
    told_fine[i] = told | (has_wide >> i & 1u) * VIRGA_LENS_HAS_COARSE;
}

void begin(int lane)
{
    if (lane == 0)
        begin_even();
    if (lane < TILES) {
        found_near[lane] = found_far[lane] = 0u;
        has_hard[lane] = false;
        needs_rim[lane] = ALONE;
        needs_fine = has_wide = has_others = 0u;
        if (!ALONE && is_tile(lane))
            take_told(lane);
    }
    if (ALONE && !FINER && lane == 0 && group == uvec2(0u) && view.follow == 0u) {
        written.focus_inv_m = view.focus_inv_m; // in place of focus.comp
        written.focused = 1u;
    }
    barrier();
    if (ALONE)
        look_around();
    barrier();
}

void place(uvec2 at)
{
    group = at;
    first_texel = ivec2(group) << ivec2(REGION_BITS, TILE_BITS);
}

// Two tiles.
void do_tiles(int lane)
{
    const int own = int(gl_LocalInvocationID.x) >> (TILE_BITS - 1);
    begin(lane);
    const vec4 found = uintBitsToFloat(uvec4(found_near[0], found_far[0], found_near[1], found_far[1]));
    const bvec2 blurred = bvec2(!is_sharp(found.xy), !is_sharp(found.zw));
    kept_reach = max(max(found.x, found.y), max(found.z, found.w));
    if (FINER) // a texel of a wide disc is filled in from those beside it
        kept_reach = max(kept_reach, 1.0);
    const int around = disc_rows(kept_reach);
    const ivec2 columns = ivec2(blurred.x ? 0 : TILE, blurred.y ? 2 * TILE : TILE); // first, and one after the last
    kept_first = first_texel + ivec2(columns.x, 0) - around;
    kept_size = ivec2(columns.y - columns.x, TILE) + 2 * around;
    const vec2 reach = own == 0 ? found.xy : found.zw;
    has_near = reach.x > POINT;
    if (any(blurred))
        keep_samples();
    barrier();
    const bool own_blurred = own == 0 ? blurred.x : blurred.y, rim = !own_blurred && needs_rim[own];
    for (int pair = 0; pair < 2; pair++) {
        if (own_blurred)
            gather_both(pair, reach);
        if (rim && !CORNERS_ARE_READ)
            empty_rim(pair);
    }
    if (!CORNERS_ARE_READ)
        return;
    if (lane < 4 * TILES && !blurred[lane >> 2])
        empty_corner(lane);
    if (lane < TILES && is_tile(lane))
        enter(lane, lane == 0 ? found.xy : found.zw);
}

#ifdef WIDE_PASS
// FINER: whether one of the two tiles has anything to do.
bool has_work() { return ((told_fine[first_told] | told_fine[first_told + 1]) & VIRGA_LENS_NEEDS_FINE) != 0u; }

// One loop, so that the code is there once. In its first turn it is COARSE.
void main()
{
    const int lane = int(gl_LocalInvocationIndex);
    for (int two = -1; two < FINE_TILES / TILES; two++) {
        COARSE = two < 0;
        first_told = (two & 1) * TILES + (two >> 1) * FINE_COLUMNS;
        place(COARSE ? gl_WorkGroupID.xy : gl_WorkGroupID.xy * 2u + uvec2(two & 1, two >> 1));
        if (COARSE || has_work()) {
            do_tiles(lane);
            barrier(); // before what it shares is written again
        } else {
            if (lane < 4 * TILES)
                empty_corner(lane);
            if (lane < TILES && is_tile(lane))
                enter(lane, vec2(0.0));
        }
        if (COARSE) {
            if (lane < FINE_TILES)
                tell_finer(lane);
            barrier();
        }
    }
}
#else
void main()
{
    place(gl_WorkGroupID.xy);
    do_tiles(int(gl_LocalInvocationIndex));
}
#endif
