// mist_blocks.comp - lists the blocks of the mist map that may have film; all others are empty.
// One invocation per block. Reads: flags of blocks of cells. Writes: the work list, dispatch and draw arguments.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#define PANE look.pane
#define FILM_BLOCKS_BINDING 25
#include "glass/film_blocks.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;
layout(scalar, set = 0, binding = 18) buffer Work
{
    virga_glass_work_gpu work;
    uint work_list[];
};

// A texel of the mist map covers mist_cells x mist_cells cells, so its block covers as many blocks of cells.
bool may_have_film(uvec2 block)
{
    const uvec2 counts = film_block_counts(), first = block * look.mist_cells;
    const uvec2 end = min(first + look.mist_cells, counts);
    uint any = 0u;
    for (uint y = first.y; y < end.y; y++)
        for (uint x = first.x; x < end.x; x++)
            any |= film_blocks[x + y * counts.x];
    return any != 0u;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x, columns = look.mist_pitch / VIRGA_GLASS_MIST_BLOCK;
    const uint rows = (look.mist_rows + VIRGA_GLASS_MIST_BLOCK - 1u) / VIRGA_GLASS_MIST_BLOCK;
    if (i == 0u) {
        work.mist.instance_count = 1u;
        work.mist.first_index = 6u * look.max_tiles;
        work.block_groups[1] = work.block_groups[2] = 1u;
        work.mist_groups[1] = work.mist_groups[2] = 1u;
    }
    const uvec2 block = uvec2(i % columns, i / columns);
    if (i < columns * rows && may_have_film(block))
        work_list[3u * look.max_tiles + look.max_blocks + atomicAdd(work.mist_groups[0], 1u)] = block.x | block.y << 16;
}
