// check.comp - ends the iterations when the mean error is small.
// One invocation. Reads and writes: state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_ACCESS
#include "fluid.glsl"

layout(local_size_x = 1) in;

// The first iterations find out what is wrong near each particle, not yet what that means for those far from it: a
// small error does not say much then.
#define MIN_ITERATIONS 4u

void main()
{
    const float one = VIRGA_FLUID_ERROR_ONE / float(1u << VIRGA_FLUID_ERROR_SHIFT);
    const float error = float(state.error) / (one * float(max(grid.sorted, 1u)));
    state.error = 0u;
    state.iteration++;
    state.iterations++;
    state.solver_error = error;
    if (state.iteration >= MIN_ITERATIONS && error <= frame.solver_error)
        state.loop_groups = state.loop_one_group = state.loop_body_groups = uint[3](0u, 1u, 1u);
}
