// gap_image.glsl - writes the picture of what the nearest water leaves open, see gaps.glsl.
layout(set = 0, binding = 28, r32ui) uniform writeonly uimage2D gaps;

#define ENOUGH 0.65 // from this sum of weights on a pixel is covered, see coverage_of
#define LEAST  1e-4 // a sum of weights below is none
#define WHOLE  0.99 // more than this share is all
#define FILL   4.0  // weight of water behind an open pixel: more than 1, so that little is left of what is in front

// `there`: the share of the nearest water that is there. Where that is not all, the sign of the second half float says
// so, and the part that the sum of weights itself has of `closed` takes the place of the lowest six bits of the first:
// 2^(-n / 5), as it may be small.
void write_gap(ivec2 texel, float fill, float closed, float weight, float there)
{
    uint both = packHalf2x16(vec2(fill, min(closed, FILL)));
    if (there < WHOLE)
        both = (both & 0x7fffffc0u) | 0x80000000u |
               uint(clamp(0.5 - 5.0 * log2(max(weight, 1e-12) / max(closed, 1e-12)), 0.0, 63.0));
    imageStore(gaps, texel, uvec4(both));
}
