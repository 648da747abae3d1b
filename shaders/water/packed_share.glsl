// packed_share.glsl - a share [0; 1] in the lowest eight bits of a float, which is off by 1/32,768 of itself at most:
// how much of its particle is there, for a surfel (see shared/surfel.h), and how much of the water around it, for a
// sorted particle (see surface/cover.comp).
float with_share(float value, float share)
{
    return uintBitsToFloat((floatBitsToUint(value) & ~0xffu) | uint(255.0 * (1.0 - clamp(share, 0.0, 1.0)) + 0.5));
}

float share_in(uint bits) { return 1.0 - float(bits & 0xffu) / 255.0; }

// Of a sorted particle, after relative.comp: the part of its volume that counts.
float counted_share(float relative) { return relative * share_in(floatBitsToUint(relative)); }
