// correct_shuffle.comp - one iteration of the solver, see correct.glsl: for software Vulkan with subgroups of eight
// lanes, or a multiple. There the atomic of a subgroup is one of each lane in turn, of 18 cycles. The same bits as
// correct.comp.
// One invocation per sorted particle. Reads and writes: see correct.glsl.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "correct.glsl"
#include "unit.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

void add_error(uint error)
{
    const uint sum = unit_sum(error);
    if (unit_lane() == 0u)
        atomicAdd(group_error, sum);
}

void main() { iterate(); }
