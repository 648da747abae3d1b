// narrow_plane.comp - (half resolution, on GPUs) a layer that is all at one depth, out of focus, in one pass:
// see narrow_layer.glsl.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "narrow_layer.glsl"
