// crown_pyramid.vert - corners of the pyramids of crowns.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_ACCESS readonly
#define COMPACT_ACCESS readonly
#define CROWNS
#include "pyramid.glsl"
