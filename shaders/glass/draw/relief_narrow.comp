// relief_narrow.comp - the relief map, for software Vulkan with eight lanes in a subgroup. The same bits as
// relief.comp.
// One workgroup per tile, one invocation per column. Reads: the height map. Writes: the relief map.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#define LANES 8
#include "relief.glsl"

void main() { relief(); }
