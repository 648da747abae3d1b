// crown.frag - a thin sheet of water, premultiplied: it reflects by Fresnel, hides little of what is behind it, and
// bends that where it is thick or seen from its edge: at the rim and at its sides.
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
#include "gpu/temporal.glsl"
#ifdef MOTION
layout(location = 3) in vec3 before; // in the previous frame's clip coordinates: x, y, w
#endif

layout(constant_id = 0) const bool HAS_DEPTH = true;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 sheet;
layout(location = 0) out vec4 radiance;

void main()
{
    const vec3 d = normalize(position);
    vec3 n = normalize(normal);
    n = dot(n, d) > 0.0 ? -n : n;
    const float cosine = -dot(n, d), mirror = fresnel(cosine);
    // Two parallel faces do not bend what is behind them, so the wall of a crown is nearly clear; its rim is a bead,
    // and at its sides the eye looks along the wall.
    const float rim = smoothstep(0.7, 1.0, sheet.x), edge = (1.0 - cosine) * (1.0 - cosine) * (1.0 - cosine);
    const float thick = clamp(0.04 + 0.6 * rim + 0.8 * edge, 0.0, 1.0);
    const vec3 side = n + d * cosine; // across the line of sight
    const vec3 behind = through_ball(d, side * (0.35 + 0.6 * rim));
    const vec3 glitter = lamps(position, d) * thick;
    const float body = mirror + (1.0 - mirror) * thick;
    const vec3 light = mirror * environment(reflect(d, n), vec2(1.0)) + (1.0 - mirror) * thick * behind + glitter;
    const float there = clamp(sheet.y * sheet.z, 0.0, 1.0) * (HAS_DEPTH ? soft_edge(sheet.w) : 1.0);
    radiance = vec4(light * there, body * there);
    WRITE_MOTION(motion_from(before), body * there);
    WRITE_REACTIVE(body * there, view.reactive_gain);
}
