// film_blocks.glsl - which blocks of cells have film on any of them: most passes over film have few to look at. The
// includer has a pane's columns and rows in PANE.
//
// Whoever puts film on a cell marks its block; the pass that measures takes the mark away where it finds none.
layout(scalar, set = 0, binding = FILM_BLOCKS_BINDING) buffer FilmBlocks
{
    uint film_blocks[]; // 1: there may be film; behind all of these the list of those, in any order
};

uvec2 film_block_counts()
{
    return (uvec2(PANE.columns, PANE.rows) + VIRGA_GLASS_FILM_BLOCK - 1u) / VIRGA_GLASS_FILM_BLOCK;
}
