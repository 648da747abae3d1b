// streak_thin.frag - a thin streak's coverage and light at a pixel, premultiplied. Nearly all of rain's pixels are
// these, so there is nothing here that most of them do without: what is wide has a shader of its own.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "streak_pixel.glsl"
#include "gpu/streak_profile.glsl"

layout(location = 0) noperspective in vec3 place;
layout(location = 1) flat in vec4 light_alpha;
layout(location = 2) flat in vec3 shape;
layout(location = 3) flat in vec3 middle_line; // a line has one place all across
layout(location = 5) flat in vec4 depth_terms; // with HAS_DEPTH, see soft_edge
layout(location = 0) out vec4 radiance;

void main()
{
    const float across = abs(dot(middle_line, vec3(gl_FragCoord.xy, 1.0)));
    float alpha = light_alpha.a * streak_profile(across, shape.x) * streak_length(place.x, shape.y);
    if (HAS_DEPTH)
        alpha *= soft_edge(place.z, depth_terms);
    radiance = vec4(light_alpha.rgb * streak_wave(place.y, shape.z) * alpha, alpha);
    WRITE_MOTION(motion, alpha);
    WRITE_REACTIVE(alpha, view.reactive_gain);
}
