// part.frag - the scene alone, or one layer alone, out of focus. A layer is cut by what of the scene is out of focus in
// front of it. So the parts can be put over each other in their order.
// One invocation per pixel. Reads: color, depth, layers, fields.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define NOT_SPECIALISED
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"
#define ALL_SHARP (view.all_sharp != 0u)
#define NO_NEAR false
#define NO_FAR false
const bool SOFT = false;
#include "compose.glsl"
#include "gpu/encode.glsl"

layout(push_constant) uniform Part { uint part; }; // 0: the scene; else 1 + the number of a layer
layout(location = 0) out vec4 color;

void main()
{
    look_at(uvec2(gl_FragCoord.xy) - uvec2(view.left, view.top));
    vec4 near, far;
    float near_px;
    scene_at(near, far, near_px);
    vec4 shown = over(near, far);
    bool behind = true;
    for (uint layer = 0u; layer < part; layer++)
        shown = layer_cut(layer, layer_radius(layer), near, near_px, behind);
    color = for_target(shown);
}
