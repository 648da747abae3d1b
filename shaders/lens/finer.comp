// finer.comp - (in place, on GPUs) what is not wide, after coarse.comp, see narrow.glsl.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define FINER_PASS
#include "narrow.glsl"
