// surfel.frag - light from the water's surface, as its surfels have it: see divide.glsl.
// One invocation per pixel of the target. Reads: the effect's images. Writes: radiance, and for temporal anti-aliasing
// motion and reactivity.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
layout(constant_id = 0) const uint LOOK = 0u; // VIRGA_WATER_LOOK_DEPTH or 0
#define HAS_DEPTH (LOOK != 0u)
#define HAS_COLOR (view.color_given != 0u)
#define SCENE_DEPTH_BINDING 17
#include "gpu/scene_depth.glsl"
#include "gpu/light.glsl"
#include "gpu/temporal.glsl"
#define SCALED (look.scale < 1.0)
#include "surface.glsl"
#include "covered.glsl"
#include "scene_color.glsl"
#include "specks.glsl"
#include "gpu/encode.glsl"

layout(set = 0, binding = 27) uniform sampler2D color_image;

layout(location = 0) out vec4 radiance;

void main()
{
    const vec2 at = image_pixel(gl_FragCoord.xy);
    const ivec2 size = ivec2(look.width, look.height);
    const vec4 sums = sums_at(at);
    const float depth = sums.z / max(sums.w, 1e-12);
    const vec4 moved = motion_sums_at(at);
    const Covered cover = covered_at(at, sums, moved);
    float covered = cover.surface;
    if (HAS_DEPTH)
        covered *= soft_edge(depth);
    const vec4 color = SCALED ? between_texels(color_image, at, size) : texelFetch(color_image, ivec2(at), 0);
    if (color.w <= 1e-9)
        covered = 0.0;
    const Specks specks = specks_of(vec4(moved.xy, cover.specks, moved.w), pixel_ray(gl_FragCoord.xy));
    if (covered + specks.covered <= 0.0)
        discard;
    const vec4 light = specks_over(specks, vec4(max(color.rgb / max(color.w, 1e-9), vec3(0.0)), 1.0) * covered);
    radiance = for_target(light);
    gl_FragDepth = clamp(view.depth_b / (covered > 0.0 ? depth : specks.depth) - view.depth_a, 0.0, 1.0);
    WRITE_REACTIVE(light.a, view.reactive_gain);
    WRITE_MOTION(moved.xy / max(sums.w + cover.specks, 1e-12), light.a);
}
