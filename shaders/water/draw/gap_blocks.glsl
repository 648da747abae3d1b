// gap_blocks.glsl - bits for blocks of VIRGA_WATER_BLOCK_PX x VIRGA_WATER_BLOCK_PX pixels of the effect's images.
//
// There are two pictures of bits, one after the other: first the blocks that splat_close.comp has to look at, then
// those with a pixel that is open. A texel of four words has VIRGA_WATER_OPEN_COLUMNS x VIRGA_WATER_OPEN_ROWS blocks,
// and each word two rows of them. After them comes the list of those for splat_close.comp: row and column in 16 bits
// each.
ivec2 open_size()
{
    const ivec2 texel = VIRGA_WATER_BLOCK_PX * ivec2(VIRGA_WATER_OPEN_COLUMNS, VIRGA_WATER_OPEN_ROWS);
    return (ivec2(look.width, look.height) + texel - 1) / texel;
}

uint first_open_texel() { return uint(open_size().x * open_size().y); }

uint open_texel(ivec2 texel) { return uint(texel.y * open_size().x + texel.x); }
