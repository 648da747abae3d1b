// picture_pane.vert - corners of the tiles that have water to show.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "gpu/light.glsl"
#include "picture_corner.glsl"
#include "picture_corner_tile.glsl"
#include "picture_corner_light.glsl"

void main() { light_corner(place_tile_corner(uint(gl_VertexIndex))); }
