// begin.comp - begins the spray of a step: finds the half that this step writes, which is the one that an older step
// has written, and empties its half of the table. The device decides, not the host: a frame that the host has thrown
// away has not written its half.
// One invocation per entry of the table. Writes: state, table.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint half_now = state.splash_serials[0] > state.splash_serials[1] ? 1u : 0u;
    const uint entry = gl_GlobalInvocationID.x;
    if (entry <= frame.splash_mask)
        table[half_now * (frame.splash_mask + 1u) + entry] = 0u;
    if (entry == 0u)
        state.splash_half = half_now;
}
