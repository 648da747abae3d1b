// relief_narrow.comp - what the draws read of the height map, for software Vulkan with eight lanes to a
// subgroup: a lane for each column of a tile. The same bits.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#define LANES 8
#include "relief.glsl"

void main() { relief(); }
