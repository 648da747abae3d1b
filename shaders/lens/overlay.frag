// overlay.frag - (half resolution, in place) what is out of focus, and the layers, to be blended over a target that
// holds what is in focus.
//
// The far field, the near field and the layers lie over each other by premultiplied "over", which is linear in the
// sharp color at the bottom. So blending can put it there: it does not have to be read here, and where nothing is out
// of focus nothing has to be written. One list of tiles after the other; without layers those in focus are not drawn.
// In tiles of which nothing at all is in focus there is nothing to blend over: they overwrite the target.
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
const bool SOFT = KIND == VIRGA_LENS_TILES_SOFT;

#define BENEATH
#include "compose.glsl"
#include "stack.glsl"

layout(location = 0) flat in uint has_near; // of the tile
layout(set = 0, binding = 32) uniform sampler2D far_field; // the first image of fields
layout(location = 0) out vec4 color;

void main()
{
    const uvec2 at = uvec2(gl_FragCoord.xy) - uvec2(view.left, view.top);
    vec4 behind = vec4(0.0), before = vec4(0.0);
    look_at(at);
    if (!ALL_SHARP && !NO_FAR)
        behind = textureLod(far_field, sampled, 0.0);
    if (!ALL_SHARP && !NO_NEAR && (!FOR_GPU || has_near != 0u)) // software has a list of such tiles
        before = field(VIRGA_LENS_NEAR);
    composed sum = begin_pixel(at, behind, before);
    if (LAYERS == 1u)
        put(0u, sum);
    if (LAYERS > 1u)
        for (uint layer = 0u; layer < view.layers; layer++)
            put(layer, sum);
    color = end_pixel(sum);
}
