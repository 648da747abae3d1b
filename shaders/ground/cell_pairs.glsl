// cell_pairs.glsl - the passes that share and soak in what fell, on a GPU: they look at each cell of the blocks that
// have ground, where software Vulkan looks at the cells of each impact.
//
// An impact may stand for dozens of drops and wet a thousand cells, one after another, while few lanes have such
// impacts: the pass takes as long as the longest of them, in loads that wait for each other. All cells of 512 x 512 are
// 2 MB, which a GPU reads in less time, side by side. What a cell gets is a sum of integers, so both ways leave the
// same bits. Include cells.glsl before, and arrivals.
#include "gpu/variants.glsl"
#include "blocks.glsl"

layout(local_size_x = 64, local_size_x_id = 5) in; // constant 5: see gpu/pipeline_build.c

// A workgroup has as many blocks as one of a flow pass.
#define PAIRS_OF_GROUP uint(VIRGA_GROUND_PAIRS_EACH * VIRGA_GROUND_BLOCK / 2)

uint listed_blocks() { return floor_words[block_word(VIRGA_GROUND_BLOCK_COUNT)]; }

// The first cell of a pair of the workgroup; NO_CELL past the list of `count` blocks.
uint first_of_pair(uint pair, uint count)
{
    const uint in_block = uint(VIRGA_GROUND_BLOCK / 2);
    const uint entry = gl_WorkGroupID.x * uint(VIRGA_GROUND_PAIRS_EACH) + pair / in_block;
    if (entry >= count)
        return NO_CELL;
    return floor_words[list_word(entry)] * uint(VIRGA_GROUND_BLOCK) + 2u * (pair % in_block);
}
