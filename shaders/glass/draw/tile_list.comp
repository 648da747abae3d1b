// tile_list.comp - which tiles there is anything to do in, and where each one's list of balls begins. Numbers and
// places are given in any order: nothing depends on it. Where all entries do not fit, tiles with more than an equal
// share of the places are left out whole, so that what is seen does not depend on who came first either.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "tiles.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;
layout(scalar, set = 0, binding = 17) readonly buffer Written { uint written[]; };

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

// One lane for all of the workgroup.
void take_places()
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
    const uint count = look.tile_columns * look.tile_rows, i = gl_GlobalInvocationID.x, there = min(i, count - 1u);
    const uint held = written[there % look.tile_columns + there / look.tile_columns * look.written_columns];
    const uint balls_there = tiles[there].count, film = tiles[there].film;
    const bool fits = work.entries <= look.max_entries || balls_there <= look.max_entries / count;
    const uint own = i < count && fits ? balls_there : 0u;
    // A tile without water that had none before is as it was.
    const bool wet_tile = i < count && (balls_there | film | held | look.whole_map) != 0u;
    uint entry = 0u, number = 0u;
    if (wet_tile) {
        entry = atomicAdd(entries, own);
        number = atomicAdd(listed[film], 1u);
        if (!fits)
            atomicAdd(cut, balls_there);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        take_places();
    barrier();
    if (wet_tile) {
        wet[number + first_listed[film] + film * look.max_tiles] = i;
        tiles[i].first = entry + first_entry;
        tiles[i].count = own;
    }
}
