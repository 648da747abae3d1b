// sprite_thin.frag - a sprite that is too narrow to show an image of the background (below WIDE_PX): its mean colour,
// premultiplied.
// One invocation per pixel of such a sprite. Reads: the scene's picture and depth. Writes: radiance, motion, reactive.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "gpu/vectors.glsl"
#include "shared/splash_gpu.h"
#include "shared/view_gpu.h"
layout(scalar, set = 0, binding = 1) uniform View
{
    virga_view_gpu view;
    virga_splash_look_gpu look;
};
#include "gpu/encode.glsl"
#include "gpu/light.glsl"
#include "gpu/view.glsl"
#include "sprite_pixel.glsl"
#include "through.glsl"
#include "small_water.glsl"

void main()
{
    const float alpha = sprite_cover(), u = min(abs(from_middle()) / max(shape.x, 0.5), 1.0);
    const vec3 open = mix(center_alpha.rgb, rim_kind.rgb, (1.0 + 2.0 * u * u) / 3.0);
    // A cloud's droplets scatter light from everywhere: it shows no picture of what is behind it.
    const bool cloud = !PUFFS && rim_kind.w > 2.5;
    vec3 light = vec3(0.0);
    if (!PUFFS || (FOR_GPU && alpha > 0.0))
        light = cloud ? open : small_water(open);
    // Where none of several puffs is there is nothing to light: a loop, see puff_cover.
    [[dont_unroll]] for (bool shows = PUFFS && !FOR_GPU && alpha > 0.0; shows; shows = false)
        light = small_water(open);
    radiance = for_target(vec4(light * alpha, alpha));
    WRITE_MOTION(motion, alpha);
    WRITE_REACTIVE(alpha, view.reactive_gain);
}
