// relief.comp - what the draws read of the height map, a lane for each texel of a tile.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define LANES 64
#include "relief.glsl"

void main() { relief(); }
