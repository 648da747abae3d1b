// overlay.frag - (half resolution, in place) what is out of focus, and the layers, to be blended over a target that
// holds what is in focus.
//
// The far field, the near field and the layers lie over each other by premultiplied "over", which is linear in the
// sharp color at the bottom. So blending can put it there: it does not have to be read here, and where nothing is out
// of focus nothing has to be written. One list of tiles after the other; without layers those in focus are not drawn.
// In tiles of which nothing at all is in focus there is nothing to blend over: they overwrite the target.
//
// Near fields are read in tiles that have them. Beyond a side of a tile they may not be there (narrow.glsl), so nothing
// is read across it: what reaches a tile is looked for two texels farther, so they are 0 on both sides.
// One invocation per pixel. Reads: depth, layers, fields.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"

const uint LAYERS = OWN_FORM % (VIRGA_LENS_LAYERS + 1u); // none, one or any number
const uint KIND = OWN_FORM / (VIRGA_LENS_LAYERS + 1u);
const bool ALL_SHARP = KIND == VIRGA_LENS_ALL_SHARP;
const bool NO_FAR = KIND == VIRGA_LENS_TILES_SHARP;
const bool NO_NEAR = KIND == VIRGA_LENS_TILES_FAR || NO_FAR;
const bool WIDE = KIND == VIRGA_LENS_TILES_WIDE, BOTH = KIND == VIRGA_LENS_TILES_BOTH; // with coarse fields
const bool SOFT = KIND == VIRGA_LENS_TILES_SOFT || WIDE; // WIDE has the tiles of both kinds

// What the tile has of each layer: bits, VIRGA_LENS_LAYER_... Software Vulkan executes both sides of a branch.
layout(location = 3) flat in uint layers_there;
bool layer_has(uint layer, uint bits)
{
    return !FOR_GPU || ALL_SHARP || (layers_there >> (VIRGA_LENS_LAYER_BITS * layer) & bits) != 0u;
}
#define LAYER_IS_THERE(layer) \
    layer_has(layer, VIRGA_LENS_LAYER_FINE | VIRGA_LENS_LAYER_COARSE | VIRGA_LENS_LAYER_SEEN)
#define LAYER_IS_SEEN(layer)  layer_has(layer, VIRGA_LENS_LAYER_SEEN)
#define NEAR_IS_THERE         (!FOR_GPU || (!NO_NEAR && near_is_there()))
bool near_is_there();
vec4 layer_field(uint layer);
// The size of a texel of the fields, and of the coarse ones, in texture coordinates. A quotient for each pixel is dear.
layout(location = 4) flat in vec4 per_texel;
#define PER_TEXEL per_texel.xy
#define BENEATH
#include "compose.glsl"
#include "stack.glsl"

layout(location = 0) flat in uint beside; // the kind of the tile: bits, VIRGA_LENS_HAS_...
layout(location = 1) flat in vec4 near_limits; // texture coordinates within which there are near fields
layout(location = 2) flat in vec4 far_limits;  // (BOTH) and far ones
layout(set = 0, binding = 32) uniform sampler2D far_field; // the first image of fields
layout(set = 0, binding = 34) uniform sampler2D coarse_near;
layout(set = 0, binding = 35) uniform sampler2D coarse_far;
layout(set = 0, binding = 37) uniform sampler2D first_layer_field;
layout(set = 0, binding = 38) uniform sampler2D first_coarse_layer;
layout(set = 0, binding = 39) uniform sampler2DArray coarse_fields;
layout(set = 0, binding = 42) uniform sampler2D near_circles;
layout(location = 0) out vec4 color;

bool has(uint bit) { return (beside & bit) != 0u; }

bool near_is_there() { return has(VIRGA_LENS_HAS_NEAR) || has(VIRGA_LENS_HAS_COARSE_NEAR); }

// Where this pixel is in the coarse fields, in texture coordinates.
vec2 place_in_coarse()
{
    const vec2 texel = 0.25 * (vec2(pixel) - vec2(view.left, view.top)) + 0.125;
    return min(texel, vec2((uvec2(view.columns, view.rows) + 1u) >> 1u) - 0.5) * per_texel.zw;
}

// From one of the scales, or from both, which add up: narrow_layer.glsl. Of one layer there is a view of its own.
vec4 layer_field(uint layer)
{
    vec4 sum = vec4(0.0);
    if (layer_has(layer, VIRGA_LENS_LAYER_FINE))
        sum = LAYERS == 1u ? textureLod(first_layer_field, sampled, 0.0)
                           : textureLod(fields, vec3(sampled, VIRGA_LENS_FIRST_LAYER + layer), 0.0);
    if (FOR_GPU && (view.coarse_layers >> layer & 1u) != 0u && layer_has(layer, VIRGA_LENS_LAYER_COARSE))
        sum += LAYERS == 1u ? textureLod(first_coarse_layer, place_in_coarse(), 0.0)
                            : textureLod(coarse_fields, vec3(place_in_coarse(), VIRGA_LENS_FIRST_LAYER + layer), 0.0);
    return sum;
}

// Both fields of the tile, coarse where discs are wide. What is near in one of them and in the other adds up to what
// is near here. Wide discs are nearer, so where that would be more than all there is, they hide the others.
//
// `circles`: the circle of confusion (texels) of what is near, times its coverage, and the coverage.
void fields_of_both(inout vec4 behind, inout vec4 before, inout vec2 circles)
{
    const vec2 place = place_in_coarse();
    const vec4 coarse_and_circle = textureLod(coarse_far, place, 0.0);
    const vec3 coarse = coarse_and_circle.rgb;
    if (has(VIRGA_LENS_HAS_COARSE_NEAR)) {
        const vec4 coarse_before = textureLod(coarse_near, place, 0.0);
        circles += coarse_before.a * vec2(2.0 * coarse_and_circle.a, 1.0);
        before *= min(max(1.0 - coarse_before.a, 0.0) / max(before.a, 1e-4), 1.0);
        before = (before + coarse_before) / max(before.a + coarse_before.a, 1.0);
    }
    if (BOTH && has(VIRGA_LENS_HAS_FINE)) {
        const float radius = circle(inverse_depth(texelFetch(scene_depth, pixel, 0).r)) * float(STEP);
        behind.rgb += behind.a * coarse; // see fill_of_both
        behind.rgb = mix(behind.rgb, coarse, coarseness(max(radius, 0.0)));
    } else {
        behind.rgb = coarse;
    }
}

vec4 near_field()
{
    return textureLod(fields, vec3(clamp(sampled, near_limits.xy, near_limits.zw), VIRGA_LENS_NEAR), 0.0);
}

// The same of the fields of half resolution. Only layers that are out of focus need it.
vec2 circles_of(vec4 before)
{
    if ((view.fine_layers | view.coarse_layers) == 0u || !has(VIRGA_LENS_HAS_NEAR))
        return vec2(0.0);
    return before.a * vec2(textureLod(near_circles, clamp(sampled, near_limits.xy, near_limits.zw), 0.0).r, 1.0);
}

void main()
{
    const uvec2 at = uvec2(gl_FragCoord.xy) - uvec2(view.left, view.top);
    vec4 behind = vec4(0.0), before = vec4(0.0);
    look_at(at);
    if (!ALL_SHARP && !NO_FAR && (!(BOTH || WIDE) || has(VIRGA_LENS_HAS_FINE)))
        behind = textureLod(far_field, BOTH ? clamp(sampled, far_limits.xy, far_limits.zw) : sampled, 0.0);
    if (!ALL_SHARP && !NO_NEAR && (!FOR_GPU || has(VIRGA_LENS_HAS_NEAR))) // software has a list of such tiles
        before = near_field();
    if (BOTH || WIDE) {
        vec2 circles = circles_of(before);
        if (has(VIRGA_LENS_HAS_COARSE))
            fields_of_both(behind, before, circles);
        behind.a = circles.x < 0.0 ? circles.x / circles.y : -2.0; // layers in focus are behind anything near
    }
    composed sum = begin_seen(behind, before);
    if (LAYERS == 1u)
        put(0u, sum);
    if (LAYERS > 1u)
        for (uint layer = 0u; layer < view.layers; layer++)
            put(layer, sum);
    color = end_pixel(sum);
}
