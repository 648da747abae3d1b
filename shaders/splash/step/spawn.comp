// spawn.comp - starts this tick's splashes, where they are many.
// One invocation per spawn. Reads: spawns, ranks. Writes: splashes, droplets, returns.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#include "counters.glsl"
#include "flight.glsl"
#include "spawn.glsl"
#include "splash/shape.glsl"
#include "returns.glsl"
#include "spawn_start.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= spawn_count() || spawns[index].tick != tick.tick)
        return;
    start_splash(
        spawns[index], spawn_ranks[index],
        Starts(state.tick_splash, state.tick_droplet, state.returns_before, state.first_splash, state.full_from));
}
