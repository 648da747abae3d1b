// streak.frag - a streak's coverage and light at a pixel, premultiplied.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "field.glsl"
#include "view.glsl"
#include "scene_depth.glsl"

layout(location = 0) in vec4 across_along;
layout(location = 1) in float depth;
layout(location = 2) flat in vec4 centre_alpha;
layout(location = 3) flat in vec4 rim_body;
layout(location = 4) flat in vec3 wave;
layout(location = 0) out vec4 radiance;

#define WIDE_PX 3.0 // from here on a drop shows its inside

// What a drop shows at (u, v) of its disc: the ray is bent by 2 (i - t), sin i = r, towards the other side, so the
// world stands on its head in it; at the rim, Schlick's Fresnel reflects what is beside.
vec3 through_drop(vec2 uv, vec3 d)
{
    const float r = min(length(uv), 0.999);
    const float bend = 2.0 * (asin(r) - asin(r / 1.333));
    const vec3 side = normalize(to_vec(view.right)) * uv.x + normalize(to_vec(view.up)) * uv.y;
    const vec3 out_of = r > 1e-3 ? side / r : vec3(0.0);
    const float fresnel = 0.0204 + 0.9796 * pow(1.0 - sqrt(1.0 - r * r), 5.0);
    const float reflected = 3.14159265 - 2.0 * asin(r);
    const vec3 refraction = environment(d * cos(bend) - out_of * sin(bend), vec2(1.0));
    const vec3 reflection = environment(d * cos(reflected) + out_of * sin(reflected), vec2(1.0));
    return mix(refraction, reflection, fresnel);
}

// The same averaged over the part of the drop that passes a pixel of a streak.
vec3 wide_light(float u, float along, vec2 direction, vec3 d)
{
    const vec2 side = vec2(-direction.y, direction.x);
    const float chord = sqrt(max(1.0 - u * u, 0.0));
    vec3 sum = vec3(0.0);
    for (int i = -1; i <= 1; i++) {
        const float v = across_along.w > rim_body.w ? 0.7 * float(i) * chord : along;
        const vec2 screen = side * u + direction * v;
        sum += through_drop(vec2(screen.x, -screen.y), d); // screen y is down
    }
    return sum / 3.0;
}

// 0 behind the scene, whether or not its depth is attached too, and rising over soft_m in front of it.
float soft_edge()
{
    if (view.depth_given == 0u)
        return 1.0;
    const float stored = buffer_depth(gl_FragCoord.xy);
    const float in_front = stored == view.far_depth ? 1e9 : view_depth(stored) - depth;
    return view.soft_m > 0.0 ? clamp(in_front / view.soft_m, 0.0, 1.0) : float(in_front >= 0.0);
}

void main()
{
    const float half_width = across_along.z, way = across_along.w;
    const float from_middle = abs(across_along.x);
    const float u = min(from_middle / half_width, 1.0);
    // A box filter of a pixel on the edge; the profile of a disc's chords where it is wide enough to show. Narrow
    // streaks get its mean, pi / 4, so coverage does not depend on the resolution.
    const float edge = clamp(half_width + 0.5 - from_middle, 0.0, 1.0);
    const float wide = clamp(half_width - 0.75, 0.0, 1.0);
    const float profile = mix(0.785398, sqrt(max(1.0 - u * u, 0.0)), wide);
    const float ramp = max(rim_body.w, 1.0);
    const float ends = clamp((across_along.y + 0.5 * ramp) / ramp, 0.0, 1.0) *
                       clamp((way + 0.5 * ramp - across_along.y) / ramp, 0.0, 1.0);
    const float alpha = centre_alpha.a * edge * profile * ends * soft_edge();
    if (alpha <= 0.0)
        discard;

    vec3 light = mix(centre_alpha.rgb, rim_body.rgb, wide * u * u + (1.0 - wide) * 0.5);
    if (half_width > 0.5 * WIDE_PX) {
        const vec2 ndc = (gl_FragCoord.xy - vec2(view.viewport[0], view.viewport[1])) /
                             vec2(view.viewport[2], view.viewport[3]) * 2.0 - 1.0;
        const vec3 d = normalize(to_vec(view.right) * ndc.x + to_vec(view.up) * ndc.y + to_vec(view.ahead));
        const vec2 across = vec2(dFdx(across_along.x), dFdy(across_along.x));
        const vec2 direction = normalize(vec2(across.y, -across.x) + vec2(0.0, 1e-6));
        const float along = rim_body.w > 0.0 ? clamp((across_along.y - 0.5 * way) / (0.5 * rim_body.w), -1.0, 1.0) : 0.0;
        const vec3 lamps = max(centre_alpha.rgb - environment(d, vec2(0.97, 0.90)), vec3(0.0));
        const float show = clamp((half_width - 0.5 * WIDE_PX) / WIDE_PX, 0.0, 1.0);
        light = mix(light, wide_light(across_along.x / half_width, along, direction, d) + lamps, show);
    }
    const float turns = wave.x * clamp(across_along.y / max(way, 1.0), 0.0, 1.0);
    const float visible = clamp(way / max(4.0 * wave.x, 1e-3) - 0.5, 0.0, 1.0); // not finer than 4 px a turn
    light *= 1.0 + wave.z * visible * cos(6.2831853 * turns + wave.y);
    radiance = vec4(light * alpha, alpha);
}
