// alive.comp - counts the splashes that are live at the end of a step: in the ring there are also those that have not
// begun, and those that are over but behind older ones.
// One invocation per splash. Reads: splashes. Writes: state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

shared uint live;

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        live = 0u;
    barrier();
    const uint slot = ring_slot(state.first_splash, state.end_splash, tick.max_splashes, gl_GlobalInvocationID.x);
    if (slot != NO_SLOT) {
        const virga_splash_gpu splash = splash_of(slot);
        const float age = (float(tick.tick - splash.tick) + 1.0 - splash.share) * tick.tick_s;
        if (age > 0.0 && age <= splash.life_s)
            atomicAdd(live, 1u);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && live > 0u)
        atomicAdd(state.alive, live);
}
