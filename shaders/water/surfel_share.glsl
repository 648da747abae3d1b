// surfel_share.glsl - how much of a droplet's particle is there, in the lowest eight bits of the radius of its surfels:
// see shared/surfel.h. The radius is off by 1/32,768 of itself at most.
float radius_with_share(float radius, float share)
{
    return uintBitsToFloat((floatBitsToUint(radius) & ~0xffu) | uint(255.0 * (1.0 - clamp(share, 0.0, 1.0)) + 0.5));
}

float share_of_surfel(uint radius_bits) { return 1.0 - float(radius_bits & 0xffu) / 255.0; }
