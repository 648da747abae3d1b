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

#define BENEATH
#include "compose.glsl"
#include "stack.glsl"

layout(location = 0) flat in uint beside; // the kind of the tile: bits, VIRGA_LENS_HAS_...
layout(location = 1) flat in vec4 near_limits; // texture coordinates within which there are near fields
layout(location = 2) flat in vec4 far_limits;  // (BOTH) and far ones
layout(set = 0, binding = 32) uniform sampler2D far_field; // the first image of fields
layout(set = 0, binding = 34) uniform sampler2D coarse_near;
layout(set = 0, binding = 35) uniform sampler2D coarse_far;
layout(location = 0) out vec4 color;

bool has(uint bit) { return (beside & bit) != 0u; }

// Both fields of the tile, coarse where discs are wide. What is near in one of them and in the other adds up to what
// is near here. Wide discs are nearer, so where that would be more than all there is, they hide the others.
void fields_of_both(uvec2 at, inout vec4 behind, inout vec4 before)
{
    const vec2 texel = min(0.25 * vec2(at) + 0.125, vec2((uvec2(view.columns, view.rows) + 1u) >> 1u) - 0.5);
    const vec2 place = texel / vec2(textureSize(coarse_far, 0));
    const vec3 coarse = textureLod(coarse_far, place, 0.0).rgb;
    if (has(VIRGA_LENS_HAS_COARSE_NEAR)) {
        const vec4 coarse_before = textureLod(coarse_near, place, 0.0);
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

void main()
{
    const uvec2 at = uvec2(gl_FragCoord.xy) - uvec2(view.left, view.top);
    vec4 behind = vec4(0.0), before = vec4(0.0);
    look_at(at);
    if (!ALL_SHARP && !NO_FAR && (!(BOTH || WIDE) || has(VIRGA_LENS_HAS_FINE)))
        behind = textureLod(far_field, BOTH ? clamp(sampled, far_limits.xy, far_limits.zw) : sampled, 0.0);
    if (!ALL_SHARP && !NO_NEAR && (!FOR_GPU || has(VIRGA_LENS_HAS_NEAR))) // software has a list of such tiles
        before = near_field();
    if ((BOTH || WIDE) && has(VIRGA_LENS_HAS_COARSE))
        fields_of_both(at, behind, before);
    if (BOTH || WIDE) // layers are in focus here: what is near is in front of them
        behind.a = -2.0;
    composed sum = begin_seen(behind, before);
    if (LAYERS == 1u)
        put(0u, sum);
    if (LAYERS > 1u)
        for (uint layer = 0u; layer < view.layers; layer++)
            put(layer, sum);
    color = end_pixel(sum);
}
