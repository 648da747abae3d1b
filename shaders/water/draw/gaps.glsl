// gaps.glsl - what splat_gaps.comp has found at each pixel of the effect's images.
layout(set = 0, binding = 29) uniform usampler2D gaps_image;

struct Gap {
    float fill;   // the weight of water behind the nearest one
    float closed; // the sum of weights of the nearest, where that has no gap
};

Gap gap_at(ivec2 texel)
{
    const vec2 both = unpackHalf2x16(texelFetch(gaps_image, texel, 0).r);
    return Gap(both.x, both.y);
}
