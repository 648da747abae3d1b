// picture_pane.vert - corners of the tiles that have water to show.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "gpu/light.glsl"
#include "picture_corner.glsl"

void main()
{
    const uint columns = look.tile_columns + 1u, number = uint(gl_VertexIndex);
    place_corner(vec2(number % columns, number / columns) / vec2(look.tile_columns, look.tile_rows));
}
