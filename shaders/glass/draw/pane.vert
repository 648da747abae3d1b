// pane.vert - corners of the tiles that have water to show.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/light.glsl"
#include "corner.glsl"
#include "corner_tile.glsl"
#include "corner_light.glsl"

void main() { light_corner(place_tile_corner(uint(gl_VertexIndex))); }
