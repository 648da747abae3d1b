// paper.frag - drops as in the paper: the plate, from a copy of 64 x 64 texels, displaced by the normal. Premultiplied.
// One invocation per pixel of a tile with water. Reads: densities, the plate's copies. Writes: radiance, motion,
// reactive.
// Paper: Goto et al. 2009, section 5.4.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define PAPER
#include "view.glsl"
#include "gpu/light.glsl"
#include "surface.glsl"
#include "paper_slopes.glsl"
#include "plate.glsl"
#include "paper.glsl"
#include "temporal.glsl"
#include "gpu/encode.glsl"

layout(location = 0) out vec4 radiance;

void main()
{
    const Water water = water_by_density();
    const vec2 pixel = paper_pixel(gl_FragCoord.xy, water.slope, pane_directions);
#ifdef TEMPORAL
    const mat2 change = mat2(dFdx(pixel), dFdy(pixel)); // before the discard: derivatives need all pixels of a quad
#endif
    if (water.cover + water.mist <= 0.0 || is_behind_scene())
        discard;
    const vec2 mirrored = view_box.xy + paper_uv(pixel) * view_box.zw;
    const vec3 light = HAS_PLATE ? copy_at(mirrored / plate_size(), VIRGA_GLASS_COPY_PAPER)
                                 : environment(normalize(pixel_ray(mirrored)), vec2(1.0));
    const float alpha = water.cover + water.mist;
    radiance = for_target(vec4(light * alpha, alpha));
#ifdef TEMPORAL
    const vec2 shown_was = water_before() + pixel - gl_FragCoord.xy;
    write_temporal(motion_in_water(change, scene_before(pixel), shown_was), alpha);
#endif
}
