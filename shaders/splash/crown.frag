// crown.frag - a thin sheet of water, premultiplied: it reflects by Fresnel, hides little of what is behind it, and
// bends that where it is thick or seen from its edge: at the rim, which is a bead, and at its sides.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/splash_gpu.h"
#include "shared/view_gpu.h"
#include "gpu/vectors.glsl"
layout(scalar, set = 0, binding = 1) uniform View
{
    virga_view_gpu view;
    virga_splash_look_gpu look;
};
#include "gpu/light.glsl"
#define SCENE_DEPTH_BINDING 16
#include "gpu/scene_depth.glsl"
#include "through.glsl"
#include "crown_rim.glsl"
#include "gpu/temporal.glsl"
#ifdef MOTION
layout(location = 3) in vec3 before; // in the previous frame's clip coordinates: x, y, w
#endif

layout(constant_id = 0) const bool HAS_DEPTH = true;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 sheet;
layout(location = 4) in vec4 rim_at;
layout(location = 5) in vec3 upward;
layout(location = 6) in vec2 size;
layout(location = 0) out vec4 radiance;

// How far a place lies below the rim (m, along the sheet), and the way across the rim out of the sheet there.
struct Rim {
    float below;
    vec3 outward;
};

Rim rim_of(vec3 n)
{
    const vec2 rim = crown_rim(rim_at.x, rim_at.y, rim_at.z);
    const float slope = clamp(rim.y * rim_at.w / size.x, -4.0, 4.0), steep = inversesqrt(1.0 + slope * slope);
    const vec3 u = normalize(upward), around = cross(u, n);
    return Rim((rim.x - CROWN_REACH * sheet.x) * rim_at.w * steep, (u - slope * around) * steep);
}

void main()
{
    const vec3 d = normalize(position);
    vec3 n = normalize(normal);
    const Rim ends = rim_of(n);
    n = dot(n, d) > 0.0 ? -n : n;
    // From 0, where the bead begins, to 1 at the rim. What is no pixel thick is drawn a pixel thick. A disk has none.
    const bool disk = rim_at.w <= 0.0;
    const float bead_m = max(size.y, 1.2 * length(position) * view.pixel_angle);
    const float out_of_bead = disk ? 0.0 : clamp(1.0 - ends.below / bead_m, 0.0, 1.0);
    const float a_pixel = max(fwidth(ends.below), 1e-9), cut = disk ? 1.0 : clamp(ends.below / a_pixel + 0.5, 0.0, 1.0);
    // Its face is as round as a rod's that the sheet runs into.
    const float across = (1.7 * out_of_bead - 0.7) * smoothstep(0.0, 0.3, out_of_bead);
    n = n * sqrt(1.0 - across * across) + ends.outward * across;
    n = normalize(n - 1.01 * d * max(dot(n, d), 0.0));
    const float cosine = -dot(n, d), mirror = fresnel(cosine);
    // Two parallel faces do not bend what is behind them, so the wall of a crown is nearly clear; its rim is a bead,
    // and at its sides the eye looks along the wall.
    const float rim = smoothstep(0.0, 0.4, disk ? 1.333 * sheet.x - 0.933 : out_of_bead);
    const float edge = (1.0 - cosine) * (1.0 - cosine) * (1.0 - cosine);
    const float thick = clamp(0.05 + 0.12 * sheet.x * sheet.x + 0.6 * rim + 0.8 * edge, 0.0, 1.0);
    const vec3 side = n + d * cosine; // across the line of sight
    const vec3 behind = through_ball(d, side * (0.35 + 0.6 * rim));
    const vec3 glitter = lamps(position, d) * thick;
    const float body = mirror + (1.0 - mirror) * thick;
    const vec3 light = mirror * around_of(reflect(d, n)) + (1.0 - mirror) * thick * behind + glitter;
    const float there = cut * clamp(sheet.y * sheet.z, 0.0, 1.0) * (HAS_DEPTH ? soft_edge(sheet.w) : 1.0);
    radiance = vec4(light * there, body * there);
    WRITE_MOTION(motion_from(before), body * there);
    WRITE_REACTIVE(body * there, view.reactive_gain);
}
