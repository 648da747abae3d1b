// film_changed.comp - lists the tiles with film that show anything else than before, see tiles.glsl: their film has
// changed, or drops on it.
// One workgroup per VIRGA_GLASS_FILM_TILES tiles with film. Reads: the list of them, film, what was written. Writes:
// the list of the changed ones, its dispatch, the tiles' contents and bits.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "tiles.glsl"
#include "beads.glsl"

layout(local_size_x = 64) in;
#define LANES (64u / VIRGA_GLASS_FILM_TILES) // of a tile

layout(scalar, set = 0, binding = 17) readonly buffer Written { virga_glass_written_gpu written[]; };

shared uint sums[2 * VIRGA_GLASS_FILM_TILES];

#define SALT uvec2(0xa4093822u, 0x299f31d0u) // pi

// A cell as height_film.glsl reads it. While film breaks it changes with time.
uvec2 hash_of_cell(uint number)
{
    const uint water = film[number], wetted = passed[number];
    const uvec2 hash = absorb(absorb(absorb(CELL_HASH, number), water), wetted);
    return water == 0u ? uvec2(0u) : absorb(hash, film_fresh(water, wetted));
}

// This lane's part of the cells that a tile's texels may show: a sheet is read between cells, and a bead reaches into
// the next cell from its own, or from the way to the one after it (film_tiles_of).
uvec2 hash_of_cells(uvec2 tile, uint lane)
{
    const ivec2 last_cell = ivec2(look.pane.columns, look.pane.rows) - 1;
    const ivec2 low = clamp(ivec2(floor(vec2(tile) * tile_m() / look.pane.cell_m)) - 2, ivec2(0), last_cell);
    const ivec2 high = clamp(ivec2(floor(vec2(tile + 1u) * tile_m() / look.pane.cell_m)) + 2, ivec2(0), last_cell);
    const uvec2 size = uvec2(high - low + 1);
    uvec2 sum = uvec2(0u);
    for (uint i = lane; i < size.x * size.y; i += LANES) {
        const uvec2 cell = uvec2(low) + uvec2(i % size.x, i / size.x);
        sum += hash_of_cell(cell.x + cell.y * look.pane.columns);
    }
    return sum;
}

void list_changed(uint packed)
{
    const uint index = atomicAdd(work.changed_tiles, 1u);
    work_list[3u * look.max_tiles + 2u * look.max_blocks + index] = packed;
    if (index < VIRGA_GLASS_TILE_ROW)
        atomicMax(work.changed_groups[0], index + 1u);
    if (index % VIRGA_GLASS_TILE_ROW == 0u) // the first of a row
        atomicMax(work.changed_groups[1], index / VIRGA_GLASS_TILE_ROW + 1u);
}

void main()
{
    const uint own = gl_LocalInvocationIndex / LANES, lane = gl_LocalInvocationIndex % LANES;
    const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * VIRGA_GLASS_TILE_ROW;
    const uint index = group * VIRGA_GLASS_FILM_TILES + own;
    const uint packed = work_list[look.max_tiles + min(index, work.film_tiles - 1u)];
    const uvec2 tile = uvec2(unpacked_tile(packed));
    // Where a tile has very many cells it costs less to write it again. The host may read mist that changes.
    const bool look_at_cells = look.mist_cells == 1u && look.whole_map == 0u;
    if (lane == 0u)
        sums[2u * own] = sums[2u * own + 1u] = 0u;
    barrier();
    const uvec2 hash = look_at_cells ? hash_of_cells(tile, lane) : SALT;
    atomicAdd(sums[2u * own], hash.x);
    atomicAdd(sums[2u * own + 1u], hash.y);
    barrier();
    if (lane != 0u || index >= work.film_tiles)
        return;
    const uint number = tile_number(tile);
    const virga_glass_written_gpu before = written[tile.x + tile.y * look.written_columns];
    const uvec2 content =
        uvec2(tiles[number].content[0], tiles[number].content[1]) + uvec2(sums[2u * own], sums[2u * own + 1u]);
    tiles[number].content = uint[2](content.x, content.y);
    if (look_at_cells && content == uvec2(before.content[0], before.content[1]))
        tiles[number].film |= before.holds & VIRGA_GLASS_SEEN;
    else
        list_changed(packed);
}
