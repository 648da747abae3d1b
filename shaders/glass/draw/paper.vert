// paper.vert - vertices of the tiles that show water in the paper's style.
// One invocation per vertex of a tile's quad. Reads: quads, nodes, the view. Writes: position, directions on the
// picture.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "corner.glsl"
#include "corner_tile.glsl"
#include "paper.glsl"

layout(location = 2) out vec4 pane_directions;

#include "gpu/own_view.glsl"

void main()
{
    const Corner corner = emit_tile_corner(uint(gl_VertexIndex));
    pane_directions = directions_on_picture(corner.along_u, corner.along_v);
}
