// narrow.comp - (half resolution, on GPUs) discs of up to VIRGA_LENS_FINE texels in one pass, see narrow.glsl.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "narrow.glsl"
