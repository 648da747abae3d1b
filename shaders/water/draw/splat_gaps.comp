// splat_gaps.comp - how much of each pixel the nearest water leaves open. The depth pass hides what is behind a splat
// over the whole of it, but at a border of the surface, as at a crest, its weights fall to 0 within the splat.
// One invocation per pixel of the effect's images. Reads: sums. Writes: gaps.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#define SCALED false
#include "surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 28, r32ui) uniform writeonly uimage2D gaps;

#define ENOUGH 0.65   // from this sum of weights on a pixel is covered, see coverage_of
#define FAR 1.75      // radii of surfels
#define FAR_STEPS 5
#define FILL 4.0      // weight of water behind an open pixel: more than 1, so that little is left of what is in front

float weight_at(ivec2 texel) { return texel_of(sums_image, texel, ivec2(look.width, look.height)).w; }

// The less of the sums of weights of two opposite neighbours.
float weight_between(ivec2 texel, ivec2 aside) { return min(weight_at(texel + aside), weight_at(texel - aside)); }

ivec2 direction_of(int i) { return i == 3 ? ivec2(1, -1) : ivec2(i != 1, i != 0); }

// The largest sum of weights on the way to a neighbour, if it is nearly whole. The way ends where there is no water at
// all, as between droplets.
float reached(ivec2 texel, vec2 direction, float far_px)
{
    float most = 0.0, weight = 1.0;
    for (int i = 1; i <= FAR_STEPS && most < 0.75 && weight > 0.01; i++) {
        weight = weight_at(texel + ivec2(round(direction * (far_px * float(i) / float(FAR_STEPS)))));
        most = max(most, weight);
    }
    return most * smoothstep(0.5, 0.75, most);
}

// The sum of weights at a position, or that of two opposite neighbours if it is less than both. Surfels are not spread
// evenly, and where normals differ from one to the next they stand for more or less than their share of the surface:
// where one surface ends before another, a few pixels may get little of both, and along a sharp edge of the water a sum
// may be about 1/2 over more than the radius of a surfel. Neighbours so far apart count if they are nearly whole, and
// if there is some water all the way. Outside the water, at a straight or convex border, there are no such pairs.
float closed_weight(ivec2 texel, float weight, float radius_px)
{
    const float between_far = smoothstep(0.15, 0.35, weight);
    float closed = weight;
    for (int i = 0; i < (radius_px > 8.0 ? 12 : 8) && closed < ENOUGH; i++)
        closed = max(closed, weight_between(texel, (1 + (i >> 2)) * direction_of(i & 3)));
    for (int i = 0; i < 4 && closed < ENOUGH && between_far > 0.0 && radius_px > 3.0; i++) {
        const vec2 direction = normalize(vec2(direction_of(i)));
        const float before = reached(texel, -direction, FAR * radius_px);
        if (before > 0.0)
            closed = max(closed, between_far * min(before, reached(texel, direction, FAR * radius_px)));
    }
    return closed;
}

void main()
{
    const ivec2 here = ivec2(gl_GlobalInvocationID.xy);
    if (here.x >= int(look.width) || here.y >= int(look.height))
        return;
    const vec4 sums = texelFetch(sums_image, here, 0);
    float fill = FILL, closed = sums.w;
    if (sums.w > 1e-4) {
        const float depth = sums.z / sums.w;
        if (closed < ENOUGH)
            closed = closed_weight(here, sums.w, surfel_px(depth));
        // With the widest border: what water.frag may not draw whole is open.
        const float open = 1.0 - coverage_of(closed, MAX_SLOPE, depth);
        // Where neighbours alone close the rest of a pixel, water behind it has to make all of it whole.
        fill = open > 0.0 ? FILL * open + 2.0 * max(ENOUGH - sums.w, 0.0) : 0.0;
    }
    imageStore(gaps, here, uvec4(packHalf2x16(vec2(fill, min(closed, FILL)))));
}
