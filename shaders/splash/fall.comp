// fall.comp - what fell in this tick gives its water back and is gone.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#include "fall_buffers.glsl"
#include "returns.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

void main()
{
    // Over the places that step.comp went over: by its words, as the oldest may be another by now.
    const uint bits = marks[(gl_GlobalInvocationID.x + state.fall_start) / 32u & (tick.max_droplets / 32u - 1u)].x;
    const uint place = (state.fall_start + gl_GlobalInvocationID.x) & (tick.max_droplets - 1u);
    const uint bit = 1u << (place & 31u);
    if ((bits & bit) == 0u)
        return;
    const uint at = marks[place / 32u].z + bitCount(bits & (bit - 1u));
    if (at >= tick.max_returns)
        return; // it waits
    const virga_droplet_gpu droplet = droplets[place];
    returns[at] = make_return(to_vec(droplet.position), to_vec(droplet.velocity), droplet.diameter_m, droplet.id,
                              VIRGA_DROPLET_MATERIAL(droplet.kind), droplet.water_nl);
    count(VIRGA_SPLASH_RETURNED, droplet.water_nl);
    droplets[place].kind = 0u;
}
