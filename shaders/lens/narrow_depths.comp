// narrow_depths.comp - (half resolution, on GPUs) a layer of which each pixel has a depth, out of focus, in one pass:
// see narrow_layer.glsl.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define LAYER_DEPTHS
#include "narrow_layer.glsl"
