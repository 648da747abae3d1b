// mist.frag - film on cells that is too fine for the height map. Each bead is a lens that shows all of the world in
// front of the pane, so only its coverage is known. Drawn under the drops; premultiplied.
// One invocation per pixel of a block with mist. Reads: the mist map. Writes: radiance.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "surface.glsl"
#include "gpu/encode.glsl"

layout(set = 0, binding = 21) uniform sampler2D mist_map;

layout(location = 14) flat in vec4 mist_grid;
layout(location = 0) out vec4 radiance;

void main()
{
    // Only whole texels: those beyond are left over from another view.
    const vec2 last = (mist_grid.xy - 0.5) / vec2(textureSize(mist_map, 0));
    const float coverage = textureLod(mist_map, min(pane_position * mist_grid.zw, last), 0.0).r;
    if (coverage <= 0.0 || is_behind_scene())
        discard;
    if (SIDE == VIRGA_GLASS_DRAW_OPAQUE && dot(position, cross(along_u, along_v)) > 0.0)
        discard; // the back of a surface that is not glass
    radiance = for_target(vec4(coverage * mist_light, coverage));
}
