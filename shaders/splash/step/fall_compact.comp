// fall_compact.comp - places the droplets that fell in this tick and those that stay, where they are many.
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
    const uint place = gl_GlobalInvocationID.x;
    if (place < state.end_droplet)
        place_droplet(place, droplet_of(place), state.returns_before, state.returns - state.returns_before);
}
