// surfel.frag - light from the water's surface, as its surfels have it: see divide.glsl.
// One invocation per pixel of the target. Reads: the effect's images. Writes: radiance, and for temporal anti-aliasing
// motion and reactivity.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
layout(constant_id = 0) const uint LOOK = 0u; // VIRGA_WATER_LOOK_DEPTH or 0
#define SCENE_DEPTH_BINDING 17
#include "gpu/scene_depth.glsl"
#include "gpu/temporal.glsl"
#define SCALED (look.scale < 1.0)
#include "surface.glsl"
#include "gpu/encode.glsl"

layout(set = 0, binding = 27) uniform sampler2D color_image;

layout(location = 0) out vec4 radiance;

void main()
{
    const vec2 at = image_pixel(gl_FragCoord.xy);
    const ivec2 size = ivec2(look.width, look.height);
    const vec4 sums = sums_at(at);
    const float slope = length(vec2(dFdx(sums.w), dFdy(sums.w)));
    const float depth = sums.z / max(sums.w, 1e-12);
    float covered = sums.w > 1e-4 ? coverage_of(sums.w, slope, depth) : 0.0;
    if (LOOK != 0u)
        covered *= soft_edge(depth);
    const vec4 color = SCALED ? between_texels(color_image, at, size) : texelFetch(color_image, ivec2(at), 0);
    if (covered <= 0.0 || color.w <= 1e-9)
        discard;
    radiance = for_target(vec4(max(color.rgb / color.w, vec3(0.0)) * covered, covered));
    gl_FragDepth = clamp(view.depth_b / depth - view.depth_a, 0.0, 1.0);
    WRITE_REACTIVE(covered, view.reactive_gain);
#ifdef MOTION
    WRITE_MOTION(texelFetch(motion_image, ivec2(at), 0).xy / max(sums.w, 1e-12), covered);
#endif
}
