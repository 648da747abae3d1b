// fall.comp - what fell in this tick gives its water back; what stays moves up into the other buffer, in its order. The buffer
// that it leaves is left without a living droplet.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#include "count.glsl"
#include "fall_buffers.glsl"
#include "returns.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;
layout(scalar, set = 0, binding = 12) writeonly buffer Staying { virga_droplet_gpu staying[]; };

void main()
{
    const uint place = gl_GlobalInvocationID.x;
    if (place >= state.end_droplet)
        return;
    const uvec4 word = marks[place / 32u];
    const uint bit = 1u << (place & 31u);
    if ((word.y & bit) == 0u)
        return;
    const uint room = state.returns - state.returns_before;
    const uint fallen = word.z + bitCount(word.x & (bit - 1u)), alive = word.w + bitCount(word.y & (bit - 1u));
    const virga_droplet_gpu droplet = droplets[place];
    droplets[place].kind = 0u;
    if ((word.x & bit) == 0u || fallen >= room) {
        staying[alive - min(fallen, room)] = droplet;
        return;
    }
    returns[state.returns_before + fallen] = make_return(to_vec(droplet.position), to_vec(droplet.velocity), droplet.diameter_m,
                                                         droplet.id, VIRGA_DROPLET_MATERIAL(droplet.kind), droplet.water_nl);
    count(VIRGA_SPLASH_RETURNED, droplet.water_nl);
}
