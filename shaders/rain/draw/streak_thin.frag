// streak_thin.frag - coverage and light of a thin streak at a pixel, premultiplied. Nearly all pixels of rain run this
// shader, so it contains nothing that most of them do not need; wide streaks have their own.
// One invocation per pixel of a thin streak. Reads: the scene's depth. Writes: radiance, motion, reactive.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "streak_pixel.glsl"
#include "gpu/streak_profile.glsl"
#include "gpu/encode.glsl"

layout(location = 0) noperspective in vec3 along_turns_depth;
layout(location = 1) flat in vec4 light_alpha;
layout(location = 2) flat in vec3 shape;
layout(location = 3) flat in vec3 middle_line; // a line's inputs do not vary across it
layout(location = 5) flat in vec4 depth_terms; // with HAS_DEPTH, see soft_edge
layout(location = 0) out vec4 radiance;

void main()
{
    const float across = abs(dot(middle_line, vec3(gl_FragCoord.xy, 1.0)));
    float alpha = light_alpha.a * streak_profile(across, shape.x) * streak_length(along_turns_depth.x, shape.y);
    if (HAS_DEPTH)
        alpha *= soft_edge(1.0 / along_turns_depth.z, depth_terms);
    radiance = for_target(vec4(light_alpha.rgb * streak_wave(along_turns_depth.y, shape.z) * alpha, alpha));
    WRITE_MOTION(motion, alpha);
    WRITE_REACTIVE(alpha, view.reactive_gain);
}
