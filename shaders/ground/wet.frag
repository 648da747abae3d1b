// wet.frag - what water makes of the ground that a host has drawn: it darkens, and mirrors the host's picture.
// One invocation per pixel. Reads: the ground's maps, the host's depth and picture. Writes: radiance.
//
// Position and normal come from the depth. Water in pores lets less light out again (Lekner and Dorf 1988, "Why some
// things are darker when wet"); how much less is a setting, as the host's materials are not known here. A film or a
// puddle mirrors by Schlick's form of Fresnel's equations for water.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "wet_view.glsl"
#include "gpu/light.glsl"
#define SCENE_DEPTH_BINDING 5
#include "gpu/scene_depth.glsl"
#include "gpu/host_color.glsl"
#include "gpu/encode.glsl"
#include "shared/ground_map.glsl"

layout(set = 0, binding = 1) uniform sampler2D wet_map;
layout(set = 0, binding = 2) uniform usampler2D spot_map;
layout(set = 0, binding = 3) uniform sampler2D ripple_map;
layout(set = 0, binding = 4) uniform sampler2D far_map;
layout(set = 0, binding = 6) uniform sampler2D scene_color;
layout(location = 0) out vec4 radiance;

vec3 scene_light(vec2 pixel)
{
    return host_color(textureLod(scene_color, pixel / vec2(textureSize(scene_color, 0)), 0.0).rgb, view.color_given);
}

#include "wet_mirror.glsl"

vec3 point_at(vec2 pixel)
{
    const vec2 at = in_viewport(pixel);
    const float stored = buffer_depth(at);
    return pixel_ray(at) * (stored == view.far_depth ? 1e6 : view_depth(stored));
}

// Towards the side on which the depth changes less: the other one may belong to another surface.
vec3 along(vec3 point, vec2 step_px)
{
    const vec3 ahead = point_at(gl_FragCoord.xy + step_px) - point, back = point - point_at(gl_FragCoord.xy - step_px);
    const bool can_ahead = dot(ahead, ahead) > 0.0, can_back = dot(back, back) > 0.0;
    return can_ahead && (!can_back || dot(ahead, ahead) < dot(back, back)) ? ahead : back;
}

vec3 normal_at(vec3 point)
{
    const vec3 n = normalize(cross(along(point, vec2(1.0, 0.0)), along(point, vec2(0.0, 1.0))));
    return dot(n, point) > 0.0 ? -n : n;
}

// The water of the window, of the far map, and beyond.
virga_ground_wetness water_at(vec3 point, float pixel_m)
{
    const vec2 at = (point.xz - vec2(wet.low[0], wet.low[1])) / wet.cell_m;
    const float height_m = point.y - wet.base_m;
    const virga_ground_wetness near =
        virga_ground_at(wet_map, spot_map, ivec2(wet.low_cell[0], wet.low_cell[1]), wet.cells, at, height_m,
                        pixel_m / wet.cell_m, wet.cell_m);
    const float share = virga_ground_near_share(point.xz - vec2(wet.middle[0], wet.middle[1]), wet.reach_m);
    if (share >= 1.0)
        return near;
    const virga_ground_wetness open = virga_ground_open(far_map, wet.far_cells, wet.far_material);
    const vec2 far_at = (point.xz - vec2(wet.far_low[0], wet.far_low[1])) / wet.far_cell_m;
    return virga_ground_mix(virga_ground_far_at(far_map, wet.far_cells, far_at, height_m, open, wet.far_cell_m), near,
                            share);
}

// The slope of the waves, as far as pixels show them. `shown` tells how far.
vec2 ripples_at(vec3 point, float pixel_m, out float shown)
{
    const vec2 at = (point.xz - vec2(wet.ripple_low[0], wet.ripple_low[1])) / wet.ripple_m;
    const vec2 inside = min(at, 1.0 - at);
    shown = smoothstep(0.0, 0.12, min(inside.x, inside.y)) * (1.0 - smoothstep(0.006, 0.03, pixel_m));
    return shown > 0.0 ? textureLod(ripple_map, at, 0.0).xy * shown : vec2(0.0);
}

void main()
{
    const float stored = buffer_depth(gl_FragCoord.xy);
    if (stored == view.far_depth)
        discard;
    const vec3 point = pixel_ray(gl_FragCoord.xy) * view_depth(stored), d = normalize(point);
    const vec3 face = normal_at(point);
    const float level = smoothstep(0.3, 0.6, face.y), pixel_m = view_depth(stored) * view.pixel_angle;
    if (level <= 0.0)
        discard;
    const virga_ground_wetness water = water_at(point, pixel_m / max(-dot(face, d), 0.05));
    const float damp = level * max(0.85 * water.spot, smoothstep(0.15, 0.8, water.wet));
    const float film = level * smoothstep(0.01, 0.25, water.depth_mm);
    const float puddle = level * smoothstep(0.5, 1.6, water.depth_mm);
    if (max(damp, film) <= 0.0)
        discard;
    // Water is level. A normal of depths is too coarse to tell level ground from a slope of a few degrees.
    float shown;
    const vec2 slope = ripples_at(point, pixel_m, shown);
    const vec3 flat_face = normalize(mix(face, vec3(0.0, 1.0, 0.0), max(puddle, smoothstep(0.98, 0.998, face.y))));
    const vec3 n = normalize(flat_face - puddle * vec3(slope.x, 0.0, slope.y));
    vec3 r = reflect(d, n);
    r = dot(r, flat_face) > 0.0 ? r : reflect(r, flat_face);
    const float waves = clamp(sqrt(sqrt(2.0 * water.slope2 * (1.0 - 0.8 * shown))), 0.03, 0.5);
    const float rough = mix(mix(0.45, 0.16, film), waves, puddle), cosine = clamp(-dot(n, d), 0.0, 1.0);
    const float fresnel = 0.0204 + (max(1.0 - rough, 0.0204) - 0.0204) * pow(1.0 - cosine, 5.0);
    const float mirrors = fresnel * max(film, 0.35 * damp);
    // A strength of two is the same as twice as much water one over the other.
    const float dark = 1.0 - pow(1.0 - wet.darkening * damp, wet.strength);
    const float mirror = 1.0 - pow(1.0 - mirrors, wet.strength);
    const vec3 light = mirror * mirrored(point, r, flat_face, rough * rough, cosine);
    radiance = for_target_over(vec4(light, 1.0 - (1.0 - dark) * (1.0 - mirror)), scene_light(gl_FragCoord.xy));
}
