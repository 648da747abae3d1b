// paper.vert - corners of the tiles that have water to show in the paper's style.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "corner.glsl"
#include "corner_tile.glsl"
#include "paper.glsl"

layout(location = 2) out vec4 pane_ways;

void main()
{
    const Corner corner = place_tile_corner(uint(gl_VertexIndex));
    pane_ways = ways_on_picture(corner.along_u, corner.along_v);
}
