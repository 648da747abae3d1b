// paper.comp - focus as in Sato et al. 2002, "A method for real-time rendering of water droplets taking into account
// interactive depth of field effects", section 3.5.
//
// Equation 1 has two filters: f1, the pixel and its four neighbours, and f2, the pixel and its eight neighbours, each
// divided by the sum of its weights. Neighbours have weight 1 and the pixel itself has weight f. The paper uses f = 1
// for f1 and f = 5 for f2. f2 then has a variance of 0.46 px^2 along each axis, and f1 of 0.40 px^2: f2 is the stronger
// blur, as the paper says.
//
// An invocation goes down a column of pixels, so that each row of three is read and added once: with eight pixels, 3.75
// texels a pixel instead of 9.
// One invocation per VIRGA_LENS_COLUMN pixels. Reads: color, depth, layers, state. Writes: the picture.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#define SCENE_LINEAR (OWN_FORM > VIRGA_LENS_LAYERS)
#include "scene_color.glsl"
#include "layers.glsl"

const uint LAYERS = OWN_FORM % (VIRGA_LENS_LAYERS + 1u);

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D picture;

#define SCENE 0xFFFFFFFFu // not a layer

ivec2 first; // pixel of the column, from the viewport's first one

// The pixel of the target that is some pixels from the first one; the nearest one beyond the edges.
ivec2 pixel_at(int x, int y)
{
    return ivec2(view.left, view.top) + clamp(first + ivec2(x, y), ivec2(0), ivec2(view.width, view.height) - 1);
}

vec4 color_at(uint of, int x, int y)
{
    return of == SCENE ? vec4(scene_color(pixel_at(x, y)), 1.0) : layer_color(of, pixel_at(x, y));
}

// Three pixels beside each other.
struct row {
    vec4 middle, sum;
};

row row_at(uint of, int y)
{
    const vec4 middle = color_at(of, 0, y);
    return row(middle, color_at(of, -1, y) + middle + color_at(of, 1, y));
}

// Which blur a view depth has, by its difference to the depth at focus (equation 2): 0, 1 or 2.
uint blur_at(float inv_m)
{
    if (inv_m == focus_inv_m())
        return 0u;
    const float difference = abs(1.0 / inv_m - 1.0 / focus_inv_m()); // infinity minus a number is infinity
    return difference <= view.threshold_m[0] ? 0u : difference <= view.threshold_m[1] ? 1u : 2u;
}

// The paper's drops are always far from the focus. Here a layer at focus is sharp, as the scene is.
uint blur_of(uint of, int y)
{
    if (of == SCENE)
        return view.depth_given != 0u ? blur_at(inverse_depth(texelFetch(scene_depth, pixel_at(0, y), 0).r)) : 0u;
    const float inv_m = view.layer_inv_m[of];
    return blur_at(inv_m > 0.0 ? inv_m : inverse_depth(layer_depth(of, pixel_at(0, y))));
}

// The filters f1 and f2 of equation 1 at the middle of three rows.
vec4 filtered(row above, row own, row below, uint blur)
{
    const float weights[2] = float[2](view.filter_weight[0], view.filter_weight[1]);
    const vec4 weak = above.middle + own.sum + below.middle + (weights[0] - 1.0) * own.middle;
    const vec4 strong = above.sum + own.sum + below.sum + (weights[1] - 1.0) * own.middle;
    return blur == 0u ? own.middle : blur == 1u ? weak / (4.0 + weights[0]) : strong / (8.0 + weights[1]);
}

// Puts the scene, or a layer, over the column. Equations 4 and 5 in one: with premultiplied colors a' Iw' is the
// filtered color. The sums of equation 4 divide by the coverage, and equation 6 multiplies by it.
void put(uint of, inout vec3 colors[VIRGA_LENS_COLUMN])
{
    row above = row_at(of, -1), own = row_at(of, 0);
    for (int y = 0; y < VIRGA_LENS_COLUMN; y++) {
        const row below = row_at(of, y + 1);
        const vec4 water = filtered(above, own, below, blur_of(of, y));
        colors[y] = (1.0 - water.a) * colors[y] + water.rgb; // equation 6
        above = own;
        own = below;
    }
}

void main()
{
    first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, VIRGA_LENS_COLUMN);
    if (first.x >= int(view.width) || first.y >= int(view.height))
        return;
    vec3 colors[VIRGA_LENS_COLUMN];
    for (int y = 0; y < VIRGA_LENS_COLUMN; y++)
        colors[y] = vec3(0.0);
    put(SCENE, colors);
    if (LAYERS > 0u)
        put(0u, colors);
    if (LAYERS > 1u)
        put(1u, colors);
    if (LAYERS > 2u)
        put(2u, colors);
    if (LAYERS > 3u)
        put(3u, colors);
    if (LAYERS > 4u)
        put(4u, colors);
    for (int y = 0; y < min(VIRGA_LENS_COLUMN, int(view.height) - first.y); y++)
        imageStore(picture, first + ivec2(0, y), vec4(colors[y], 1.0));
}
