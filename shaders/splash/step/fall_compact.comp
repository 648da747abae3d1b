// fall_compact.comp - compaction of droplets, where they are many: moves those that fell and those that are alive.
// One invocation per droplet. Reads: droplets, marks. Writes: droplets, returns.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#include "counters.glsl"
#include "fall_buffers.glsl"
#include "returns.glsl"
#include "fall_compact.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

void main()
{
    const uint slot = gl_GlobalInvocationID.x;
    if (slot < state.end_droplet)
        compact_droplet(slot, droplet_of(slot), state.returns_before, state.returns - state.returns_before);
}
