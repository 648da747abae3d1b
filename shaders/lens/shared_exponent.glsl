// shared_exponent.glsl - a color as VK_FORMAT_E5B9G9R9_UFLOAT_PACK32: nine bits for each channel, which have one
// exponent. From the Vulkan specification, "Conversion to RGB with shared exponent": a channel is
//
//     m 2^(e - 15 - 9), m below 2^9, e below 2^5
//
// The largest channel shall have its highest bit, so e - 15 is one more than its binary exponent. Half of its last bit
// is added before: where it would be rounded up to 2^9, its exponent is one more. Each channel is rounded to the
// nearest, so that no light is lost or added on average; the largest one is at most 1 / 512 of itself away. There are
// no colors below 0.
uint shared_exponent(vec3 color)
{
    const vec3 stored = clamp(color, 0.0, 65408.0); // 511 / 512 of 2^16
    const float most = max(max(stored.r, stored.g), stored.b);
    // A float's exponent is 127 more, and has 23 bits below it. The smallest one here is 2^-16.
    const uint exponent = max((floatBitsToUint(most) + (1u << 14)) >> 23, 111u) - 111u;
    const uvec3 bits = uvec3(stored * uintBitsToFloat((151u - exponent) << 23) + 0.5); // 2^(24 - e)
    return bits.r | bits.g << 9 | bits.b << 18 | exponent << 27;
}
