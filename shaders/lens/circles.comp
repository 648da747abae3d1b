// circles.comp - the signed radius (px) of the circle of confusion of each pixel, for a host that blurs by itself: of
// the scene, or of one layer. Less than 0: in front of the focus.
// One invocation per pixel. Reads: depth, depths of layers, state. Writes: circles.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"

const uint PART = OWN_FORM; // 0: the scene; else 1 + the number of a layer

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(set = 0, binding = 27, r32f) uniform writeonly image2DArray circles;

float radius_at(ivec2 pixel)
{
    if (PART > 0u && PART != view.on_scene) {
        const float inv_m = view.layer_inv_m[PART - 1u];
        return circle(inv_m > 0.0 ? inv_m : inverse_depth(layer_depth(PART - 1u, pixel)));
    }
    return view.depth_given != 0u ? circle(inverse_depth(texelFetch(scene_depth, pixel, 0).r)) : 0.0;
}

void main()
{
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= view.width || at.y >= view.height)
        return;
    const ivec2 pixel = ivec2(view.left, view.top) + ivec2(at);
    imageStore(circles, ivec3(at, PART), vec4(radius_at(pixel) * float(STEP), 0.0, 0.0, 0.0));
}
