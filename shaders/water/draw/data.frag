// data.frag - the water's thickness, normal or motion at a pixel, for compositing; see virga_water_data.
// One invocation per pixel of the target that the water covers by half or more. Reads: the effect's images, the host's
// depth.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#define SCENE_DEPTH_BINDING 17
#include "gpu/scene_depth.glsl"
#define SCALED (look.scale < 1.0)
#include "surface.glsl"
#include "covered.glsl"

layout(location = 0) flat in uint what;
layout(location = 0) out vec4 data;

void main()
{
    const vec2 at = image_pixel(gl_FragCoord.xy);
    const vec4 sums = sums_at(at);
    const float depth = sums.z / max(sums.w, 1e-12);
    const vec4 moved = texelFetch(motion_image, ivec2(at), 0); // the third channel: see specks.glsl
    float covered = covered_at(at, sums, vec4(0.0)).surface;
    if (view.depth_given != 0u)
        covered *= soft_edge(depth);
    if (covered < 0.5)
        discard;
    if (what == VIRGA_WATER_DATA_THICKNESS_GPU)
        data = vec4(thickness_at(at), 0.0, 0.0, 1.0);
    else if (what == VIRGA_WATER_DATA_NORMAL_GPU)
        data = vec4(seen_normal(normal_of(sums.xy / sums.w), normalize(pixel_ray(gl_FragCoord.xy))), 1.0);
    else
        data = vec4(moved.xy / (sums.w + max(moved.z, 0.0)) * vec2(view.motion_scale[0], view.motion_scale[1]),
                    0.0, 1.0);
    gl_FragDepth = clamp(view.depth_b / depth - view.depth_a, 0.0, 1.0);
}
