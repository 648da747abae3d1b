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
#define CONE_STEPS 14     // steps of the integral over a cone
#define RANGE_STEPS 8     // and over a range alone
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

// The share of a lamp's light that its range leaves, integrated over the angle, but for a constant. At the angle x it
// has travelled h / sin x, and a range r leaves (1 - (q / sin x)^4)^2 of it, with q = h / r:
//
//     int 1 - 2 q^4 / sin^4 x + q^8 / sin^8 x dx
//         = x + 2 q^4 (c + c^3 / 3) - q^8 (c + c^3 + 3 c^5 / 5 + c^7 / 7)   with   c = cot x,
//
// since d cot x = -dx / sin^2 x and 1 / sin^2 x = 1 + c^2. It is written with t = q c, which is 1 or less in the range.
float range_integral(float angle, vec2 cos_sin, float q)
{
    const float t = q * cos_sin.x / max(cos_sin.y, 1e-6), t2 = t * t, q2 = q * q, q3 = q2 * q;
    return angle + t * (q3 * (2.0 - q3 * q) + t2 * (q * (0.6666667 - q2 * q2) - t2 * (0.6 * q3 + t2 * (q / 7.0))));
}

// What a spot's cone leaves at a cosine to its axis.
float cone_share(float cosine)
{
    const float cone = clamp((cosine - spot.w) * depth_terms.w, 0.0, 1.0);
    return spot.w >= -1.0 ? cone * cone : 1.0;
}

vec2 cos_sin_of(float angle) { return vec2(cos(angle), sin(angle)); }

// F over the angles from a to b, as far as the lamp sends light there: within the cone of a spot, up to the end of its
// range. Light that is scattered by an angle x leaves the lamp along -d cos x + n sin x, with n from the lamp to the
// closest point of the ray. So its cosine with the spot's axis is A cos(x - p), or u cos x + v sin x. The steps grow
// with the angle, since most light is scattered by small angles. In each the range's share is its mean, which is known,
// and the cone's is Simpson's, so cones take more steps; a step's middle is that of its ends on the unit circle.
// Without either one step is exact. Software Vulkan runs what stands under a condition for all pixels, but goes on in a
// loop only while one is in it.
float integrate_lit(Closest closest, vec3 direction, float from, float to)
{
    const vec2 axis = vec2(-dot(direction, spot.xyz), dot(closest.aside, spot.xyz) / closest.nearest);
    float middle = atan(axis.y, axis.x + 1e-9);
    middle += middle < -0.5 * PI ? 2.0 * PI : 0.0;
    const float half_cone = spot.w >= 0.0 ? acos(min(spot.w / max(length(axis), 1e-6), 1.0)) : 2.0 * PI;
    const float q = min(closest.nearest * strength.w, 1.0), min_angle = asin(q);
    const float low = max(max(from, min_angle), middle - half_cone),
                high = min(min(to, PI - min_angle), middle + half_cone);
    const bool has_cone = spot.w >= -1.0;
    const int steps = has_cone ? CONE_STEPS : strength.w > 0.0 ? RANGE_STEPS : 1;
    vec2 begin_at = cos_sin_of(low);
    float sum = 0.0, begin = low, before = scattered_below(low), range_before = range_integral(low, begin_at, q);
    float cone_before = cone_share(dot(axis, begin_at));
    int i = 1;
    do {
        const float share = float(i) / float(steps), end = mix(low, high, share * sqrt(share));
        const vec2 end_at = cos_sin_of(end), both = begin_at + end_at;
        const float after = scattered_below(end), range_after = range_integral(end, end_at, q);
        const float cone_after = cone_share(dot(axis, end_at));
        const float between = cone_share(dot(axis, both) * inversesqrt(max(dot(both, both), 1e-12)));
        const float range_share = clamp((range_after - range_before) / max(end - begin, 1e-6), 0.0, 1.0);
        sum += (after - before) * range_share * (cone_before + 4.0 * between + cone_after) / 6.0;
        begin = end;
        begin_at = end_at;
        before = after;
        range_before = range_after;
        cone_before = cone_after;
    } while (++i <= steps);
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
    // Not negative: where the ray ends near the camera both are nearly one, and the arc tangent of GPUs is imprecise.
    const float scattered = max(integrate_lit(closest, direction, from, to), 0.0);
    radiance = for_target(vec4(strength.rgb * (scattered * fade * fade * lamp_visibility() / closest.nearest), 0.0));
}
