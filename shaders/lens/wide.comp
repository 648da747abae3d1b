// wide.comp - (in place, on GPUs) discs of up to VIRGA_LENS_COARSE_MOST px: wide ones at a quarter of the resolution,
// the others at half of it, see narrow.glsl.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define WIDE_PASS
#include "narrow.glsl"
