// height.comp - the height map, balls handed around in shared memory: what GPUs run.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define LANES 64
#include "height.glsl"

void main() { gather(); }
