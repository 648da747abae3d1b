// exchange_in.comp - water that the ground's cells gave becomes particles, in the free ones of the first slots. The
// i-th entry gets the i-th free slot.
// One workgroup, in which each invocation takes a run of slots. Reads: entries. Writes: particles, slot_pressures,
// exchange.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "exchange.glsl"
#include "shared/random.h"
#include "gpu/group_scan.glsl"

layout(local_size_x = SCAN_LANES) in;

#define JITTER 0.1 // spacings: two particles at the same position would not push each other apart

void begin_particle(uint slot, uint i)
{
    const uint id = frame.max_particles + exchange.begun + i;
    virga_particle_gpu particle;
    for (uint axis = 0u; axis < 3u; axis++) {
        const float moved = JITTER * frame.spacing_m * (virga_unit(virga_hash2(id, axis)) - 0.5);
        particle.position[axis] = clamp(entries[i].position[axis] + moved, frame.low_m[axis], frame.high_m[axis]);
        particle.velocity[axis] = 0.0;
    }
    particle.share = 1.0;
    particle.id = id;
    particles[slot] = particle;
    slot_pressures[slot] = vec2(0.0);
    begin_rest(slot);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, run = (frame.exchanged + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, frame.exchanged), end = min(begin + run, frame.exchanged);
    uint free_slots = 0u;
    for (uint slot = begin; slot < end; slot++)
        free_slots += is_free(slot) ? 1u : 0u;
    uvec2 all;
    uint next = scan_group(uvec2(free_slots, 0u), all).x;
    const uint count = min(exchange.taken, all.x); // ground knows how many slots are free
    for (uint slot = begin; slot < end && next < count; slot++)
        if (is_free(slot))
            begin_particle(slot, next++);
    barrier();
    if (lane != 0u)
        return;
    add_water(exchange.taken_nl, count);
    exchange.begun += count;
    exchange.taken = 0u;
}
