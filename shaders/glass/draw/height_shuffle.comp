// height_shuffle.comp - the height map with balls passed on by subgroup shuffles, for software Vulkan with more than
// eight lanes in a subgroup. The same bits as height.comp.
// One workgroup per tile, one invocation per texel. Reads and writes: see height.comp.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#define SHUFFLE
#define LANES 64
#include "height.glsl"

void main() { gather(); }
