// crown.frag - a thin sheet of water, premultiplied. It reflects by Fresnel, hides little of the background, and
// refracts where it is thick or seen from the edge: at the rim, which is a bead, and at its sides.
// One invocation per pixel of a sheet. Reads: the scene's picture and depth. Writes: radiance, motion, reactive.
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
#include "gpu/encode.glsl"
#ifdef MOTION
layout(location = 3) in vec3 before; // in the previous frame's clip coordinates: x, y, w
#endif

layout(constant_id = 0) const bool HAS_DEPTH = true;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 sheet;
layout(location = 4) in vec4 rim_data;
layout(location = 5) in vec3 upward;
layout(location = 6) in vec2 size;
layout(location = 0) out vec4 radiance;

// Distance below the rim (m, along the sheet), and the direction across the rim, out of the sheet.
struct Rim {
    float below;
    vec3 outward;
};

Rim rim_of(vec3 n)
{
    const vec2 rim = rim_height(rim_data.x, rim_data.y, rim_data.z);
    const float slope = clamp(rim.y * rim_data.w / size.x, -4.0, 4.0), steep = inversesqrt(1.0 + slope * slope);
    const vec3 u = normalize(upward), around = cross(u, n);
    return Rim((rim.x - CROWN_REACH * sheet.x) * rim_data.w * steep, (u - slope * around) * steep);
}

// The slope of the wall's face where water streams up into the fingers: a ridge below each finger, and finer ones
// between, which merge towards the rim. Waves shorter than pixels are left out.
float ridge_slope()
{
    const float finger = rim_data.x, slow = rim_data.y, up = clamp(sheet.x * CROWN_REACH, 0.0, 1.0);
    const vec3 waves = vec3(finger, 2.0 * finger + slow + 1.3 * sin(slow + 2.0 * up), 3.0 * finger - slow - 1.1 * up);
    const vec3 shown = 1.0 - smoothstep(0.6, 1.8, fwidth(finger) * vec3(1.0, 2.0, 3.0));
    return dot(sin(waves) * shown, vec3(0.3, 0.26, 0.2) * vec3(0.4 + 0.6 * up, 1.0, 1.0 - 0.4 * up));
}

// How fast the wall gets thicker upwards (m/m): its foot merges with the water that it rises from, and below the rim it
// widens into the bead. In between it is thinnest.
float wedge(float out_of_bead, float below_bead)
{
    const float up = clamp(sheet.x * CROWN_REACH, 0.0, 1.0), from_foot = 1.0 - up;
    const float swells = smoothstep(0.0, 1.0, 1.0 - below_bead) * (1.0 - out_of_bead);
    return 0.35 * swells - 0.6 * from_foot * from_foot * from_foot;
}

// The background, refracted by the angle between the wall's faces, as by a prism of water: towards its thick side. The
// scene's depth gives the distance behind the wall. `lean`: how the normal turns away from the thick side.
vec3 through_wall(vec3 d, vec3 lean)
{
    if (view.color_given == 0u)
        return around_of(d);
    const float stored = HAS_DEPTH ? buffer_depth(gl_FragCoord.xy) : view.far_depth;
    const float beyond = stored == view.far_depth ? 1.0 : clamp(1.0 - sheet.w / view_depth(stored), 0.0, 1.0);
    const vec2 bent = -0.333 * beyond / view.pixel_angle *
                      vec2(dot(lean, normalize(to_vec(view.right))), dot(lean, normalize(to_vec(view.up))));
    const vec2 low = vec2(view.viewport[0], view.viewport[1]) + 0.5;
    const vec2 pixel = clamp(gl_FragCoord.xy + bent, low, low + vec2(view.viewport[2], view.viewport[3]) - 1.0);
    return scene_at(pixel);
}

void main()
{
    const vec3 d = normalize(position);
    vec3 n = normalize(normal);
    const Rim ends = rim_of(n);
    n = dot(n, d) > 0.0 ? -n : n;
    // 0 where the bead begins, 1 at the rim. It is drawn at least a pixel thick. A disk has no bead.
    const bool disk = rim_data.w <= 0.0;
    // Water gathers in the fingers, most of all at their ends, which round into the drops that leave them.
    const bool has_fingers = !disk && rim_data.z > 0.0;
    const float finger = 0.5 + 0.5 * cos(rim_data.x), finger2 = finger * finger;
    const float gathers = has_fingers ? 0.7 + 0.4 * finger2 + 0.5 * finger2 * finger2 * finger2 : 1.0;
    const float min_bead_m = 1.2 * length(position) * view.pixel_angle, bead_m = max(gathers * size.y, min_bead_m);
    const float out_of_bead = disk ? 0.0 : clamp(1.0 - ends.below / bead_m, 0.0, 1.0);
    const float pixel_m = max(fwidth(ends.below), 1e-9),
                edge_cover = disk ? 1.0 : clamp(ends.below / pixel_m + 0.5, 0.0, 1.0);
    const float thickens = has_fingers ? wedge(out_of_bead, clamp(0.5 * ends.below / bead_m - 0.5, 0.0, 1.0)) : 0.0;
    const vec3 lean = ridge_slope() * (has_fingers ? 1.0 - out_of_bead : 0.0) * normalize(cross(upward, n)) -
                      thickens * normalize(upward);
    n = normalize(n + lean);
    // The film runs into the bead without an edge; its face is round, as that of a rod at the end of the sheet.
    const float across = smoothstep(0.15, 1.0, out_of_bead) - 0.6 * out_of_bead * (1.0 - out_of_bead);
    n = n * sqrt(1.0 - across * across) + ends.outward * across;
    n = normalize(n - 1.01 * d * max(dot(n, d), 0.0));
    const float cosine = -dot(n, d), face = fresnel(cosine);
    // A film has two faces: 2 F / (1 + F) with the light that is mirrored between them. A bead has one.
    const float mirror = mix(2.0 * face / (1.0 + face), face, disk ? 1.0 : out_of_bead);
    // Two parallel faces do not refract, so the wall is clear except for its ridges and wedges. The rim is a bead, and
    // at the sides the view is along the wall.
    const float bead = smoothstep(0.0, 0.8, out_of_bead) * min(gathers * size.y / bead_m, 1.0);
    const float rim = disk ? smoothstep(0.7, 1.0, sheet.x) : bead;
    const float edge = (1.0 - cosine) * (1.0 - cosine) * (1.0 - cosine);
    const float thick = clamp(0.05 + 0.12 * sheet.x * sheet.x + 0.6 * rim + 0.8 * edge, 0.0, 1.0);
    const vec3 side = n + d * cosine; // across the line of sight
    const vec3 behind = mix(through_wall(d, lean), through_ball(d, side * (0.35 + 0.6 * rim)), max(rim, edge));
    const vec3 glitter = lamps(position, d) * thick;
    // If the host gives its picture, the wall replaces the background by its refraction, but its motion counts only as
    // far as it is thick.
    const float hides = !disk && view.color_given != 0u ? 1.0 : thick;
    const float body = mirror + (1.0 - mirror) * hides, moving = mirror + (1.0 - mirror) * thick;
    const vec3 light = mirror * around_of(reflect(d, n)) + (1.0 - mirror) * hides * behind + glitter;
    const float visible = edge_cover * clamp(sheet.y * sheet.z, 0.0, 1.0) * (HAS_DEPTH ? soft_edge(sheet.w) : 1.0);
    radiance = for_target(vec4(light * visible, body * visible));
    WRITE_MOTION(motion_from(before), moving * visible);
    WRITE_REACTIVE(moving * visible, view.reactive_gain);
}
