// relief.glsl - the relief map, which the draws read: slopes of the height map, from differences between neighbours,
// and curvature. It covers tiles that have something to draw, and those that had something when a view was drawn
// before: of both, those where the height map has changed in them or beside them.
//
// LANES is the workgroup's size; each invocation has 64 / LANES texels in a column. With 8, which must be one subgroup,
// an invocation has a whole column: it gets the texels above and below from its own fetches, and those beside from the
// neighbouring invocations.
#include "view.glsl"
#include "tiles.glsl"

layout(local_size_x = TILE, local_size_y = LANES / TILE) in;
layout(constant_id = 0) const uint MODE = 0u; // 1: the pane has a mask
#define MASKED (MODE != 0u)
#include "mask.glsl"
layout(scalar, set = 0, binding = 17) buffer Written { virga_glass_written_gpu written[]; };
layout(set = 0, binding = 20, rgba32f) uniform writeonly image2D relief_out;
layout(set = 0, binding = 23) uniform sampler2D map; // software Vulkan fetches faster than it loads

float height_of(vec4 texel) { return texel.y; } // the value whose slopes are taken

// Clamped at the map's border.
vec4 texel_at(ivec2 texel)
{
    return texelFetch(map, clamp(texel, ivec2(0), ivec2(look.map_columns, look.map_rows) - 1), 0);
}

// The texel's format is described in surface.glsl. The mist of film is drawn separately. `before`: heights to the left
// and below; `after`: heights to the right and above.
vec4 relief_of(ivec2 at, vec4 texel, vec2 before, vec2 after)
{
    // One-sided at the map's border.
    const ivec2 low = max(at - 1, ivec2(0)), high = min(at + 1, ivec2(look.map_columns, look.map_rows) - 1);
    const float film_cover = smoothstep(1e-6, 4e-6, texel.w);
    // Beside drops, film lies flat, and the rim of film does not go below the glass. A negative height beside a drop
    // matters only to the rim of that drop.
    const float min_height = texel.x < (film_cover > 0.0 ? 1.0 : 0.4) * look.threshold ? 0.0 : -1e3;
    before = max(before, vec2(min_height));
    after = max(after, vec2(min_height));
    const vec2 slope = (after - before) / (vec2(high - low) * texel_m());
    const vec2 index = abs(after + before - 2.0 * max(height_of(texel), min_height)) / (texel_m() * texel_m());
    const vec2 bend = mix(vec2(0.0), index, equal(high - low, ivec2(2)));
    const float density = max(texel.x, 2.0 * look.threshold * film_cover);
    const float inner = look.opaque != 0u ? max(texel.y, 0.0) : max(bend.x, bend.y);
    const float mist = look.whole_map == 0u ? texel.z : 0.0;
    return is_glass(at) ? vec4(density, slope, density > 0.7 * look.threshold ? -inner : mist) : vec4(0.0);
}

// A texel that has nothing to show any more is set to zero, not left as it was last written.
void write_texel(ivec2 at, bool shown, vec4 texel, vec2 before, vec2 after)
{
    imageStore(relief_out, at, shown ? relief_of(at, texel, before, after) : vec4(0.0));
}

#if LANES == 8
// The height beside this invocation's texel in row `row` of the tile: that of the invocation `beside` or, at the tile's
// end, `ends` of the invocation number `row`. All invocations call both shuffles: a shuffle from an invocation that
// does not take part is undefined.
float height_beside(float own, uint beside, bool at_end, float ends, uint row)
{
    const float inside = subgroupShuffle(own, beside), end = subgroupShuffle(ends, row);
    return at_end ? end : inside;
}

void write_tile(ivec2 first, bool shown)
{
    const uint lane = gl_SubgroupInvocationID, lane_left = max(lane, 1u) - 1u, lane_right = min(lane, 6u) + 1u;
    const float left = height_of(texel_at(first + ivec2(-1, lane))),
                right = height_of(texel_at(first + ivec2(TILE, lane)));
    vec4 own = texel_at(first + ivec2(lane, 0));
    float below = height_of(texel_at(first + ivec2(lane, -1)));
#define ROW(i)                                                                            \
    {                                                                                     \
        const vec4 next = texel_at(first + ivec2(lane, i + 1));                           \
        const float here = height_of(own);                                                \
        const float height_left = height_beside(here, lane_left, lane == 0u, left, i);    \
        const float height_right = height_beside(here, lane_right, lane == 7u, right, i); \
        write_texel(first + ivec2(lane, i), shown, own, vec2(height_left, below),         \
                    vec2(height_right, height_of(next)));                                 \
        below = here;                                                                     \
        own = next;                                                                       \
    }
    ROW(0) ROW(1) ROW(2) ROW(3) ROW(4) ROW(5) ROW(6) ROW(7)
}
#else // 64
void write_tile(ivec2 first, bool shown)
{
    const ivec2 at = first + ivec2(gl_LocalInvocationID.xy);
    const vec2 before = vec2(height_of(texel_at(at - ivec2(1, 0))), height_of(texel_at(at - ivec2(0, 1))));
    const vec2 after = vec2(height_of(texel_at(at + ivec2(1, 0))), height_of(texel_at(at + ivec2(0, 1))));
    write_texel(at, shown, texel_at(at), before, after);
}
#endif

void relief()
{
    const uint index = gl_WorkGroupID.x + gl_WorkGroupID.y * VIRGA_GLASS_TILE_ROW;
    const ivec2 tile =
        unpacked_tile(work_list[2u * look.max_tiles + look.max_blocks + min(index, work.relief_tiles - 1u)]);
    const bool shown = (tiles[tile_number(uvec2(tile))].film & VIRGA_GLASS_SHOWN) != 0u;
    write_tile(tile * TILE, shown);
    const uint tile_index = uint(tile.x) + uint(tile.y) * look.written_columns;
    if (gl_LocalInvocationIndex == 0u && index < work.relief_tiles)
        written[tile_index].holds =
            (written[tile_index].holds & ~VIRGA_GLASS_HOLDS_RELIEF) | (shown ? VIRGA_GLASS_HOLDS_RELIEF : 0u);
}
