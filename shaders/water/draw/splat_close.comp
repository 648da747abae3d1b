// splat_close.comp - how much of each pixel the nearest water leaves open, second pass: where its own sum of weights is
// small, neighbours may close it.
// One workgroup per listed block, one invocation per pixel. Reads: sums, the list of blocks, the
// grid's state. Writes: gaps, open blocks.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#define SCALED false
#include "surface.glsl"
#include "gap_blocks.glsl"
#include "mark_block.glsl"
#include "gap_image.glsl"
#include "shared/particle_grid.h"
layout(scalar, set = 0, binding = 9) readonly buffer Grid { virga_particle_grid_gpu grid; };

layout(local_size_x = VIRGA_WATER_BLOCK_PX, local_size_y = VIRGA_WATER_BLOCK_PX) in;

#define FAR       1.75 // radii of surfels
#define FAR_STEPS 5

// Of all of the water, of which a part may not be there.
float weight_at(ivec2 texel)
{
    const ivec2 size = ivec2(look.width, look.height);
    const vec4 sums = texel_of(sums_image, texel, size);
    return sums.w + (grid.fading_groups[0] > 0u ? missing_of(sums, texel_of(motion_image, texel, size)) : 0.0);
}

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
    const uint block = open_words[listed_word(gl_WorkGroupID.x)];
    const ivec2 here = ivec2(block & 0xffffu, block >> 16) * VIRGA_WATER_BLOCK_PX + ivec2(gl_LocalInvocationID.xy);
    const ivec2 last = ivec2(look.width, look.height) - 1;
    const vec4 sums = texelFetch(sums_image, min(here, last), 0);
    const float weight = weight_at(here), there = sums.w / max(weight, 1e-12);
    if (any(greaterThan(here, last)) || weight <= LEAST || weight >= ENOUGH)
        return;
    const float depth = sums.z / sums.w, closed = closed_weight(here, weight, surfel_px(depth));
    const float missing = there < WHOLE ? 1.0 - there : 0.0;
    // With the widest border: what water.frag may not draw whole is open.
    const float open = 1.0 - coverage_of(closed, MAX_SLOPE, depth);
    if (open <= 0.0) {
        write_gap(here, missing, closed, weight, there);
        return;
    }
    // Where neighbours alone close the rest of a pixel, water behind it has to make all of it whole.
    write_gap(here, max(FILL * open + 2.0 * max(ENOUGH - weight, 0.0), missing), closed, weight, there);
    mark_block(first_open_texel(), here);
}
