// glow.frag - a lamp's glow along one ray, see glow.glsl.
// One invocation per pixel around a lamp. Reads: the scene's depth. Writes: radiance (additive).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "gpu/scene_depth.glsl"
#include "glow.glsl"
#include "gpu/encode.glsl"

layout(location = 0) noperspective in vec3 ray; // inputs: see glow.vert
layout(location = 1) flat in vec4 lamp;
layout(location = 2) flat in vec4 strength;
layout(location = 3) flat in vec4 spot;
layout(location = 4) flat in vec4 look_at;
layout(location = 5) flat in vec4 depth_terms;
layout(location = 6) flat in float pixel_angle;
layout(location = 7) noperspective in float begins;
layout(location = 0) out vec4 radiance;

#define PI 3.14159265
#define DEPTH_SAMPLES 6
#define STEPS 16          // steps of the integral over a cone or a range
#define HIDDEN_FROM_M 0.3 // what is nearer than the lamp by this begins to hide it: its own lantern does not
#define HIDDEN_M 0.9

float stored_view_depth(float stored)
{
    return stored == depth_terms.z ? 1e6 : depth_terms.y / (depth_terms.x + stored);
}

// The visible part of the lamp. A lamp behind a wall does not light the haze in front of the wall.
float lamp_visibility()
{
    float seen = 0.0;
    for (int i = 0; i < DEPTH_SAMPLES; i++) {
        const float angle = 2.0 * PI / float(DEPTH_SAMPLES - 1) * float(i);
        const vec2 pixel = look_at.xy + (i > 0 ? look_at.z * vec2(cos(angle), sin(angle)) : vec2(0.0));
        const float nearer = look_at.w - stored_view_depth(buffer_depth(pixel));
        seen += 1.0 - smoothstep(HIDDEN_FROM_M, HIDDEN_M, nearer);
    }
    return seen / float(DEPTH_SAMPLES);
}

// F over the angles from a to b, as far as the lamp sends light there: within the cone of a spot, up to the end of its
// range. Light that is scattered by an angle x leaves the lamp along -d cos x + n sin x, with n from the lamp to the
// closest point of the ray. So its cosine with the spot's axis is A cos(x - p), and it has travelled h / sin x. The
// steps grow with the angle, since most light is scattered by small angles.
float integrate_lit(Closest closest, vec3 direction, float from, float to)
{
    const float u = -dot(direction, spot.xyz), v = dot(closest.aside, spot.xyz) / closest.nearest;
    const float amplitude = sqrt(u * u + v * v);
    float middle = atan(v, u + 1e-9);
    middle += middle < -0.5 * PI ? 2.0 * PI : 0.0;
    const float half_cone = spot.w >= 0.0 ? acos(min(spot.w / max(amplitude, 1e-6), 1.0)) : 2.0 * PI;
    const float min_angle = asin(min(closest.nearest * strength.w, 1.0));
    const float low = max(max(from, min_angle), middle - half_cone),
                high = min(min(to, PI - min_angle), middle + half_cone);
    float sum = 0.0, begin = low, before = scattered_below(low);
    for (int i = 1; i <= STEPS; i++) {
        const float share = float(i) / float(STEPS), end = mix(low, high, share * sqrt(share)),
                    after = scattered_below(end);
        const float angle = 0.5 * (begin + end), x = closest.nearest * strength.w / max(sin(angle), 1e-6);
        const float cone = clamp((amplitude * cos(angle - middle) - spot.w) * depth_terms.w, 0.0, 1.0);
        const float range_fade = clamp(1.0 - x * x * x * x, 0.0, 1.0);
        sum += (after - before) * cone * cone * range_fade * range_fade;
        begin = end;
        before = after;
    }
    return high > low ? sum : 0.0;
}

void main()
{
    const vec3 direction = normalize(ray);
    const Closest closest = closest_to_lamp(lamp.xyz, direction, pixel_angle);
    const float relative_distance = closest.nearest * lamp.w, x2 = relative_distance * relative_distance,
                fade = clamp(1.0 - x2 * x2, 0.0, 1.0);
    if (fade <= 0.0)
        discard;
    const float start = length(ray) / max(begins, 1e-9);
    const float range_fade = max(stored_view_depth(buffer_depth(gl_FragCoord.xy)) * length(ray), start);
    const float from = atan(closest.nearest, closest.along - start),
                to = atan(closest.nearest, closest.along - range_fade);
    const bool all_around = spot.w < -1.0 && strength.w == 0.0;
    // Not negative: where the ray ends near the camera both are nearly one, and the arc tangent of GPUs is imprecise.
    const float scattered = all_around ? max(scattered_below(to) - scattered_below(from), 0.0)
                                       : integrate_lit(closest, direction, from, to);
    radiance = for_target(vec4(strength.rgb * (scattered * fade * fade * lamp_visibility() / closest.nearest), 0.0));
}
