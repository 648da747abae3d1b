// copy.comp - copies particles into the sorted lists, with positions in spacings.
// One invocation per sorted particle. Reads: sorted_indices, particles, slot_pressures. Writes: sorted, moved, solved.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#define FLUID_ACCESS
#define STATE_ACCESS
#include "fluid.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i == 0u) {
        state.fluid_groups = state.loop_groups = grid.sorted_groups;
        state.loop_body_groups = state.body_groups;
        state.error = state.iteration = state.groups_done = 0u;
        state.moved = grid.sorted;
    }
    if (i >= grid.sorted)
        return;
    const uint slot = sorted_indices[i];
    const vec3 p = to_vec(particles[slot].position) * frame.inv_spacing_m;
    const float pressure = slot_pressures[slot].y;
    sorted[i] = vec4(p, pressure);
    moved[i] = vec4(to_vec(particles[slot].velocity), 0.0);
    solved[i] = vec2(pressure, 0.0);
}
