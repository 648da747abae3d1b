// combine.comp - the picture: the scene and the layers over each other.
// At half resolution it works on one list of tiles after the other.
// One invocation per pixel. Reads: color, depth, layers, fields, lists. Writes: the picture.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"

const uint LAYERS = OWN_FORM % (VIRGA_LENS_LAYERS + 1u);
const uint KIND = OWN_FORM / (VIRGA_LENS_LAYERS + 1u);
const bool ALL_SHARP = KIND == VIRGA_LENS_ALL_SHARP;
const bool NO_FAR = KIND == VIRGA_LENS_TILES_SHARP;
const bool NO_NEAR = KIND == VIRGA_LENS_TILES_FAR || NO_FAR;
const bool LISTED = HALVED && !ALL_SHARP;

#include "compose.glsl"
#include "lists.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D picture;

struct composed {
    vec4 color;   // so far
    vec4 near;    // the scene's near field
    float near_px;
    bool near_done; // it is in the color
    bool behind;    // see layer_cut
};

void put(uint layer, inout composed sum)
{
    if (ALL_SHARP) {
        sum.color = over(layer_at(layer, 0.0), sum.color);
        return;
    }
    const float radius = layer_radius(layer);
    if (!sum.near_done && radius < sum.near_px) {
        sum.color = over(sum.near, sum.color);
        sum.near_done = true;
    }
    const vec4 cut = view.on_scene != 0u ? sum.near : vec4(0.0);
    sum.color = over(layer_cut(layer, radius, cut, sum.near_px, sum.behind), sum.color);
}

void main()
{
    const ivec2 first = LISTED ? listed_first(KIND, STEP * TILE_GROUPS) : ivec2(gl_WorkGroupID.xy) * 8;
    const uvec2 at = uvec2(first) + gl_LocalInvocationID.xy;
    if (first.x < 0 || at.x >= view.width || at.y >= view.height)
        return;
    look_at(at);
    composed sum;
    scene_at(sum.near, sum.color, sum.near_px);
    // What lies on the scene also lies on its near field, so the layers behind that field come after it, cut by it.
    sum.near_done = view.on_scene != 0u;
    sum.behind = true;
    if (sum.near_done)
        sum.color = over(sum.near, sum.color);
    if (LAYERS > 0u)
        put(0u, sum);
    if (LAYERS > 1u)
        put(1u, sum);
    if (LAYERS > 2u)
        put(2u, sum);
    if (LAYERS > 3u)
        put(3u, sum);
    if (LAYERS > 4u)
        put(4u, sum);
    if (!sum.near_done)
        sum.color = over(sum.near, sum.color);
    imageStore(picture, ivec2(at), sum.color);
}
