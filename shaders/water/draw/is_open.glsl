// is_open.glsl - whether a splat lies over a block of pixels that the nearest water leaves open. The includer includes
// view.glsl and gpu/texels.glsl.
#include "gap_blocks.glsl"
TEXELS(open_blocks_texel, 31, 30)

// Bits of the columns [low; high] of a row of blocks.
uint bits_between(int low, int high) { return (2u << uint(high)) - (1u << uint(low)); }

bool has_open(ivec2 texel, ivec2 low, ivec2 high)
{
    const ivec2 first = texel * ivec2(VIRGA_WATER_OPEN_COLUMNS, VIRGA_WATER_OPEN_ROWS),
                last = ivec2(VIRGA_WATER_OPEN_COLUMNS, VIRGA_WATER_OPEN_ROWS) - 1;
    const ivec2 from = clamp(low - first, ivec2(0), last), to = clamp(high - first, ivec2(0), last);
    const uvec4 words = open_blocks_texel(first_open_texel() + open_texel(texel));
    const uint columns = bits_between(from.x, to.x) * 0x10001u;
    uvec4 rows; // a word has the rows 2 i and 2 i + 1
    for (int i = 0; i < 4; i++)
        rows[i] = (from.y <= 2 * i && 2 * i <= to.y ? 0xffffu : 0u) |
                  (from.y <= 2 * i + 1 && 2 * i + 1 <= to.y ? 0xffff0000u : 0u);
    return any(notEqual(words & rows & columns, uvec4(0u)));
}

// The range of a coordinate over a splat, in pixels of an axis: of (x + a s + b t) / w with s^2 + t^2 <= 1.
vec2 range_of(float center, float extent, vec2 w, float size_px)
{
    const vec4 ends = vec4(vec2(center - extent) / w, vec2(center + extent) / w);
    const vec2 lows = min(ends.xy, ends.zw), highs = max(ends.xy, ends.zw);
    return (0.5 * vec2(min(lows.x, lows.y), max(highs.x, highs.y)) + 0.5) * size_px;
}

#define OPEN_TEXELS 4 // along each side: splats that lie over more are drawn

// `center` and the two axes in clip coordinates x, y, w.
bool is_over_open(vec3 center, vec3 first, vec3 second)
{
    const vec3 extent = sqrt(first * first + second * second);
    const vec2 w = center.z + vec2(-extent.z, extent.z);
    if (w.x <= 0.1 * center.z)
        return true;
    const vec2 x = range_of(center.x, extent.x, w, float(look.width)),
               y = range_of(center.y, extent.y, w, float(look.height));
    const ivec2 last = ivec2(look.width, look.height) - 1;
    const ivec2 low = clamp(ivec2(floor(vec2(x.x, y.x) - 0.5)), ivec2(0), last) / VIRGA_WATER_BLOCK_PX,
                high = clamp(ivec2(floor(vec2(x.y, y.y) + 0.5)), ivec2(0), last) / VIRGA_WATER_BLOCK_PX;
    const ivec2 columns_rows = ivec2(VIRGA_WATER_OPEN_COLUMNS, VIRGA_WATER_OPEN_ROWS), begin = low / columns_rows,
                count = high / columns_rows - begin + 1;
    if (any(greaterThan(count, ivec2(OPEN_TEXELS))))
        return true;
    bool found = false;
    for (int i = 0; i < count.x * count.y && !found; i++)
        found = has_open(begin + ivec2(i % count.x, i / count.x), low, high);
    return found;
}
