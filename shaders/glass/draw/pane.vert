// pane.vert - vertices of the tiles that show water.
// One invocation per vertex of a tile's quad. Reads: quads, nodes, the view. Writes: position, directions, light.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/light.glsl"
#include "corner.glsl"
#include "corner_tile.glsl"
#include "corner_light.glsl"

#include "gpu/own_view.glsl"

void main() { light_corner(emit_tile_corner(uint(gl_VertexIndex))); }
