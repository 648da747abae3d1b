// narrow_layer.glsl - (half resolution, on GPUs) what layer_sample.comp and layer.comp do for a layer that is out of
// focus, in one pass, where narrow.glsl gathers the scene. It needs nothing of other passes, so none is waited for: it
// looks itself at every pixel whose disc may reach its tiles, and runs beside the pass over the scene.
//
// Each texel of the layer spreads its color and its coverage over its circle of confusion, so both stay premultiplied,
// and nothing is mixed with the black of pixels without water. Sums are linear in the layer. So a disc that is partly
// wide (coarseness in lens.glsl) has two fields, one from half resolution and one from a quarter, which the draw adds.
//
// It says of each tile whether there is anything of the layer, and whether the draw needs the layer's own pixels. The
// draw reads nothing of a layer elsewhere. Where there is nothing, only the rim has a field, as draws read between it
// and the texels beside it; but what is not drawn in place has one everywhere.
//
// Bytes that have to move, for each pixel of 8 bytes of a layer that covers all and is out of focus everywhere: its
// color 8, its field written and read 2 x 8 / 4 (half resolution) or 2 x 8 / 16 (a quarter). With depths 4 more.
// One workgroup per two tiles. Reads: a layer, state, aperture. Writes: fields, lists.
// The includer says LAYER_DEPTHS if each pixel of the layer has a depth of its own.
#define OF_ONE_SCALE
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"
#define AREAS_OF_VIEW
#include "spread.glsl"
#define LISTS_ACCESS
#include "lists.glsl"
#include "aperture.glsl"

const int TILE = VIRGA_LENS_TILE, TILES = 2; // of a workgroup, beside each other
const ivec2 REGION = ivec2(TILES * TILE, TILE);
const int TILE_BITS = 4, REGION_BITS = 5; // a product costs four times as much

layout(push_constant) uniform Which { uint layer; };
layout(local_size_x = 16, local_size_y = 8) in; // two pairs of texels each
const int LANES = 128;
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;
layout(set = 0, binding = 33, rgba16f) uniform writeonly image2DArray coarse_fields;

// One texel more than a disc reaches: a draw reads between the texels of a tile and those beside it.
const int AROUND = VIRGA_LENS_FINE + 1;
const int MOST = (TILES * TILE + 2 * AROUND) * (TILE + 2 * AROUND); // texels
shared uvec2 kept[MOST]; // color and coverage of a sample, as half floats
#ifdef LAYER_DEPTHS
shared vec2 kept_discs[MOST]; // its radius, and 1 / area of its disc on the grid
#endif
shared uint widest, narrowest; // radius of all samples that are not empty, as words of floats
shared bool has_any; // color or coverage in a sample
shared bool is_seen; // the layer's own pixels are

ivec2 first_texel; // of the tiles, in the work image
ivec2 kept_first;
ivec2 kept_size;

int row_of(ivec2 texel) { return (texel.y - kept_first.y) * kept_size.x - kept_first.x; }
vec4 kept_color(int at) { return vec4(unpackHalf2x16(kept[at].x), unpackHalf2x16(kept[at].y)); }

#define COLORS vec4
#include "even_rows.glsl"

bool has_coarse() { return (view.coarse_layers >> layer & 1u) != 0u; }

// How much of a layer at one depth, which has this circle of confusion (texels), comes from this pass.
float own_share(float radius)
{
    const float wide = has_coarse() ? coarseness(radius * (1.0 / TEXELS)) : 0.0;
    return BY_SCALE(wide, (1.0 - wide));
}

// ---- the samples

// The circles of confusion of depths of the layer, which may be there where the scene has none.
depth_line line_of_layer()
{
    const float at_infinity = view.circle_px_m * focus_inv_m() * TEXELS;
    const float slope = view.depth_b != 0.0 ? -view.circle_px_m / view.depth_b * TEXELS : 0.0;
    return depth_line(slope, at_infinity, min(at_infinity, MAX_RADIUS));
}

// Of the pixels of a texel.
struct pixels_sum {
    vec4 color;
    float nearest; // circle of confusion
    bool seen;
};

// Where a color is infinite or no number, so is their sum, or what is left of it.
vec4 weighted_sum(layer_four of, vec4 weights)
{
    const vec4 sum = weights.x * of.a + weights.y * of.b + weights.z * of.c + weights.w * of.d;
    if (all(lessThanEqual(abs(sum), vec4(65504.0))))
        return sum;
    return weights.x * finite(of.a) + weights.y * finite(of.b) + weights.z * finite(of.c) + weights.w * finite(of.d);
}

bvec4 not_empty(layer_four of)
{
    return bvec4(of.a != vec4(0.0), of.b != vec4(0.0), of.c != vec4(0.0), of.d != vec4(0.0));
}

// 2 x 2 pixels; `first` is the first one, in the viewport.
void add_four(ivec2 first, inout pixels_sum to)
{
    const ivec2 last = ivec2(view.width, view.height) - 1, origin = ivec2(view.left, view.top);
    const ivec2 low = origin + min(first, last), high = origin + min(first + 1, last);
#ifdef LAYER_DEPTHS
    const vec4 radii = depth_circles(line_of_layer(), layer_depths(layer, low, high)), px = abs(radii) * (1.0 / TEXELS);
    const float least = min(min(px.x, px.y), min(px.z, px.w)), most = max(max(px.x, px.y), max(px.z, px.w));
    vec4 wide = vec4(0.0), weights = vec4(1.0);
    if (has_coarse() && most > VIRGA_LENS_COARSE_FROM)
        wide = vec4(coarseness(px.x), coarseness(px.y), coarseness(px.z), coarseness(px.w));
    if (least < 2.0)
        weights = vec4(blurriness(px.x), blurriness(px.y), blurriness(px.z), blurriness(px.w));
    weights *= BY_SCALE(wide, (1.0 - wide));
    if (weights == vec4(0.0) && least >= 2.0) // all of it comes from the other scale
        return;
    const vec4 nearest = mix(vec4(1e9), radii, greaterThan(weights, vec4(0.0)));
    to.nearest = min(to.nearest, min(min(nearest.x, nearest.y), min(nearest.z, nearest.w)));
    const layer_four colors = layer_colors(layer, low, high);
    if (least < 2.0)
        to.seen = to.seen || any(equal(uvec4(lessThan(px, vec4(2.0))) * uvec4(not_empty(colors)), uvec4(1u)));
    to.color += weighted_sum(colors, weights);
#else
    to.color += weighted_sum(layer_colors(layer, low, high), vec4(1.0));
#endif
}

pixels_sum pixels_at(ivec2 texel)
{
    pixels_sum sum = pixels_sum(vec4(0.0), 1e9, false);
    const ivec2 first = texel << BY_SCALE(2, 1);
    for (int i = 0; i < BY_SCALE(4, 1); i++)
        add_four(first + 2 * ivec2(i & 1, i >> 1), sum);
    sum.color *= BY_SCALE(1.0 / 16.0, 1.0 / 4.0);
    return sum;
}

void keep_samples()
{
    const float columns = float(kept_size.x), per_row = 1.0 / columns, half_row = 0.5 * per_row;
    vec2 ends = vec2(1e9, 0.0); // the narrowest and the widest disc
    bool any_here = false, seen = false;
    for (int i = int(gl_LocalInvocationIndex); i < kept_size.x * kept_size.y; i += LANES) {
        const float row = floor(float(i) * per_row + half_row);
        const pixels_sum own = pixels_at(inside(kept_first + ivec2(float(i) - row * columns, row)));
        const bool there = own.color != vec4(0.0);
        kept[i] = uvec2(packHalf2x16(own.color.rg), packHalf2x16(own.color.ba));
#ifdef LAYER_DEPTHS
        const float most = min(MAX_RADIUS, float(VIRGA_LENS_FINE)), radius = clamp(own.nearest, -most, most);
        kept_discs[i] = vec2(radius, there ? spread(radius) : 0.0);
        ends = there ? vec2(min(ends.x, abs(radius)), max(ends.y, abs(radius))) : ends;
#endif
        any_here = any_here || there;
        seen = seen || own.seen;
    }
    if (any_here)
        has_any = true;
    if (seen)
        is_seen = true;
    if (ends.y > 0.0) {
        atomicMin(narrowest, floatBitsToUint(ends.x));
        atomicMax(widest, floatBitsToUint(ends.y));
    }
}

// ---- the field

// Texels: each invocation has two beside each other, and two below them.
ivec2 first_of_pair(int pair)
{
    return first_texel + (ivec2(gl_LocalInvocationID.xy) << ivec2(1, 0)) + ivec2(0, pair << (TILE_BITS - 1));
}

void store(ivec2 texel, vec4 value)
{
    const ivec3 at = ivec3(texel, VIRGA_LENS_FIRST_LAYER + layer);
    if (any(greaterThanEqual(texel, WORK_SIZE)))
        return;
    if (COARSE)
        imageStore(coarse_fields, at, value);
    else
        imageStore(fields, at, value);
}

// Two texels, where all discs have about one radius, in front of the focus or behind it.
void gather_even(ivec2 texel, float radius, out vec4 sums[2])
{
    const even_sums of = gather_disc(texel, max(abs(radius), 0.5));
    const float per_area = spread(radius);
    sums[0] = per_area * (of.of_both + of.first);
    sums[1] = per_area * (of.of_both + of.second);
}

#ifdef LAYER_DEPTHS
const float EVEN = 1.0 / 16.0; // texels, as in even.glsl

// Two texels read the same samples.
void gather_two(ivec2 texel, float reach, out vec4 sums[2])
{
    const float least = uintBitsToFloat(narrowest);
    if (reach - least <= EVEN) {
        gather_even(texel, 0.5 * (reach + least), sums);
        return;
    }
    const int rows = disc_rows(reach);
    const float edge = max(reach, 0.5) + 0.5;
    sums[0] = sums[1] = vec4(0.0);
    for (int y = -rows; y <= rows; y++) {
        const float down = float(y) * float(y);
        const int columns = int(sqrt(max(edge * edge - down, 0.0))), row = row_of(texel + ivec2(0, y)) + texel.x;
        float before = sqrt(float(columns + 1) * float(columns + 1) + down); // from the second texel
        for (int x = -columns; x <= columns + 1; x++) {
            const float apart = sqrt(float(x) * float(x) + down);
            const vec2 disc = kept_discs[row + x];
            const vec2 covers = clamp(max(abs(disc.x), 0.5) + 0.5 - vec2(apart, before), 0.0, 1.0);
            const vec4 color = kept_color(row + x);
            sums[0] += covers.x * disc.y * color;
            sums[1] += covers.y * disc.y * color;
            before = apart;
        }
    }
}

// As gather_depths in layer.comp.
vec4 gather_shaped(ivec2 texel, float reach)
{
    const barrel cut = barrel_at(texel);
    vec4 sum = vec4(0.0);
    const int rows = disc_rows(reach);
    for (int y = -rows; y <= rows; y++) {
        const int columns = row_reach(reach, y), row = row_of(texel + ivec2(0, y)) + texel.x;
        for (int x = -columns; x <= columns; x++) {
            const vec2 disc = kept_discs[row + x];
            const ivec2 apart = ivec2(x, y);
            sum += covers(disc.x < 0.0 ? apart : -apart, abs(disc.x), cut) * disc.y * kept_color(row + x);
        }
    }
    return sum;
}
#else
void gather_two(ivec2 texel, float radius, out vec4 sums[2]) { gather_even(texel, radius, sums); }

// As gather_plane in layer.comp.
vec4 gather_shaped(ivec2 texel, float radius)
{
    const barrel cut = barrel_at(texel);
    vec4 sum = vec4(0.0);
    const int rows = disc_rows(abs(radius));
    for (int y = -rows; y <= rows; y++) {
        const int columns = row_reach(abs(radius), y), row = row_of(texel + ivec2(0, y)) + texel.x;
        for (int x = -columns; x <= columns; x++) {
            const ivec2 apart = ivec2(x, y);
            sum += covers(radius < 0.0 ? apart : -apart, abs(radius), cut) * kept_color(row + x);
        }
    }
    return spread(radius) * sum;
}
#endif

// `share`: of the layer that comes from this pass, where all of it is at one depth.
void gather_pair(int pair, float radius, float share)
{
    const ivec2 texel = first_of_pair(pair);
    vec4 sums[2];
    if (SHAPED) {
        for (int i = 0; i < 2; i++)
            sums[i] = gather_shaped(texel + ivec2(i, 0), radius);
    } else {
        gather_two(texel, radius, sums);
    }
    for (int i = 0; i < 2; i++)
        store(texel + ivec2(i, 0), share * vec4(sums[i].rgb, min(sums[i].a, 1.0)));
}

void empty_pair(int pair)
{
    const ivec2 texel = first_of_pair(pair), in_region = texel - first_texel;
    const bool row = in_region.y == 0 || in_region.y == REGION.y - 1;
    if (!IN_PLACE || row || in_region.x == 0)
        store(texel, vec4(0.0));
    if (!IN_PLACE || row || in_region.x == REGION.x - 2)
        store(texel + ivec2(1, 0), vec4(0.0));
}

// ---- what is known of the tiles, which are those of half resolution

void tell_tiles(int lane)
{
    const ivec2 tiles = ivec2(BY_SCALE(2 * TILES, TILES), BY_SCALE(2, 1));
    const ivec2 size = ivec2(view.tile_columns, view.tile_rows);
    const ivec2 own = ivec2(lane & (tiles.x - 1), lane >> BY_SCALE(2, 1));
    const ivec2 tile = ivec2(gl_WorkGroupID.xy) * tiles + own;
    const uint words = uint(size.x * size.y) * (1u + BY_SCALE(VIRGA_LENS_LAYERS, 0u) + layer);
    const uint there = has_any ? BY_SCALE(VIRGA_LENS_LAYER_COARSE, VIRGA_LENS_LAYER_FINE) : 0u;
    if (own.y < tiles.y && all(lessThan(tile, size)))
        listed[words + uint(tile.y * size.x + tile.x)] = there | (is_seen ? VIRGA_LENS_LAYER_SEEN : 0u);
}

void main()
{
    const int lane = int(gl_LocalInvocationIndex);
    float radius = circle(view.layer_inv_m[layer]); // of a plane
    float share = own_share(radius);
#ifdef LAYER_DEPTHS
    radius = min(MAX_RADIUS, float(VIRGA_LENS_FINE));
    share = 1.0;
#else
    radius = clamp(radius, -float(VIRGA_LENS_FINE), float(VIRGA_LENS_FINE));
#endif
    if (lane == 0) {
        has_any = is_seen = false;
        widest = 0u;
        narrowest = 0x7F7FFFFFu; // the largest float
    }
    barrier();
    const int around = disc_rows(abs(radius)) + 1;
    first_texel = ivec2(gl_WorkGroupID.xy) << ivec2(REGION_BITS, TILE_BITS);
    kept_first = first_texel - around;
    kept_size = REGION + 2 * around;
    if (share > 0.0)
        keep_samples();
    barrier();
#ifdef LAYER_DEPTHS
    radius = uintBitsToFloat(widest);
#else
    if (lane == 0 && has_any && blurriness(radius * (1.0 / TEXELS)) < 1.0)
        is_seen = true;
    barrier();
#endif
    for (int pair = 0; pair < 2; pair++) {
        if (has_any) // the same for all
            gather_pair(pair, radius, share);
        else
            empty_pair(pair);
    }
    if (IN_PLACE)
        tell_tiles(lane);
}
