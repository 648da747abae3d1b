// glow.vert - a rectangle around everything that a lamp's glow reaches on the picture, or the whole viewport.
// One invocation per vertex, one instance per lamp. Reads: the view. Writes: constants of the lamp.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "haze.glsl"

layout(location = 0) noperspective out vec3 ray; // with a view depth of 1 m
layout(location = 1) flat out vec4 lamp;         // xyz: relative to the camera; w: 1 / distance at which the glow ends
layout(location = 2) flat out vec4 strength;     // xyz: k / 2 times the intensity; w: 1 / range, 0: no range
layout(location = 3) flat out vec4 spot;         // xyz: direction; w: cosine of the end of the cone
layout(location = 4) flat out vec4 look_at;      // xy: the lamp on the picture (px); z: a radius (px); w: view depth
// xyz: depth_a, depth_b, far_depth of the view; w: 1 / width of the cone
layout(location = 5) flat out vec4 depth_terms;
layout(location = 6) flat out float pixel_angle;
layout(location = 7) noperspective out float begins; // 1 / view depth at which haze begins

#define MAX_DISTANCE_M 200.0 // max distance from a lamp at which its glow is drawn
#define SEEN_RADIUS_M 0.3    // radius around the lamp within which depth is sampled

float haze_extinction(uint box) { return look.haze_per_m[min(box, tick.levels)]; }

// Distance from the ray to the lamp at which the glow is invisible: below a 300th of the ambient light and a 200th of
// what a white wall at three metres from the lamp shows. From L = k (I / h) F(pi).
float glow_reach(vec3 power, vec3 intensity)
{
    const float max_power = max(max(power.r, power.g), power.b),
                max_intensity = max(max(intensity.r, intensity.g), intensity.b);
    const float ambient = max(max(view.sh[0], view.sh[1]), view.sh[2]) * 0.282095;
    const float min_visible = ambient / 300.0 + view.light_gain * max_intensity / (9.0 * 3.14159) / 200.0;
    return clamp(0.557 * max_power / max(min_visible, 1e-20), 0.02, MAX_DISTANCE_M);
}

// A corner of the rectangle on the picture: it contains all rays that pass the lamp within `reach`. False where it is
// not completely in front of the camera.
bool rectangle_corner(vec3 at, float reach, vec2 corner, out vec2 ndc)
{
    const float distance = length(at), half_m = reach * distance / sqrt(max(distance * distance - reach * reach, 1e-6));
    const vec3 ahead = at / max(distance, 1e-6);
    const vec3 right = normalize(cross(ahead, abs(ahead.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
    const vec3 up = cross(right, ahead);
    const mat4 clip_from_rel = to_mat(view.clip_from_rel);
    vec2 low = vec2(1.0), high = vec2(-1.0);
    bool before = distance > reach;
    for (uint i = 0u; i < 4u; i++) {
        const vec2 side = vec2(i & 1u, i >> 1) * 2.0 - 1.0;
        const vec4 clip = project(clip_from_rel, at + half_m * (side.x * right + side.y * up));
        before = before && clip.w > NEAR_W;
        const vec2 ndc_position = clip.xy / max(clip.w, NEAR_W);
        low = i == 0u ? ndc_position : min(low, ndc_position);
        high = i == 0u ? ndc_position : max(high, ndc_position);
    }
    ndc = mix(clamp(low, -1.0, 1.0), clamp(high, -1.0, 1.0), 0.5 + 0.5 * corner);
    return before;
}

// Where the depth is sampled to find out whether the lamp is hidden: at the lamp, clamped to the viewport.
vec4 depth_test_position(vec3 at)
{
    const vec4 clip = project(to_mat(view.clip_from_rel), at);
    if (clip.w < NEAR_W)
        return vec4(view.viewport[0], view.viewport[1], 0.0, -1.0); // behind the camera nothing hides it
    const vec2 low = vec2(view.viewport[0], view.viewport[1]), size = vec2(view.viewport[2], view.viewport[3]);
    const float radius = min(SEEN_RADIUS_M / (clip.w * view.pixel_angle), 0.25 * min(size.x, size.y));
    const vec2 pixel = low + (0.5 + 0.5 * clip.xy / clip.w) * size;
    return vec4(clamp(pixel, low + radius, low + size - radius - 1.0), radius, clip.w);
}

#include "gpu/own_view.glsl"

void main()
{
    const virga_light_gpu light = view.lights[gl_InstanceIndex];
    const vec3 at = to_vec(light.position);
    const float distance = length(at), inner = look.haze_inner_m;
    const float per_m =
        (haze_thickness(1.25 * distance, inner) - haze_thickness(0.8 * distance, inner)) / max(0.45 * distance, 1e-3);
    const float clear_share = 1.0 / max(inverse_begin(at), 1.0); // part of the way to the lamp without haze
    const float transmittance = exp(-haze_thickness(distance * (1.0 - clear_share), inner));
    const vec3 power = to_vec(light.intensity) * (per_m * transmittance * view.light_gain * look.glow);
    const float reach = glow_reach(power, to_vec(light.intensity));

    const vec2 corner = vec2(gl_VertexIndex == 1 || gl_VertexIndex >= 4 ? 1.0 : -1.0,
                             gl_VertexIndex >= 2 && gl_VertexIndex != 4 ? 1.0 : -1.0);
    vec2 ndc;
    if (!rectangle_corner(at, reach, corner, ndc))
        ndc = distance < reach || dot(at, to_vec(view.ahead)) > -reach ? corner : vec2(-1.0);
    gl_Position = vec4(ndc, 0.0, 1.0);
    ray = to_vec(view.right) * ndc.x + to_vec(view.up) * ndc.y + to_vec(view.ahead);
    begins = inverse_begin(ray);
    lamp = vec4(at, 1.0 / reach);
    strength = vec4(power, light.inv_range);
    spot = vec4(to_vec(light.direction), light.cos_outer);
    look_at = depth_test_position(at);
    depth_terms = vec4(view.depth_a, view.depth_b, view.far_depth, light.inv_cos_width);
    pixel_angle = view.pixel_angle;
}
