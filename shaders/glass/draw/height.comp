// height.comp - the height map, with balls passed on through shared memory: the variant for GPUs. See height.glsl.
// One workgroup per tile, one invocation per texel. Reads: balls, entries, film. Writes: the height map, tile bits.
// Paper: Goto et al. 2009, section 4.7; Chen and Zhang, equations 2 to 8.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define LANES 64
#include "height.glsl"

void main() { gather(); }
