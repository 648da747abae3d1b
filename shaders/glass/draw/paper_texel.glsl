// paper_texel.glsl - a texel of the map for the paper's style, in one word: a density with 15 bits of mantissa, mist in
// the low byte, and the sign bit set where there is no glass. On software Vulkan the cost of stores is by the word.
uint pack_paper_texel(float density, float mist, bool glass)
{
    return (floatBitsToUint(density) & 0x7fffff00u) | uint(mist * 255.0 + 0.5) | (glass ? 0u : 0x80000000u);
}

// Also valid where there is no glass, for slopes beside it.
float density_of(uint word) { return uintBitsToFloat(word & 0x7fffff00u); }
