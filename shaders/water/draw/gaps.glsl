// gaps.glsl - what splat_gaps.comp has found at each pixel of the effect's images.
layout(set = 0, binding = 29) uniform usampler2D gaps_image;

struct Gap {
    float fill;   // the weight of water behind the nearest one
    float closed; // the sum of weights of the nearest, where that has no gap
    float own;    // the part of it that is not closed by neighbours, where a part of the water is not there
    bool fades;   // whether a part of it is not there
};

// See write_gap.
Gap gap_at(ivec2 texel)
{
    const uint word = texelFetch(gaps_image, texel, 0).r;
    const vec2 both = unpackHalf2x16(word);
    const bool fades = (word & 0x80000000u) != 0u;
    return Gap(both.x, abs(both.y), fades ? exp2(-0.2 * float(word & 63u)) : 1.0, fades);
}
