// panorama.comp - a panorama of the surroundings from another one, or from a picture and what is taken for the rest.
// One invocation per texel. Reads: the image. Writes: the panorama.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "environment.glsl"
#include "panorama.glsl"

#define EDGE 0.08 // share of a picture along its borders over which it fades into the rest

vec3 on_panorama(vec3 d, float spread)
{
    const vec3 e = d * world_from_image(); // by the transpose
    const vec2 at = vec2(atan(e.x, -e.z) * (0.5 / PI) + 0.5, acos(clamp(e.y, -1.0, 1.0)) / PI);
    return light_of(textureLod(image, at, max(log2(spread * float(info.width) / (2.0 * PI)), 0.0)).rgb);
}

vec3 on_picture(vec3 d)
{
    const vec4 clip = to_mat(info.clip_from_rel) * vec4(d, 0.0);
    const vec2 at = 0.5 * clip.xy / max(clip.w, 1e-6) + 0.5;
    const vec2 inside = smoothstep(vec2(0.0), vec2(EDGE), min(at, 1.0 - at));
    const float shown = clip.w > 1e-6 ? inside.x * inside.y : 0.0;
    const vec2 pixel = clamp(at, 0.0, 1.0) * vec2(info.width, info.height) + vec2(info.left, info.top);
    const vec3 light = light_of(textureLod(image, pixel / vec2(textureSize(image, 0)), 0.0).rgb);
    return mix(rest(d), light, shown);
}

vec3 around(vec3 d, float spread)
{
    if (info.kind == KIND_PICTURE)
        return on_picture(d);
    return on_panorama(d, spread);
}
