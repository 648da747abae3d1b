// break.comp - splash particles break into droplets: how many, by the largest speed that the particle has reached since
// it left the water (section 4.1 of Iwasaki et al. 2006). A faster one breaks into more.
// One invocation per splash particle. Reads: the list, particles, the last frame's splashes. Writes: splashes, table,
// droplet_starts (counts).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#include "list.glsl"
#include "table.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint splash = gl_GlobalInvocationID.x;
    if (splash >= splash_list.count)
        return;
    const uint particle = splash_particle(splash), id = particles[particle].id, before = find_before(id);
    virga_water_splash_gpu own = virga_water_splash_gpu(id, 0.0, 0.0, 0u, float[3](0.0, 0.0, 0.0), 0u);
    if (before < frame.max_splashes)
        own = splashes[splash_before(before)];
    own.max_speed = max(own.max_speed, length(particle_velocity(particle)));
    own.pieces = 1u + uint(float(frame.max_pieces - 1u) * min(own.max_speed * frame.inv_full_speed, 1.0));
    splashes[splash_now(splash)] = own;
    droplet_starts[splash] = own.pieces;
    enter(splash, id);
}
