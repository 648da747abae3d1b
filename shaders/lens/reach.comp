// reach.comp - what reaches each tile, see reach.glsl. At half resolution it also lists the tiles whose samples are
// read.
// One invocation per tile. Reads: tiles. Writes: reaches, lists, and what tiles were told, for the next view.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#define LISTS_ACCESS
#include "lists.glsl"
#include "levels.glsl"
#include "reach.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 9) buffer Tiles { virga_lens_tile_gpu tiles[]; };

void main()
{
    const uint tile = gl_GlobalInvocationID.x;
    if (tile >= view.tile_columns * view.tile_rows)
        return;
    const virga_lens_tile_gpu told = tiles[tile];
    tiles[tile] = virga_lens_tile_gpu(told.levels, 0u, 0u, 0u, 0u);
    reach_tile(tile, told);
    if (HALVED && (told.told & VIRGA_LENS_SAMPLED) != 0u)
        add_to_list(VIRGA_LENS_TILES_SAMPLED, tile);
}
