// haze.frag - haze: the rain that is too small or too far away to be drawn as drops. Its extinction is 0.312 R^0.67 per
// km, and it scatters light from nearly straight ahead (Henyey-Greenstein with g = 0.97: moments g and g^2).
// One invocation per pixel. Reads: the scene's depth. Writes: radiance and opacity.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define SH_FETCHED
#include "rain/tick.glsl"
#include "view.glsl"
#include "gpu/scene_depth.glsl"
#include "haze.glsl"
#include "gpu/encode.glsl"

layout(location = 0) noperspective in vec3 ray; // see haze.vert
layout(location = 1) flat in vec4 depth_and_reach;
layout(location = 2) flat in vec4 per_m[HAZE_VECTORS];
layout(location = 6) flat in vec4 sky[SKY_VECTORS];
layout(location = 13) noperspective in float inverse_begin_depth;
layout(location = 0) out vec4 radiance;

float sky_word(uint word) { return sky[word / 4u][word % 4u]; }

vec3 sh_coefficient(uint i) { return vec3(sky_word(3u * i), sky_word(3u * i + 1u), sky_word(3u * i + 2u)); }

float haze_extinction(uint box) { return per_m[box / 4u][box % 4u]; }

void main()
{
    const float stored = buffer_depth(gl_FragCoord.xy);
    const float depth = depth_and_reach.y / (depth_and_reach.x + stored) - 1.0 / max(inverse_begin_depth, 1e-9);
    const float path_m = stored == depth_and_reach.z ? sky[SKY_VECTORS - 1u].w : max(depth, 0.0) * length(ray);
    const float alpha = 1.0 - exp(-haze_thickness(path_m, depth_and_reach.w));
    if (alpha <= 0.0 || inverse_begin_depth <= 0.0)
        discard;
    radiance = for_target(vec4(environment(normalize(ray), vec2(0.97, 0.94)) * alpha, alpha));
}
