// drop.frag - a drop as a texture: a blend of the four around it. Premultiplied.
// One invocation per pixel of a drop's quad. Reads: textures, the scene's depth. Writes: radiance, motion, reactive.
// Paper: Sato, Dobashi and Yamamoto 2002, section 3.4.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#if defined(MOTION) || defined(REACTIVE)
#include "gpu/light.glsl"
#include "drop_inputs.glsl"
#include "plate.glsl"
#include "path.glsl"
#include "drop_path.glsl"
#include "temporal.glsl"
#include "drop_quad.glsl"
#else
#include "water.glsl"
#endif
#include "drop_cover.glsl"
#include "gpu/encode.glsl"

layout(set = 0, binding = 30) uniform sampler2D textures;

layout(location = 0) out vec4 radiance;

layout(location = 4) flat in vec4 shifts[2]; // as in drop.vert

#define RIM_SHARE 0.25 // of a radius, over which a texture fades out towards its rim
#define BEYOND    1e-3 // what remains of it beyond, where no texture has the pixel

// The four textures around the drop, in one level: those that show what is seen here.
vec3 blended(float level)
{
    const vec2 one = 1.0 / vec2(textureSize(textures, 0));
    const float texels = amount.w * exp2(-level);
    const vec2 first = tile.xy + vec2(2.0 * (amount.w - texels), 0.0);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < 4u; i++) {
        const vec2 step = vec2(float(i & 1u), float(i >> 1u));
        const vec2 shift = (i & 1u) == 0u ? shifts[i >> 1u].xy : shifts[i >> 1u].zw, there = local + shift;
        const vec2 at = first + vec2(2.0, 1.0) * amount.w * step +
                        clamp((0.5 * there + 0.5) * texels, vec2(0.5), vec2(texels - 0.5));
        const vec2 weight = mix(1.0 - tile.zw, tile.zw, step);
        const float has = clamp((1.0 - length(there)) / RIM_SHARE, BEYOND, 1.0);
        sum += weight.x * weight.y * has * vec4(textureLod(textures, at * one, 0.0).rgb, 1.0);
    }
    return sum.rgb / max(sum.a, 1e-30);
}

// A loop, because software Vulkan leaves one as soon as no lane needs it, but runs both sides of a branch. Its
// condition is at its end: at the beginning it would cost one more body.
vec3 light_of_drop()
{
    const float low = floor(amount.y), share = amount.y - low;
    vec3 sum = vec3(0.0);
    float level = low;
    do {
        sum += blended(level) * (level == low ? 1.0 - share : share);
        level += 1.0;
    } while (level < amount.y + 1.0 && level < low + 2.0);
    return sum;
}

void main()
{
    const float cover = drop_cover();
#ifdef TEMPORAL
    const vec2 in_drop = is_point() ? vec2(0.0) : local * min(1.0, 1.0 / max(length(local), 1e-6));
    stand_on(vec2(quad_float(quad, 12u), quad_float(quad, 13u)) + in_drop * quad_float(quad, 14u));
    const vec3 d = normalize(position);
    const Path path = path_through_drop(in_drop, d, fwidth(in_drop.x));
    const mat2 change = mat2(dFdx(path.pixel), dFdy(path.pixel)); // before the discard: needs all pixels of a quad
#endif
    if (cover <= 0.0 || is_behind_scene())
        discard;
    radiance = for_target(vec4(light_of_drop(), 1.0) * cover);
#ifdef TEMPORAL
    const Water water = Water(cover, 0.0, 0.0, 1.0, vec2(0.0), 0.0);
    write_temporal(shows_scene(path, water) ? motion_in_water(change, scene_before(path.pixel), shown_before(path, d))
                                            : vec2(0.0),
                   cover);
#endif
}
