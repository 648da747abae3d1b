// water.frag - light from the water's surface: what it mirrors, what is seen through it, and what it swallows.
// One invocation per pixel of the target. Reads: the effect's images, the host's picture. Writes: radiance, and for
// temporal anti-aliasing motion and reactivity.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
layout(constant_id = 0) const uint LOOK = 0u; // VIRGA_WATER_LOOK_...
#define HAS_DEPTH ((LOOK & VIRGA_WATER_LOOK_DEPTH) != 0u)
#define HAS_COLOR ((LOOK & VIRGA_WATER_LOOK_COLOR) != 0u)
#define HAS_CONTACT ((LOOK & VIRGA_WATER_LOOK_CONTACT) != 0u)
#define SCALED ((LOOK & VIRGA_WATER_LOOK_SCALED) != 0u)
#define SCENE_DEPTH_BINDING 17
#include "gpu/scene_depth.glsl"
#include "gpu/light.glsl"
#include "gpu/temporal.glsl"
#include "surface.glsl"
#include "covered.glsl"
#include "light.glsl"
#include "contact.glsl"
#include "specks.glsl"
#include "gpu/encode.glsl"

layout(location = 0) out vec4 radiance;

void main()
{
    const vec2 at = image_pixel(gl_FragCoord.xy);
    const vec4 sums = sums_at(at);
    const vec4 moved = motion_sums_at(at);
    const vec3 ray = pixel_ray(gl_FragCoord.xy);
    Water water = Water(at, sums.z / max(sums.w, 1e-12), normal_of(sums.xy / max(sums.w, 1e-12)), 0.0, false);
    const vec3 bend_x = dFdx(water.normal), bend_y = dFdy(water.normal);
    const Covered cover = covered_at(at, sums, moved);
    water.covered = cover.surface;
    if (HAS_CONTACT)
        water = with_contact(water, ray);
    const float depth = water.depth;
    float covered = water.covered;
    if (HAS_DEPTH)
        covered *= water.is_new ? edge_of_contact(depth) : soft_edge(depth);
    const Specks specks = specks_of(vec4(moved.xy, cover.specks, moved.w), ray);
    if (covered + specks.covered <= 0.0)
        discard;
    Point point;
    point.depth = depth;
    point.position = ray * depth;
    point.incident = normalize(ray);
    point.normal = seen_normal(water.normal, point.incident);
    point.spread = water.is_new ? 0.0 : 0.25 * (dot(bend_x, bend_x) + dot(bend_y, bend_y));
    point.thickness = thickness_at(at);
    const vec4 light = specks_over(specks, covered > 0.0 ? vec4(light_of(point) * covered, covered) : vec4(0.0));
    radiance = for_target(light);
    gl_FragDepth = clamp(view.depth_b / (covered > 0.0 ? depth : specks.depth) - view.depth_a, 0.0, 1.0);
    WRITE_REACTIVE(light.a, view.reactive_gain);
    WRITE_MOTION(moved.xy / max(sums.w + cover.specks, 1e-12), light.a);
}
