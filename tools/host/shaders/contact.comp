#version 460
// contact.comp - for each texel of the ground, the share of the sky that near things leave it, and between which
// heights there is something above it.
//
// In each of some directions, things at some distances hide the elevations from their underside to their top. A level
// surface gets sin^2 e of its light from below an elevation e, so what is hidden between two elevations is the
// difference of that. What a direction's things hide is taken as one piece. Things count up to a height at which the
// voxels of the skylight know them, and less and less towards the last distance.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"
#include "contact_maps.glsl"

layout(local_size_x = CONTACT_TILE, local_size_y = CONTACT_TILE) in;

layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D shade;
layout(set = 0, binding = 9) uniform sampler2D near_map; // see contact_near.comp

const int DIRECTIONS = 12, STEPS = 6;
const float AT_M[STEPS] = float[](0.02, 0.06, 0.15, 0.35, 0.75, CONTACT_REACH_M);
const float END_M[STEPS + 1] = float[](0.01, 0.04, 0.1, 0.25, 0.55, 1.1, 1.7); // what is at one reaches so far
const float WEIGHT[STEPS] = float[](1.0, 1.0, 1.0, 1.0, 0.7, 0.3);
const float TALL_M = 1.3;
const float STANDS_M = 0.02; // what does not rise that far above the ground is under it

float below(float rise, float away) { return rise * rise / (rise * rise + away * away); } // sin^2 of the elevation

void main()
{
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy + uvec2(push.first_x, push.first_y));
    const ivec2 last = imageSize(shade) - 1;
    const float ground = texelFetch(ground_map, texel, 0).r * push.height_m;
    float hidden = 0.0;
    // Where nothing within reach stands on the ground, no direction is looked into.
    const bool any = texelFetch(near_map, texel / CONTACT_TILE, 0).r - ground >= STANDS_M;
    for (int d = 0; d < (any ? DIRECTIONS : 0); d++) {
        const float turn = 6.28318531 * (float(d) + 0.5) / float(DIRECTIONS);
        const vec2 along = vec2(cos(turn), sin(turn)) / push.texel_m;
        float low = 1.0, high = 0.0, most = 0.0;
        for (int i = 0; i < STEPS; i++) {
            const ivec2 at = clamp(texel + ivec2(round(AT_M[i] * along)), ivec2(0), last);
            const float under = under_at(at) - ground;
            if (under >= TALL_M)
                continue;
            const float over = over_at(at) - ground;
            if (over < STANDS_M)
                continue;
            low = min(low, below(max(under, 0.0), END_M[i + 1]));
            high = max(high, below(min(over, TALL_M), END_M[i]));
            most = max(most, WEIGHT[i]);
        }
        hidden += most * max(high - low, 0.0);
    }
    const float under = under_at(texel) - ground, over = over_at(texel) - ground;
    const vec2 here = over < STANDS_M ? vec2(HOST_CONTACT_FAR, -1.0) : min(vec2(under, over), HOST_CONTACT_FAR);
    imageStore(shade, texel, vec4(1.0 - hidden / float(DIRECTIONS), ground, here));
}
