// film_blocks.glsl - which blocks of cells have film on any cell: most passes over film then have few cells to look at.
// The includer defines PANE (a struct with the pane's columns and rows) and FILM_BLOCKS_BINDING.
//
// A pass that puts film on a cell marks its block. The pass that measures clears the mark of a block without film.
layout(scalar, set = 0, binding = FILM_BLOCKS_BINDING) buffer FilmBlocks
{
    uint film_blocks[]; // a flag per block (1: there may be film), then the list of the flagged blocks, in any order
};

uvec2 film_block_counts()
{
    return (uvec2(PANE.columns, PANE.rows) + VIRGA_GLASS_FILM_BLOCK - 1u) / VIRGA_GLASS_FILM_BLOCK;
}
