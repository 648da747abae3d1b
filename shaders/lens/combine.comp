// combine.comp - the picture: the scene and the layers over each other.
// One invocation per pixel. Reads: color, depth, layers, fields. Writes: the picture.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"
#include "compose.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D picture;

void main()
{
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= view.width || at.y >= view.height)
        return;
    look_at(at);
    vec4 near, color;
    float near_px;
    scene_at(near, color, near_px);
    // What lies on the scene also lies on its near field, so the layers behind that field come after it, cut by it.
    bool near_done = view.on_scene != 0u, behind = true;
    if (near_done)
        color = over(near, color);
    for (uint layer = 0u; layer < view.layers; layer++) {
        if (!near_done && layer_radius(layer) < near_px) {
            color = over(near, color);
            near_done = true;
        }
        color = over(view.on_scene != 0u ? layer_cut(layer, near, near_px, behind)
                                         : layer_at(layer, layer_radius(layer)),
                     color);
    }
    if (!near_done)
        color = over(near, color);
    imageStore(picture, ivec2(at), color);
}
