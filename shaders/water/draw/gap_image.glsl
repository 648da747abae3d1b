// gap_image.glsl - writes the picture of what the nearest water leaves open, see gaps.glsl.
layout(set = 0, binding = 28, r32ui) uniform writeonly uimage2D gaps;

#define ENOUGH 0.65 // from this sum of weights on a pixel is covered, see coverage_of
#define LEAST  1e-4 // a sum of weights below is none
#define FILL   4.0  // weight of water behind an open pixel: more than 1, so that little is left of what is in front

void write_gap(ivec2 texel, float fill, float closed)
{
    imageStore(gaps, texel, uvec4(packHalf2x16(vec2(fill, min(closed, FILL)))));
}
