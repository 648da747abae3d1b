// sprite_thin.frag - a sprite that is too narrow to show the background through it (below WIDE_PX): its mean colour,
// premultiplied.
// One invocation per pixel of such a sprite. Reads: the scene's depth. Writes: radiance, motion, reactive.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/splash_gpu.h"
#include "shared/view_gpu.h"
layout(scalar, set = 0, binding = 1) uniform View { virga_view_gpu view; };
#include "sprite_pixel.glsl"
#include "gpu/encode.glsl"

void main()
{
    const float alpha = sprite_cover(), u = min(abs(from_middle()) / max(shape.x, 0.5), 1.0);
    radiance = for_target(vec4(mix(center_alpha.rgb, rim_kind.rgb, 0.25 + 0.5 * u * u) * alpha, alpha));
    WRITE_MOTION(motion, alpha);
    WRITE_REACTIVE(alpha, view.reactive_gain);
}
