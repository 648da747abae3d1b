// compose.glsl - the far field, the near field and the layers over each other, by depth.
//
// At half resolution, what is nearly in focus comes from the pixels themselves, and what is not from the blurred
// images; it changes over where the circle of confusion grows from half a pixel to two.
// The includer has lens.glsl, pixels.glsl, layers.glsl, and says what is left out:
// ALL_SHARP: nothing is out of focus; NO_NEAR: nothing of the scene in front of the focus; NO_FAR: nothing of it.
// SOFT: all of it is from the fields, and neither color nor depth is read.
// With BENEATH, what is in focus lies in the target already. It is left out here, as a pixel without color and
// coverage. The result is linear in it, so it is what has to be blended over the target.
#ifndef BENEATH
#include "scene_color.glsl"
#endif
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(set = 0, binding = 12) uniform sampler2DArray fields;
#ifndef PER_TEXEL // the size of a texel of the fields, in texture coordinates
#define PER_TEXEL (1.0 / vec2(textureSize(fields, 0).xy))
#endif
#ifndef LAYER_IS_THERE // draws in place know where a layer has nothing, and where nothing of it is in focus
#define LAYER_IS_THERE(layer) true
#define LAYER_IS_SEEN(layer)  true
#define NEAR_IS_THERE         true
#define layer_field(layer)    field(VIRGA_LENS_FIRST_LAYER + layer)
#endif

ivec2 pixel;  // in the target
vec2 sampled; // texture coordinates in the fields

void look_at(uvec2 at)
{
    pixel = ivec2(view.left + at.x, view.top + at.y);
    // The image may be larger than what is used of it.
    const vec2 texel = min((vec2(at) + 0.5) / float(STEP), vec2(view.columns, view.rows) - 0.5);
    sampled = texel * PER_TEXEL;
}

// At full resolution a texel is a pixel, and fetching it is cheaper.
vec4 field(uint which)
{
    if (!HALVED)
        return texelFetch(fields, ivec3(pixel - ivec2(view.left, view.top), which), 0);
    return textureLod(fields, vec3(sampled, which), 0.0);
}

// Where nothing is blurred there may be no field.
vec4 blurred(vec4 sharp, vec4 from_field, float radius)
{
    const float share = blurriness(radius);
    return share > 0.0 ? mix(sharp, from_field, share) : sharp;
}

vec4 over(vec4 front, vec4 back) { return front + (1.0 - front.a) * back; }

// The scene without layers, from its fields. `near_px` is the signed circle of confusion of what is in `near`.
void scene_of(vec4 behind, vec4 before, out vec4 near, out vec4 far, out float near_px)
{
#ifdef BENEATH
    const vec4 sharp = vec4(0.0);
#else
    const vec4 sharp = vec4(scene_color(pixel), 1.0);
#endif
    near = vec4(0.0);
    far = sharp;
    near_px = 0.0;
    if (ALL_SHARP || NO_FAR)
        return;
    const float radius = !SOFT && view.depth_given != 0u
                             ? circle(inverse_depth(texelFetch(scene_depth, pixel, 0).r)) * float(STEP) : 0.0;
    if (!NO_NEAR) {
        near = before;
        near_px = behind.a * float(STEP);
    }
    far = vec4(behind.rgb, 1.0);
    if (SOFT)
        return;
    // In front of the focus, too: where it is little, what is blurred of the pixel itself is in the far field.
    if (HALVED || radius >= 0.0)
        far = blurred(sharp, far, radius);
}

void scene_at(out vec4 near, out vec4 far, out float near_px)
{
    scene_of(field(VIRGA_LENS_FAR), field(VIRGA_LENS_NEAR), near, far, near_px);
}

// A layer's circle of confusion at this pixel, in px.
float layer_radius(uint layer)
{
    const float inv_m = view.layer_inv_m[layer];
    return circle(inv_m > 0.0 ? inv_m : inverse_depth(layer_depth(layer, pixel))) * float(STEP);
}

vec4 layer_at(uint layer, float radius)
{
    vec4 color = vec4(0.0);
    if (LAYER_IS_SEEN(layer))
        color = layer_color(layer, pixel);
    if (ALL_SHARP || (view.sharp_layers >> layer & 1u) != 0u)
        return color;
    const vec4 from_field = layer_field(layer);
    if (!LAYER_IS_SEEN(layer))
        return from_field / max(from_field.a, 1.0);
    if (!HALVED || view.layer_inv_m[layer] > 0.0)
        return blurred(color, from_field, radius);
    // The field has what is out of focus alone (layer_mean), also where this pixel is empty or in focus.
    const vec4 sum = (1.0 - blurriness(radius)) * color + from_field;
    return sum / max(sum.a, 1.0);
}

// The same, cut by the scene's near field where that is in front of it. `behind` is so for the layers before it, and
// then for this one: the first layer in front of that field has all before it behind it. What lies on the scene was cut
// with it.
vec4 layer_cut(uint layer, float radius, vec4 near, float near_px, inout bool behind)
{
    const bool on_scene = layer + 1u == view.on_scene;
    behind = behind && (on_scene || radius >= near_px);
    return layer_at(layer, radius) * (behind && !on_scene ? 1.0 - near.a : 1.0);
}
