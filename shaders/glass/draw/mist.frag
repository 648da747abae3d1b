// mist.frag - film on cells that is too fine for the height map: each bead a lens that shows all of the world
// before the pane, so all that is known of it is how much it covers. Under the drops; premultiplied.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "surface.glsl"

layout(set = 0, binding = 21) uniform sampler2D mist_map;

layout(location = 14) flat in vec4 mist_grid;
layout(location = 0) out vec4 radiance;

void main()
{
    // Whole texels only: beyond those in use others are left from another view.
    const vec2 last = (mist_grid.xy - 0.5) / vec2(textureSize(mist_map, 0));
    const float share = textureLod(mist_map, min(place * mist_grid.zw, last), 0.0).r;
    if (share <= 0.0 || behind_scene())
        discard;
    if (SIDE == VIRGA_GLASS_DRAW_OPAQUE && dot(position, cross(along_u, along_v)) > 0.0)
        discard; // the back of what is not glass
    radiance = vec4(share * mist_light, share);
}
