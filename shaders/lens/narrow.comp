// narrow.comp - (half resolution, on GPUs) what reach.comp, sample.comp and gather.comp do, in one pass, if no disc is
// wider than VIRGA_LENS_FINE texels and no layer lies on the scene. In a small picture each wait for the pass before
// costs as much as the pass does. And samples that are read 50 times are read from shared memory.
//
// ALONE (in place, and no layer has depths) it does what tile.comp does as well: a workgroup looks itself at all depths
// from which a disc may reach its tiles. Then it is the only pass before the draw. It gives each tile its kind, in an
// entry of its own in place of lists, which somebody would have to empty first.
//
// A workgroup has two tiles beside each other, and keeps the samples of those that something reaches, and of so much
// around them as reaches them. Tiles that nothing reaches have an empty rim, which is read with the fields of the tiles
// beside them; nothing is mixed there.
// One workgroup per two tiles. Reads: tiles, color, depth, state, aperture. Writes: fields, reaches, lists, and what
// tiles were told, for the next view; ALONE: fields, lists, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
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

const bool ALONE = (OWN_FORM & VIRGA_LENS_ALONE) != 0u;

const int TILE = VIRGA_LENS_TILE, TILES = 2; // of a workgroup, beside each other
const ivec2 REGION = ivec2(TILES * TILE, TILE);
const int TILE_BITS = 4, REGION_BITS = 5; // a product costs four times as much

layout(local_size_x = 16, local_size_y = 8) in; // two pairs of texels each
const int LANES = 128;
layout(std430, set = 0, binding = 1) writeonly buffer Written { virga_lens_state_gpu written; };
layout(scalar, set = 0, binding = 9) buffer Tiles { virga_lens_tile_gpu tiles[]; };
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;

const int MOST = (TILES * TILE + 2 * VIRGA_LENS_FINE) * (TILE + 2 * VIRGA_LENS_FINE); // texels
// Of a sample: its color, half of it as half floats; its radius, where they would move the edge of a lamp's disc; and a
// spread. That
// is 1 / area on the grid in front of the focus, whose sum is a coverage: half floats would let a thousandth of a lamp
// through what hides it. Else it is 1 / disc_area, and 0 for what is in focus. One load has all of it.
shared uvec4 kept[MOST];
// Of each tile. Words of floats that are not negative are in the same order as the floats.
shared uint found_near[TILES], found_far[TILES];
shared bool needs_rim[TILES], has_hard[TILES]; // it is read; a pixel of it is not from the fields alone

ivec2 first_texel; // of the tiles, in the work image
ivec2 kept_first;
ivec2 kept_size;

// Where a texel of this row would be if it were in the work image's first column. Each lane would multiply for a texel.
int row_of(ivec2 texel) { return (texel.y - kept_first.y) * kept_size.x - kept_first.x; }

vec3 color_of(uvec4 words) { return vec3(unpackHalf2x16(words.x), uintBitsToFloat(words.y)); }
float radius_at(int at) { return uintBitsToFloat(kept[at].z); }

vec4 sample_in(int row, ivec2 texel)
{
    const uvec4 words = kept[row + texel.x];
    return vec4(color_of(words), uintBitsToFloat(words.z));
}

float spread_in(int row, ivec2 texel) { return uintBitsToFloat(kept[row + texel.x].w); }

bool has_near; // circles of confusion from in front of the focus reach the tile
#define NEAR has_near
#define ON_SCENE false
#define NARROW
vec4 on_scene_mean(ivec2 texel) { return vec4(0.0); }
#include "gather.glsl"

// ---- what reaches the tiles

const float MARGIN = 2.5; // texels, as in tile.comp

bool is_tile(int i) { return int(gl_WorkGroupID.x) * TILES + i < int(view.tile_columns); }
uint tile_at(int i) { return gl_WorkGroupID.y * view.tile_columns + gl_WorkGroupID.x * uint(TILES) + uint(i); }

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

// All texels whose discs may reach the tiles. A disc has the radius of its nearest pixel, or of its farthest one. Loops
// over so many texels are most of what tiles in focus cost, so this one computes with floats, which fuse, and decides
// by depths alone. The last pixels of an odd side are looked at with those before them, and towards a corner a disc is
// taken for a square.
void look_around()
{
    const int around = int(view.max_radius + MARGIN) + 1;
    const float columns = float(REGION.x + 2 * around), count = columns * float(REGION.y + 2 * around);
    const float per_row = 1.0 / columns, half_row = 0.5 * per_row;
    const depth_line line = line_of_depths();
    // The corner between the pixels of a texel, in texture coordinates.
    const vec2 per_pixel = 1.0 / vec2(textureSize(scene_depth, 0)), origin = vec2(view.left, view.top);
    const vec2 start = (origin + vec2(2 * (first_texel - around) + 1)) * per_pixel, step_of = 2.0 * per_pixel;
    const vec2 low = (origin + 1.0) * per_pixel;
    const vec2 high = (origin + max(vec2(view.width, view.height) - 1.0, 1.0)) * per_pixel;
    vec2 near = vec2(0.0), far = vec2(0.0); // by tile
    for (float i = float(gl_LocalInvocationIndex); i < count; i += float(LANES)) {
        vec2 at;
        at.y = floor(i * per_row + half_row);
        at.x = i - at.y * columns;
        const vec4 stored = textureGather(scene_depth, clamp(at * step_of + start, low, high));
        const vec2 less = min(stored.xy, stored.zw), more = max(stored.xy, stored.zw);
        const vec2 depths = vec2(min(less.x, less.y), max(more.x, more.y));
        const vec2 ends = (depths + view.depth_a) * line.slope + line.at_infinity;
        const vec2 sorted = vec2(-min(ends.x, ends.y), max(ends.x, ends.y));
        if (max(sorted.x, sorted.y) <= SHARP_REACH)
            continue;
        const vec2 reach = clamp(sorted, vec2(-line.most), vec2(view.max_radius, line.most));
        const vec2 from_first = at - float(around);
        const vec2 along = vec2(gap_to(from_first.x), gap_to(from_first.x - float(TILE)));
        const vec2 gaps = max(along, vec2(gap_to(from_first.y))) - MARGIN;
        near = max(near, mix(vec2(0.0), vec2(reach.x), lessThanEqual(gaps, vec2(reach.x))));
        far = max(far, mix(vec2(0.0), vec2(reach.y), lessThanEqual(gaps, vec2(reach.y))));
    }
    for (int i = 0; i < TILES; i++) {
        if (near[i] > SHARP_REACH)
            atomicMax(found_near[i], floatBitsToUint(near[i]));
        if (far[i] > SHARP_REACH)
            atomicMax(found_far[i], floatBitsToUint(far[i]));
    }
}

// ---- the samples

// Of a tile: whether each pixel is from the fields alone, see `blurriness`.
void look_at_own(ivec2 at, vec4 radii)
{
    if (any(lessThan(abs(radii), vec4(1.0))))
        if (at == clamp(at, ivec2(0), REGION - 1))
            has_hard[at.x / TILE] = true;
}

// From colors as they are stored. Where all of them are finite nothing has to be done about it, but one look.
texel_sample stored_sample(vec3 a, vec3 b, vec3 c, vec3 d, texel_circles of)
{
    if (!SCENE_LINEAR)
        return mean_sample(scene_light(a), scene_light(b), scene_light(c), scene_light(d), of);
    texel_sample own = mean_sample(a, b, c, d, of);
    const vec3 most = max(max(abs(a), abs(b)), max(abs(c), abs(d)));
    if (!(max(max(most.x, most.y), most.z) <= 65504.0) || isnan(own.color.r + own.color.g + own.color.b))
        own = mean_sample(finite(a), finite(b), finite(c), finite(d), of);
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
    for (int i = int(gl_LocalInvocationIndex); i < kept_size.x * kept_size.y; i += LANES) {
        const float row = floor(float(i) * per_row + half_row);
        const ivec2 at = ivec2(float(i) - row * columns, row);
        texel_circles of;
        texel_sample own;
        if (whole) {
            const ivec2 low = clamp(first_pixel + (at << 1), low_pixel, high_pixel);
            of = circles_of(depth_circles(line, textureGather(scene_depth, vec2(low) * per_pixel + per_pixel).wzxy));
            own = stored_sample(texelFetch(scene_picture, low, 0).rgb,
                                texelFetchOffset(scene_picture, low, 0, ivec2(1, 0)).rgb,
                                texelFetchOffset(scene_picture, low, 0, ivec2(0, 1)).rgb,
                                texelFetchOffset(scene_picture, low, 0, ivec2(1, 1)).rgb, of);
        } else {
            const ivec2 texel = inside(kept_first + at);
            of = circles_of(circles_at(texel));
            own = sample_with(texel, of);
        }
        if (ALONE)
            look_at_own(at + offset, of.of_pixels);
        float spread_of = 0.0;
        if (own.radius < -POINT)
            spread_of = own.share * spread(own.radius);
        else if (own.radius > POINT)
            spread_of = 1.0 / disc_area(own.radius);
        kept[i] = uvec4(packHalf2x16(own.color.rg), floatBitsToUint(vec3(own.color.b, own.radius, spread_of)));
    }
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

// What gather_far finds for two texels whose circles of confusion are `own`, unless they are in front of the focus.
// Both read the same samples. A sample is cut to the circle of the texel, and min(radius, cut) has the larger of both
// weights.
//
// A sample in front of the focus covers nothing, as its radius is negative. One in focus covers no more than itself,
// where it is not gathered if the texel looks for what is behind it: it has no spread, and such a texel no area.
// A row has an even number of samples: two in each turn.
void gather_two(ivec2 texel, vec2 own, float largest, out vec4 sums[2])
{
    const bvec2 beside = lessThanEqual(abs(own), vec2(POINT));
    const vec2 circles = max(own, vec2(POINT)), reaches_far = mix(circles, vec2(largest), beside);
    const vec2 cut = mix(circles, vec2(view.max_radius), beside);
    const vec2 areas = mix(vec2(1.0 / disc_area(cut.x), 1.0 / disc_area(cut.y)), vec2(0.0), beside);
    const float reach = max(own.x < -POINT ? 0.0 : reaches_far.x, own.y < -POINT ? 0.0 : reaches_far.y);
    const int rows = max(own.x, own.y) < -POINT ? -1 : disc_rows(reach);
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

bool is_there(ivec2 texel) { return texel.x < int(view.columns) && texel.y < int(view.rows); }

void empty_rim(int pair)
{
    const ivec2 texel = first_of_pair(pair), in_tile = texel & (TILE - 1);
    const bool row = in_tile.y == 0 || in_tile.y == TILE - 1;
    if ((row || in_tile.x == 0) && is_there(texel))
        imageStore(fields, ivec3(texel, VIRGA_LENS_NEAR), vec4(0.0));
    if ((row || in_tile.x == TILE - 2) && is_there(texel + ivec2(1, 0)))
        imageStore(fields, ivec3(texel + ivec2(1, 0), VIRGA_LENS_NEAR), vec4(0.0));
}

void gather_both(int pair, vec2 reach)
{
    const ivec2 texel = first_of_pair(pair);
    const int at = row_of(texel) + texel.x;
    vec4 known[2] = vec4[2](vec4(0.0), vec4(0.0));
    if (!SHAPED && max(reach.x, reach.y) > POINT)
        gather_two(texel, vec2(radius_at(at), radius_at(at + 1)), reach.y, known);
    for (int i = 0; i < 2; i++)
        if (is_there(texel + ivec2(i, 0)))
            gather_texel(texel + ivec2(i, 0), reach, level_bit(0u, 0u) | level_bit(1u, 0u), known[i]);
}

// ALONE: the kind of a tile.
void enter(int i, vec2 reach)
{
    uint kind = kind_of(reach);
    if (kind != VIRGA_LENS_TILES_SHARP && !has_hard[i])
        kind = VIRGA_LENS_TILES_SOFT;
    listed[tile_at(i)] = kind | (reach.x > POINT ? VIRGA_LENS_HAS_NEAR : 0u);
}

void begin(int lane)
{
    first_texel = ivec2(gl_WorkGroupID.xy) << ivec2(REGION_BITS, TILE_BITS);
    if (lane < TILES) {
        found_near[lane] = found_far[lane] = 0u;
        has_hard[lane] = false;
        needs_rim[lane] = ALONE;
        if (!ALONE && is_tile(lane))
            take_told(lane);
    }
    if (ALONE && lane == 0 && gl_WorkGroupID.xy == uvec2(0u) && view.follow == 0u) {
        written.focus_inv_m = view.focus_inv_m; // in place of focus.comp
        written.focused = 1u;
    }
    barrier();
    if (ALONE)
        look_around();
    barrier();
}

void main()
{
    const int lane = int(gl_LocalInvocationIndex), own = int(gl_LocalInvocationID.x) >> (TILE_BITS - 1);
    begin(lane);
    const vec4 found = uintBitsToFloat(uvec4(found_near[0], found_far[0], found_near[1], found_far[1]));
    const bvec2 blurred = bvec2(!is_sharp(found.xy), !is_sharp(found.zw));
    const int around = disc_rows(max(max(found.x, found.y), max(found.z, found.w)));
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
        if (rim)
            empty_rim(pair);
    }
    if (ALONE && lane < TILES && is_tile(lane))
        enter(lane, lane == 0 ? found.xy : found.zw);
}
