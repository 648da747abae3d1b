// picture_relief.comp - what the draws read of the height map: slopes, from differences between neighbours, and how
// they change. Over the tiles that have something to show, and those that had when a view was drawn before.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "picture_tiles.glsl"

#define TILE VIRGA_GLASS_TILE

layout(local_size_x = TILE, local_size_y = TILE) in;
layout(scalar, set = 0, binding = 4) readonly buffer Surface { uint surface[]; };
layout(scalar, set = 0, binding = 17) buffer Written { uint written[]; };
layout(scalar, set = 0, binding = 19) writeonly buffer Corners { uint corners[]; };
layout(set = 0, binding = 20, rgba32f) uniform writeonly image2D relief_out;
layout(set = 0, binding = 23) uniform sampler2D map; // a fetch is quicker than a load to software Vulkan

// What slopes are of: the paper takes the density's.
float level(vec4 texel) { return look.style == 0u ? texel.x : texel.y; }

// Not below the glass where `least` is 0: how deep a drop's surface would lie beside it matters to its rim alone.
float level_at(ivec2 texel, float least) { return max(level(texelFetch(map, texel, 0)), least); }

// Looked up without a branch: in one, software Vulkan reads lane by lane.
bool is_glass(ivec2 texel)
{
    const vec2 at = (vec2(texel) + 0.5) * texel_m() / look.pane.cell_m;
    const uvec2 cell = uvec2(clamp(at, vec2(0.0), vec2(look.pane.columns, look.pane.rows) - 1.0));
    const uint known = surface[look.masked != 0u ? cell.x + cell.y * look.pane.columns : 0u];
    return look.masked == 0u || (known & 0x1000000u) != 0u;
}

// See picture_surface.glsl. The mist of film is drawn apart.
vec4 relief_at(ivec2 at)
{
    const vec4 texel = texelFetch(map, at, 0);
    // At the map's border from one side only.
    const ivec2 low = max(at - 1, ivec2(0)), high = min(at + 1, ivec2(look.map_columns, look.map_rows) - 1);
    const float film_cover = look.style != 0u ? smoothstep(1e-6, 4e-6, texel.w) : 0.0; // the paper has no film
    // Beside drops a film lies flat, and so does what its own rim is drawn with.
    const float least = texel.x < (film_cover > 0.0 ? 1.0 : 0.4) * look.threshold ? 0.0 : -1e3;
    const vec2 before = vec2(level_at(ivec2(low.x, at.y), least), level_at(ivec2(at.x, low.y), least));
    const vec2 after = vec2(level_at(ivec2(high.x, at.y), least), level_at(ivec2(at.x, high.y), least));
    const vec2 slope = (after - before) / (vec2(high - low) * texel_m());
    const vec2 turn = abs(after + before - 2.0 * max(level(texel), least)) / (texel_m() * texel_m());
    const vec2 bend = mix(vec2(0.0), turn, equal(high - low, ivec2(2)));
    const float density = max(texel.x, 2.0 * look.threshold * film_cover);
    const float inner = look.opaque != 0u ? max(texel.y, 0.0) : max(bend.x, bend.y);
    const float mist = look.whole_map == 0u ? texel.z : 0.0;
    return is_glass(at) ? vec4(density, slope, density > 0.7 * look.threshold ? -inner : mist) : vec4(0.0);
}

// The tile as two triangles; corners are numbered along rows of the grid of all tiles.
void draw_tile(ivec2 tile)
{
    const uint columns = look.tile_columns + 1u, first = uint(tile.x) + uint(tile.y) * columns;
    const uint six[6] = uint[6](first, first + 1u, first + columns, first + columns, first + 1u, first + columns + 1u);
    const uint at = atomicAdd(work.drops.index_count, 6u);
    for (uint i = 0u; i < 6u; i++)
        corners[at + i] = six[i];
}

void main()
{
    const uint turn = gl_WorkGroupID.x + gl_WorkGroupID.y * VIRGA_GLASS_TILE_ROW;
    const uint number = wet[2u * look.max_tiles + look.max_blocks + min(turn, work.relief_tiles - 1u)];
    const ivec2 tile = ivec2(number % look.tile_columns, number / look.tile_columns);
    const ivec2 at = tile * TILE + ivec2(gl_LocalInvocationID.xy);
    const bool shown = (tiles[number].film & VIRGA_GLASS_SHOWN) != 0u;
    // One that has nothing to show any more is zero from now on, and not what it was when it was last written.
    imageStore(relief_out, at, shown ? relief_at(at) : vec4(0.0));
    const uint holds = uint(tile.x) + uint(tile.y) * look.written_columns;
    if (gl_LocalInvocationIndex == 0u && turn < work.relief_tiles) {
        written[holds] = (written[holds] & VIRGA_GLASS_HOLDS_WATER) | (shown ? VIRGA_GLASS_HOLDS_RELIEF : 0u);
        if (shown)
            draw_tile(tile);
    }
}
