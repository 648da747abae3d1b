// coarse.comp - (in place, on GPUs) wider discs, at a quarter of the resolution, see narrow.glsl.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define COARSE_PASS
#define FIELDS_BINDING 33
#include "narrow.glsl"
