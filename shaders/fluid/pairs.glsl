// pairs.glsl - the neighbours of a particle and the gradients of the kernel at them, as neighbours.comp stores them.
//
// The iterations of the solver need of a pair its gradient g_ij = 4 pi V grad W and the neighbour's index, not where it
// is. Both take 64 bits: the index 22, and each component 14, as a multiple of 1 / GRADIENT_ONE. No component is above
// 4 (at q = 2/3). The rounding is half a step, 0.00024, where the gradients are about 1; it is the same for both
// particles of a pair but for the sign, so that what one gets the other loses.
//
// The first words of four pairs are a texel of `lists`, the second words one of `gradients`:
//
//     22 bits index, 10 bits z / 16            14 bits x, 14 bits y, 4 bits z
#define GRADIENT_ONE 2047.0

// A pair of words, of a gradient that is not rounded yet.
uvec2 pair_words(uint j, vec3 gradient)
{
    const ivec3 n = ivec3(roundEven(GRADIENT_ONE * gradient));
    return uvec2(j | uint(n.z >> 4) << 22, (uint(n.x) & 0x3fffu) | (uint(n.y) & 0x3fffu) << 14 | uint(n.z) << 28);
}

uint pair_index(uint first) { return first & 0x3fffffu; }

// The gradient, times GRADIENT_ONE.
vec3 pair_gradient(uint first, uint second)
{
    return vec3(int(second << 18) >> 18, int(second << 4) >> 18, (int(first) >> 22) << 4 | int(second >> 28));
}

// In the second word of `solved`: how many texels the lists of a particle have, and the walls' part of its own
// pressure, as a half: it is for the host alone.
float solved_word(uint texels, float wall_pull)
{
    return uintBitsToFloat(packHalf2x16(vec2(wall_pull, 0.0)) | texels << 16);
}
uint solved_texels(float word) { return floatBitsToUint(word) >> 16; }
float solved_wall_pull(float word) { return unpackHalf2x16(floatBitsToUint(word)).x; }
