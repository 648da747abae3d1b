// paper.comp - focus as in Sato et al. 2002, "A method for real-time rendering of water droplets taking into account
// interactive depth of field effects", section 3.5.
//
// Equation 1 has two filters: f1, the pixel and its four neighbours, and f2, the pixel and its eight neighbours, each
// divided by the sum of its weights. Neighbours have weight 1 and the pixel itself has weight f. The paper uses f = 1
// for f1 and f = 5 for f2. f2 then has a variance of 0.46 px^2 along each axis, and f1 of 0.40 px^2: f2 is the stronger
// blur, as the paper says.
// One invocation per pixel. Reads: color, depth, layers, state. Writes: the picture.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "scene_color.glsl"
#include "layers.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D picture;

ivec2 pixel;

ivec2 neighbour(int x, int y)
{
    const ivec2 first = ivec2(view.left, view.top);
    return clamp(pixel + ivec2(x, y), first, first + ivec2(view.width, view.height) - 1);
}

// Which blur a view depth has, by its difference to the depth at focus (equation 2): 0, 1 or 2.
uint blur_at(float inv_m)
{
    if (inv_m == state.focus_inv_m)
        return 0u;
    const float difference = abs(1.0 / inv_m - 1.0 / state.focus_inv_m); // infinity minus a number is infinity
    return difference <= view.threshold_m[0] ? 0u : difference <= view.threshold_m[1] ? 1u : 2u;
}

float weight(int x, int y, uint blur)
{
    if (x == 0 && y == 0)
        return view.filter_weight[blur - 1u];
    return blur == 1u && x != 0 && y != 0 ? 0.0 : 1.0;
}

vec3 filtered_scene(uint blur)
{
    if (blur == 0u)
        return scene_color(pixel);
    vec4 sum = vec4(0.0);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            sum += weight(x, y, blur) * vec4(scene_color(neighbour(x, y)), 1.0);
    return sum.rgb / sum.a;
}

// Equations 4 and 5 in one: with premultiplied colors a' Iw' is the filtered color. The sums of equation 4 divide by
// the coverage, and equation 6 multiplies by it.
vec4 filtered_layer(uint layer, uint blur)
{
    if (blur == 0u)
        return layer_color(layer, pixel);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            sum += weight(x, y, blur) * layer_color(layer, neighbour(x, y));
            weights += weight(x, y, blur);
        }
    return sum / weights;
}

void main()
{
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= view.width || at.y >= view.height)
        return;
    pixel = ivec2(view.left + at.x, view.top + at.y);
    const uint blur =
        view.depth_given != 0u ? blur_at(inverse_depth(texelFetch(scene_depth, pixel, 0).r)) : 0u;
    vec3 color = filtered_scene(blur);
    for (uint layer = 0u; layer < view.layers; layer++) {
        const float inv_m = view.layer_inv_m[layer];
        // The paper's drops are always far from the focus. Here a layer at focus is sharp, as the scene is.
        const float layer_inv_m = inv_m > 0.0 ? inv_m : inverse_depth(layer_depth(layer, pixel));
        const vec4 water = filtered_layer(layer, blur_at(layer_inv_m));
        color = (1.0 - water.a) * color + water.rgb; // equation 6
    }
    imageStore(picture, ivec2(at), vec4(color, 1.0));
}
