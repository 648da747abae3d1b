// relief.comp - the relief map. See relief.glsl.
// One workgroup per tile, one invocation per texel. Reads: the height map. Writes: the relief map.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define LANES 64
#include "relief.glsl"

void main() { relief(); }
