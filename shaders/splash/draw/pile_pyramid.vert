// pile_pyramid.vert - vertices of the pyramids of piles and cones, in the paper's style.
// One invocation per vertex. Reads: the list of sprites, droplets. Writes: position, coverage.
// Paper: Mizukami et al., figures 4 and 5.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_ACCESS readonly
#define COMPACT_ACCESS readonly
#include "pyramid.glsl"
