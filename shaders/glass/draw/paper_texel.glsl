// paper_texel.glsl - a texel of the map that the paper's style draws from, in one word: a density, of which fifteen
// bits of the mantissa are left, in the last byte the share that mist covers, and in the sign whether there is no
// glass. What stores cost software Vulkan goes by words.
uint word_of(float density, float mist, bool glass)
{
    return (floatBitsToUint(density) & 0x7fffff00u) | uint(mist * 255.0 + 0.5) | (glass ? 0u : 0x80000000u);
}

// Also where there is no glass, for slopes beside it.
float density_of(uint word) { return uintBitsToFloat(word & 0x7fffff00u); }
