// narrow.comp - (half resolution, on GPUs) what reach.comp, sample.comp and gather.comp do, in one pass, if no disc is
// wider than VIRGA_LENS_FINE texels and no layer lies on the scene. In a small picture each wait for the pass before
// costs as much as the pass does. And samples that are read 50 times are read from shared memory.
//
// A workgroup keeps the samples of its tile and of so much around it as reaches it. Tiles that nothing reaches have an
// empty rim, which is read with the fields of the tiles beside them; nothing is mixed there.
// One workgroup per tile. Reads: tiles, color, depth, state, aperture. Writes: fields, reaches, lists, and what tiles
// were told, for the next view.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#define SCENE_LINEAR ((OWN_FORM & VIRGA_LENS_NARROW_LINEAR) != 0u)
#include "scene_color.glsl"
#include "spread.glsl"
#include "texels.glsl"
#include "sample.glsl"
#define LISTS_ACCESS
#include "lists.glsl"
#include "levels.glsl"
#include "reach.glsl"
#include "aperture.glsl"

layout(local_size_x = 8, local_size_y = VIRGA_LENS_TILE) in;
layout(scalar, set = 0, binding = 9) buffer Tiles { virga_lens_tile_gpu tiles[]; };
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;

const uint LANES = VIRGA_LENS_TILE * 8u;
const int MOST = VIRGA_LENS_TILE + 2 * VIRGA_LENS_FINE; // texels along a side
shared uvec2 kept_colors[MOST * MOST]; // half floats
shared float kept_radii[MOST * MOST];  // first of all, what the tile was told: all 16 KiB are in use
// In front of the focus: 1 / area on the grid. Its sum is a coverage: half floats would let a thousandth of a lamp
// through what hides it. Else 1 / disc_area.
shared float kept_spreads[MOST * MOST];

ivec2 kept_first; // in the work image
int kept_side;

// Where a texel of this row would be if it were in the work image's first column. Each lane would multiply for a texel.
int row_of(ivec2 texel) { return (texel.y - kept_first.y) * kept_side - kept_first.x; }

vec4 sample_in(int row, ivec2 texel)
{
    const int at = row + texel.x;
    const uvec2 words = kept_colors[at];
    return vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y).x, kept_radii[at]);
}

float spread_in(int row, ivec2 texel) { return kept_spreads[row + texel.x]; }

bool has_near; // circles of confusion from in front of the focus reach the tile
#define NEAR has_near
#define ON_SCENE false
#define NARROW
vec4 on_scene_mean(ivec2 texel) { return vec4(0.0); }
#include "gather.glsl"

void keep_samples()
{
    const int count = kept_side * kept_side;
    for (int i = int(gl_LocalInvocationIndex); i < count; i += int(LANES)) {
        const int row = int((float(i) + 0.5) / float(kept_side));
        const texel_sample own = sample_of(inside(kept_first + ivec2(i - row * kept_side, row)));
        kept_colors[i] = uvec2(packHalf2x16(own.color.rg), packHalf2x16(vec2(own.color.b, 0.0)));
        kept_radii[i] = own.radius;
        if (own.radius < -POINT)
            kept_spreads[i] = own.share * spread(own.radius);
        else
            kept_spreads[i] = 1.0 / disc_area(max(own.radius, POINT));
    }
}

// Texels of the tile: each invocation has two beside each other.
ivec2 texel_of(int i)
{
    return ivec2(gl_WorkGroupID.xy) * VIRGA_LENS_TILE + ivec2(gl_LocalInvocationID.xy) * ivec2(2, 1) + ivec2(i, 0);
}

// What gather_far finds for two texels whose circles of confusion are `own`, unless they are in front of the focus.
// Both read the same samples. A sample is cut to the circle of the texel, and min(radius, cut) has the larger of both
// weights.
void gather_two(ivec2 texel, vec2 own, float largest, out vec4 sums[2])
{
    const bvec2 beside = lessThanEqual(abs(own), vec2(POINT));
    const vec2 circles = max(own, vec2(POINT)), reaches_far = mix(circles, vec2(largest), beside);
    const vec2 cut = mix(circles, vec2(view.max_radius), beside), least = mix(vec2(-POINT), vec2(POINT), beside);
    const vec2 per_area = vec2(1.0 / disc_area(cut.x), 1.0 / disc_area(cut.y));
    const float reach = max(own.x < -POINT ? 0.0 : reaches_far.x, own.y < -POINT ? 0.0 : reaches_far.y);
    const int rows = max(own.x, own.y) < -POINT ? -1 : disc_rows(reach);
    sums[0] = sums[1] = vec4(0.0);
    for (int y = -rows; y <= rows; y++) {
        const int columns = row_reach(reach, y), first = row_of(texel + ivec2(0, y)) + texel.x - columns;
        const float down = float(y) * float(y);
        float x = -float(columns), before = sqrt((x - 1.0) * (x - 1.0) + down); // from the second texel
        for (int at = first; at <= first + 2 * columns + 1; at++) {
            const uvec2 words = kept_colors[at];
            const vec4 source = vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y).x, 1.0);
            const float radius = kept_radii[at], distance = sqrt(x * x + down);
            const vec2 seen = max(min(vec2(radius), cut), vec2(POINT));
            const vec2 covers = clamp(seen - vec2(distance, before) + 0.5, 0.0, 1.0);
            const vec2 weights =
                mix(vec2(0.0), covers * max(vec2(kept_spreads[at]), per_area), greaterThanEqual(vec2(radius), least));
            sums[0] += weights.x * source;
            sums[1] += weights.y * source;
            before = distance;
            x += 1.0;
        }
    }
}

bool is_there(ivec2 texel) { return texel.x < int(view.columns) && texel.y < int(view.rows); }

void empty_rim()
{
    for (int i = 0; i < 2; i++) {
        const ivec2 texel = texel_of(i), in_tile = texel & (VIRGA_LENS_TILE - 1);
        const bool at_rim = any(equal(in_tile, ivec2(0))) || any(equal(in_tile, ivec2(VIRGA_LENS_TILE - 1)));
        if (at_rim && is_there(texel))
            store(texel, vec4(0.0), vec4(0.0), vec4(0.0));
    }
}

void gather_both(vec2 reach)
{
    const ivec2 texel = texel_of(0);
    const int at = row_of(texel) + texel.x;
    vec4 known[2] = vec4[2](vec4(0.0), vec4(0.0));
    if (!SHAPED && max(reach.x, reach.y) > POINT)
        gather_two(texel, vec2(kept_radii[at], kept_radii[at + 1]), reach.y, known);
    for (int i = 0; i < 2; i++)
        if (is_there(texel_of(i)))
            gather_texel(texel_of(i), reach, level_bit(0u, 0u) | level_bit(1u, 0u), known[i]);
}

void main()
{
    const uint tile = gl_WorkGroupID.y * view.tile_columns + gl_WorkGroupID.x;
    if (gl_LocalInvocationIndex == 0u) {
        const virga_lens_tile_gpu told = tiles[tile];
        tiles[tile] = virga_lens_tile_gpu(told.levels, 0u, 0u, 0u, 0u);
        reach_tile(tile, told);
        kept_radii[0] = uintBitsToFloat(told.near);
        kept_radii[1] = uintBitsToFloat(told.far);
        kept_radii[2] = (told.told & VIRGA_LENS_SAMPLED) != 0u ? 1.0 : 0.0;
    }
    barrier();
    const vec2 reach = vec2(kept_radii[0], kept_radii[1]);
    const bool sampled = kept_radii[2] > 0.0;
    const bool blurred = !is_sharp(reach);
    const int around = disc_rows(max(reach.x, reach.y));
    kept_first = ivec2(gl_WorkGroupID.xy) * VIRGA_LENS_TILE - around;
    kept_side = VIRGA_LENS_TILE + 2 * around;
    has_near = reach.x > POINT;
    barrier();
    if (blurred)
        keep_samples();
    barrier();
    if (blurred)
        gather_both(reach);
    if (!blurred && sampled)
        empty_rim();
}
