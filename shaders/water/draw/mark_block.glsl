// mark_block.glsl - sets the bit of a block of pixels, and has the list of blocks. The includer includes
// gap_blocks.glsl.
layout(std430, set = 0, binding = 30) buffer OpenBlocks { uint open_words[]; };

// Sets the bit of the block of a pixel, in a picture of bits that begins at a texel. Returns whether it was set.
bool mark_block(uint first_texel, ivec2 pixel)
{
    const ivec2 block = pixel / VIRGA_WATER_BLOCK_PX, size = ivec2(VIRGA_WATER_OPEN_COLUMNS, VIRGA_WATER_OPEN_ROWS),
                texel = block / size, inside = block - texel * size;
    const uint word = 4u * (first_texel + open_texel(texel)) + uint(inside.y >> 1);
    const uint bit = 1u << uint(VIRGA_WATER_OPEN_COLUMNS * (inside.y & 1) + inside.x);
    return (atomicOr(open_words[word], bit) & bit) != 0u;
}

uint listed_word(uint index) { return 8u * first_open_texel() + index; }
