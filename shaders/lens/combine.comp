// combine.comp - the picture: the far field, the near field and the layers over each other, by depth.
//
// At half resolution, what is nearly in focus comes from the pixels themselves, and what is not from the blurred
// images; it changes over where the circle of confusion grows from half a pixel to two.
// One invocation per pixel. Reads: color, depth, layers, fields. Writes: the picture.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(set = 0, binding = 5) uniform sampler2D scene_color;
layout(set = 0, binding = 12) uniform sampler2DArray fields;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D picture;

ivec2 pixel;  // in the target
vec2 sampled; // texture coordinates in the fields
bool halved;

// How much of a pixel comes from the blurred images. `radius` in px.
float blurriness(float radius) { return halved ? smoothstep(0.5, 2.0, abs(radius)) : 1.0; }

vec4 field(uint which) { return textureLod(fields, vec3(sampled, which), 0.0); }

vec4 over(vec4 front, vec4 back) { return front + (1.0 - front.a) * back; }

vec4 layer_at(uint layer, float radius)
{
    return mix(layer_color(layer, pixel), field(VIRGA_LENS_FIRST_LAYER + layer), blurriness(radius));
}

// A layer's circle of confusion at this pixel, in px.
float layer_radius(uint layer)
{
    const float inv_m = view.layer_inv_m[layer];
    return circle(inv_m > 0.0 ? inv_m : inverse_depth(layer_depth(layer, pixel))) * float(view.step);
}

void main()
{
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= view.width || at.y >= view.height)
        return;
    pixel = ivec2(view.left + at.x, view.top + at.y);
    halved = view.step > 1u;
    sampled = (vec2(at) + 0.5) / float(view.step) / vec2(textureSize(fields, 0).xy);
    const vec4 sharp = vec4(finite(texelFetch(scene_color, pixel, 0)).rgb, 1.0);
    const float radius = view.depth_given != 0u
                             ? circle(inverse_depth(texelFetch(scene_depth, pixel, 0).r)) * float(view.step) : 0.0;
    const vec4 far = field(VIRGA_LENS_FAR);
    vec4 near = field(VIRGA_LENS_NEAR), color = vec4(far.rgb, 1.0);
    if (radius >= 0.0)
        color = mix(sharp, color, blurriness(radius));
    else
        near = mix(sharp, near, blurriness(radius));
    const float near_px = far.a * float(view.step);
    bool near_done = false;
    for (uint layer = 0u; layer < view.layers; layer++) {
        const float layer_px = layer_radius(layer);
        if (!near_done && layer_px < near_px) {
            color = over(near, color);
            near_done = true;
        }
        color = over(layer_at(layer, layer_px), color);
    }
    if (!near_done)
        color = over(near, color);
    imageStore(picture, ivec2(at), color);
}
