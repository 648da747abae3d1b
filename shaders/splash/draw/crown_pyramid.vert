// crown_pyramid.vert - vertices of the pyramids of crowns, in the paper's style.
// One invocation per vertex. Reads: the list of sheets, splashes. Writes: position, coverage.
// Paper: Mizukami et al., figures 4 and 5.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_ACCESS readonly
#define COMPACT_ACCESS readonly
#define CROWNS
#include "pyramid.glsl"
