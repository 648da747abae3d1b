// fly.comp - a tick of all droplets, where they are many.
// One invocation per droplet. Reads: droplets. Writes: droplets, marks.
// Paper: Mizukami et al., equations 1 to 7, sections 4.1 and 4.2.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#include "flight.glsl"
#include "fall_buffers.glsl"
#define STEP_WORDS (VIRGA_SPLASH_GROUP / 32)
#include "fly.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

void main()
{
    const uint lane = gl_LocalInvocationIndex, slot = gl_GlobalInvocationID.x;
    clear_bits(lane);
    barrier();
    if (slot < state.end_droplet) {
        const virga_droplet_gpu droplet = droplet_of(slot);
        if ((droplet.kind & VIRGA_DROPLET_ALIVE) != 0u)
            step_droplet(slot, droplet, lane);
    }
    barrier();
    if (lane < STEP_WORDS)
        marks[gl_WorkGroupID.x * STEP_WORDS + lane] = uvec4(fallen_bits[lane], alive_bits[lane], 0u, 0u);
}
