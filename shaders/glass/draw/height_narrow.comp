// height_narrow.comp - the height map, for software Vulkan with few lanes to a subgroup: a lane for each column
// of a tile. The same bits.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#define SHUFFLE
#define LANES 8
#include "height.glsl"

void main() { gather(); }
