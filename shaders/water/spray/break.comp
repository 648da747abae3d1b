// break.comp - splash particles break into droplets: how many, by the largest speed that the particle has reached since
// it left the water (section 4.1 of Iwasaki et al. 2006). A faster one breaks into more.
// One invocation per splash particle. Reads: the list, particles, the last frame's splashes. Writes: splashes, table.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#include "list.glsl"
#include "table.glsl"
#include "enter.glsl"
#include "leaver.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint splash = gl_GlobalInvocationID.x;
    if (splash >= splash_list.count)
        return;
    const uint particle = splash_particle(splash), before = find_before(particles[particle].id);
    const float part = spray_part(densities[particle]);
    const vec3 velocity = particle_velocity(particle);
    virga_leaver_gpu own = begin_leaver(particle, before);
    if (!is_done(own, part)) {
        own.max_speed = max(own.max_speed, length(velocity));
        own.pieces = 1u + uint(float(frame.max_pieces - 1u) * min(own.max_speed * frame.inv_full_speed, 1.0));
        decide_to_leave(own, part, before);
    }
    own.velocity = float[3](velocity.x, velocity.y, velocity.z);
    splashes[splash_now(splash)] = own;
    enter(splash, own.id);
}
