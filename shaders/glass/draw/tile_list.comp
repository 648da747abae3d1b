// tile_list.comp - lists the tiles that need work, and gives each tile its range in the buffer of entries. Tiles that
// show the same as before need none, see tiles.glsl. The order is not defined, and no result depends on it. If the
// entries of all tiles do not fit, tiles with more than an equal share are left out as a whole, so that the picture
// does not depend on the order either.
// One invocation per tile. Reads: the tiles' counts and flags. Writes: work lists, dispatch sizes, the tiles' ranges.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "tiles.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;
layout(scalar, set = 0, binding = 17) readonly buffer Written { virga_glass_written_gpu written[]; };

shared uint entries, cut, listed[2], first_entry, first_listed[2];

void size_dispatch(bool with_film, uint count)
{
    const uint x = min(count, VIRGA_GLASS_TILE_ROW), y = (count + VIRGA_GLASS_TILE_ROW - 1u) / VIRGA_GLASS_TILE_ROW;
    if (with_film) {
        atomicMax(work.film_groups[0], x);
        atomicMax(work.film_groups[1], y);
    } else {
        atomicMax(work.tile_groups[0], x);
        atomicMax(work.tile_groups[1], y);
    }
}

// Called by one invocation for the workgroup.
void allocate()
{
    first_entry = atomicAdd(work.used, entries);
    first_listed[0] = atomicAdd(work.tiles, listed[0]);
    first_listed[1] = atomicAdd(work.film_tiles, listed[1]);
    size_dispatch(false, first_listed[0] + listed[0]);
    size_dispatch(true, first_listed[1] + listed[1]);
    if (cut != 0u)
        atomicAdd(work.cut, cut);
    if (gl_WorkGroupID.x == 0u) {
        work.tile_groups[2] = work.film_groups[2] = 1u;
        work.relief_groups[2] = work.drops.instance_count = 1u;
        work.ball_groups = uint[3]((work.balls + VIRGA_GLASS_FILL_GROUP - 1u) / VIRGA_GLASS_FILL_GROUP, 1u, 1u);
    }
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        entries = cut = listed[0] = listed[1] = 0u;
    barrier();
    const uint count = look.tile_columns * look.tile_rows, i = gl_GlobalInvocationID.x, clamped = min(i, count - 1u);
    const uvec2 tile = uvec2(clamped % look.tile_columns, clamped / look.tile_columns);
    const virga_glass_written_gpu before = written[tile.x + tile.y * look.written_columns];
    const uint before_map = before.holds & (VIRGA_GLASS_HOLDS_WATER | VIRGA_GLASS_HOLDS_RELIEF);
    const uint ball_count = tiles[clamped].count, film = tiles[clamped].film;
    const bool fits = work.entries <= look.max_entries || ball_count <= look.max_entries / count;
    const uvec2 content = uvec2(tiles[clamped].content[0], tiles[clamped].content[1]) + common_hash(fits, film != 0u);
    const bool same = look.whole_map == 0u && content == uvec2(before.content[0], before.content[1]);
    const uint entry_count = i < count && fits && !same ? ball_count : 0u;
    // A tile that has no water and had none before is unchanged.
    const bool needed = i < count && !same && (ball_count | film | before_map | look.whole_map) != 0u;
    uint entry = 0u, number = 0u;
    if (needed) {
        entry = atomicAdd(entries, entry_count);
        number = atomicAdd(listed[film], 1u);
    }
    if (i < count && !fits)
        atomicAdd(cut, ball_count);
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        allocate();
    barrier();
    if (i < count) {
        const uint slopes = (before.holds & VIRGA_GLASS_HOLDS_RELIEF) != 0u ? VIRGA_GLASS_HAS_SLOPES : 0u;
        tiles[i].film = film | slopes | (same ? before.holds & VIRGA_GLASS_SEEN : 0u);
        tiles[i].content = uint[2](content.x, content.y);
        tiles[i].count = entry_count;
    }
    if (needed) {
        work_list[number + first_listed[film] + film * look.max_tiles] = packed_tile(tile);
        tiles[i].first = entry + first_entry;
    }
}
