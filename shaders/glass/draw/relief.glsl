// relief.glsl - what the draws read of the height map: slopes, from differences between neighbours, and how
// they change. Over the tiles that have something to show, and those that had when a view was drawn before.
//
// A lane has as many texels above one another as it takes; the includer says in LANES how many lanes there are. With
// eight, which have to be a subgroup, a lane has a column: it has what is below and above its texels from its own
// fetches, and what is beside them from the lanes beside it.
#include "view.glsl"
#include "tiles.glsl"

layout(local_size_x = LANES) in;
layout(constant_id = 0) const uint MODE = 0u; // 1: the pane has a mask
#define MASKED (MODE != 0u)
#include "mask.glsl"
layout(scalar, set = 0, binding = 17) buffer Written { uint written[]; };
layout(set = 0, binding = 20, rgba32f) uniform writeonly image2D relief_out;
layout(set = 0, binding = 23) uniform sampler2D map; // a fetch is quicker than a load to software Vulkan

float level(vec4 texel) { return texel.y; } // what slopes are of

// At the map's border the nearest that there is.
vec4 texel_at(ivec2 texel)
{
    return texelFetch(map, clamp(texel, ivec2(0), ivec2(look.map_columns, look.map_rows) - 1), 0);
}

// See surface.glsl. The mist of film is drawn apart. `before` and `after`: levels beside it, to the left and
// below, to the right and above.
vec4 relief_of(ivec2 at, vec4 texel, vec2 before, vec2 after)
{
    // At the map's border from one side only.
    const ivec2 low = max(at - 1, ivec2(0)), high = min(at + 1, ivec2(look.map_columns, look.map_rows) - 1);
    const float film_cover = smoothstep(1e-6, 4e-6, texel.w);
    // Beside drops a film lies flat, and so does what its own rim is drawn with: not below the glass. How deep a drop's
    // surface would lie beside it matters to its rim alone.
    const float least = texel.x < (film_cover > 0.0 ? 1.0 : 0.4) * look.threshold ? 0.0 : -1e3;
    before = max(before, vec2(least));
    after = max(after, vec2(least));
    const vec2 slope = (after - before) / (vec2(high - low) * texel_m());
    const vec2 turn = abs(after + before - 2.0 * max(level(texel), least)) / (texel_m() * texel_m());
    const vec2 bend = mix(vec2(0.0), turn, equal(high - low, ivec2(2)));
    const float density = max(texel.x, 2.0 * look.threshold * film_cover);
    const float inner = look.opaque != 0u ? max(texel.y, 0.0) : max(bend.x, bend.y);
    const float mist = look.whole_map == 0u ? texel.z : 0.0;
    return is_glass(at) ? vec4(density, slope, density > 0.7 * look.threshold ? -inner : mist) : vec4(0.0);
}

// One that has nothing to show any more is zero from now on, and not what it was when it was last written.
void put(ivec2 at, bool shown, vec4 texel, vec2 before, vec2 after)
{
    imageStore(relief_out, at, shown ? relief_of(at, texel, before, after) : vec4(0.0));
}

#if LANES == 8
// What is beside a lane's texel in the row `row` of the tile: of `own` what the lane `beside` has, or, at the tile's
// end, of `ends`, which each lane has for the row of its number. All lanes take part in both: a shuffle from one that
// does not is undefined.
float level_beside(float own, uint beside, bool at_end, float ends, uint row)
{
    const float inside = subgroupShuffle(own, beside), end = subgroupShuffle(ends, row);
    return at_end ? end : inside;
}

void put_tile(ivec2 first, bool shown)
{
    const uint lane = gl_SubgroupInvocationID, lane_left = max(lane, 1u) - 1u, lane_right = min(lane, 6u) + 1u;
    const float left = level(texel_at(first + ivec2(-1, lane))), right = level(texel_at(first + ivec2(TILE, lane)));
    vec4 own = texel_at(first + ivec2(lane, 0));
    float below = level(texel_at(first + ivec2(lane, -1)));
#define ROW(i)                                                                                                         \
    {                                                                                                                  \
        const vec4 next = texel_at(first + ivec2(lane, i + 1));                                                        \
        const float here = level(own);                                                                                 \
        const float level_left = level_beside(here, lane_left, lane == 0u, left, i);                                   \
        const float level_right = level_beside(here, lane_right, lane == 7u, right, i);                                \
        put(first + ivec2(lane, i), shown, own, vec2(level_left, below), vec2(level_right, level(next)));              \
        below = here;                                                                                                  \
        own = next;                                                                                                    \
    }
    ROW(0) ROW(1) ROW(2) ROW(3) ROW(4) ROW(5) ROW(6) ROW(7)
}
#else // 64
void put_tile(ivec2 first, bool shown)
{
    const ivec2 at = first + ivec2(gl_LocalInvocationIndex % TILE, gl_LocalInvocationIndex / TILE);
    const vec2 before = vec2(level(texel_at(at - ivec2(1, 0))), level(texel_at(at - ivec2(0, 1))));
    const vec2 after = vec2(level(texel_at(at + ivec2(1, 0))), level(texel_at(at + ivec2(0, 1))));
    put(at, shown, texel_at(at), before, after);
}
#endif

void relief()
{
    const uint turn = gl_WorkGroupID.x + gl_WorkGroupID.y * VIRGA_GLASS_TILE_ROW;
    const uint number = wet[2u * look.max_tiles + look.max_blocks + min(turn, work.relief_tiles - 1u)];
    const ivec2 tile = ivec2(number % look.tile_columns, number / look.tile_columns);
    const bool shown = (tiles[number].film & VIRGA_GLASS_SHOWN) != 0u;
    put_tile(tile * TILE, shown);
    const uint holds = uint(tile.x) + uint(tile.y) * look.written_columns;
    if (gl_LocalInvocationIndex == 0u && turn < work.relief_tiles)
        written[holds] = (written[holds] & VIRGA_GLASS_HOLDS_WATER) | (shown ? VIRGA_GLASS_HOLDS_RELIEF : 0u);
}
