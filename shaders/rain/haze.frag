// haze.frag - the rain that is too small or too far to be drops: extinction 0.312 R^0.67 per km, and the light it
// scatters, which comes from nearly straight ahead (Henyey-Greenstein with g = 0.97: moments g and g^2).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "tick.glsl"
#include "view.glsl"
#include "gpu/scene_depth.glsl"

layout(location = 0) out vec4 radiance;

void main()
{
    const float stored = buffer_depth(gl_FragCoord.xy);
    const vec3 ray = pixel_ray(gl_FragCoord.xy);
    // The sky is an environment seen through its own rain already.
    const float way = stored == view.far_depth ? 0.0 : view_depth(stored) * length(ray);
    float thick = 0.0, from = 0.0, to = look.haze_inner_m;
    for (uint box = 0u; box < tick.levels && way > from; box++, from = to, to *= 2.0)
        thick += look.haze_per_m[box] * (min(way, to) - from);
    thick += look.haze_per_m[tick.levels] * max(way - from, 0.0);
    const float alpha = 1.0 - exp(-thick);
    if (alpha <= 0.0)
        discard;
    radiance = vec4(environment(normalize(ray), vec2(0.97, 0.94)) * alpha, alpha);
}
