// streak_thin.frag - a thin streak's coverage and light at a pixel, premultiplied. Nearly all of rain's pixels are
// these, so there is nothing here that most of them do without: what is wide has a shader of its own.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "tick.glsl"
#include "view.glsl"
#include "streak_pixel.glsl"
#include "gpu/streak_profile.glsl"

layout(constant_id = 0) const bool HAS_DEPTH = true;

layout(location = 0) noperspective in vec4 place;
layout(location = 1) flat in vec4 light_alpha;
layout(location = 2) flat in vec3 shape;
layout(location = 5) flat in vec4 depth_terms; // with HAS_DEPTH, see soft_edge
layout(location = 0) out vec4 radiance;

void main()
{
    float alpha = light_alpha.a * streak_profile(abs(place.x), shape.x) * streak_length(place.y, shape.y);
    if (HAS_DEPTH)
        alpha *= soft_edge(place.w, depth_terms);
    radiance = vec4(light_alpha.rgb * streak_wave(place.z, shape.z) * alpha, alpha);
    WRITE_MOTION(motion, alpha);
    WRITE_REACTIVE(alpha, view.reactive_gain);
}
