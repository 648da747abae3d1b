// haze.frag - haze: the rain that is too small or too far away to be drawn as drops.
//
// A drop that is much wider than a wavelength takes twice the light of its disc out of a ray: what hits it, and as
// much that is diffracted around it (van de Hulst 1957). Atlas's extinction by rain, 0.312 R^0.67 per km, has both. A
// drop of 1 mm diffracts by less than a twentieth of a degree. A picture does not lose this light, and is not blurred
// by it. So haze is half of the extinction: the drops' discs, with which streaks cover the picture too. The glow of
// lamps has the same half.
//
// Drops bend the other half by 40 degrees and more: haze shows what is around, and has the light of the streaks that it
// stands for. See streak_write.comp for the moments.
//
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

#define HAZE_MOMENTS vec2(0.77, 0.54) // first and second Legendre moment of what drops scatter, over all of their disc

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
    radiance = for_target(vec4(environment(normalize(ray), HAZE_MOMENTS) * alpha, alpha));
}
