// height_shuffle.comp - the height map, balls handed around by shuffles, for software Vulkan with more lanes
// to a subgroup than eight. The same bits.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#define SHUFFLE
#define LANES 64
#include "height.glsl"

void main() { gather(); }
