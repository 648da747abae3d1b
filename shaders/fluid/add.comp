// add.comp - adds particles: a block on a lattice, or those of a host's buffer.
// One invocation per added particle. Reads: added. Writes: particles, slot_pressures, state.max_speed2.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/fluid_gpu.h"
#include "shared/particle.h"
#include "gpu/vectors.glsl"

layout(scalar, set = 0, binding = 0) uniform Add { virga_fluid_add_gpu block; };
layout(scalar, set = 0, binding = 1) buffer State { virga_fluid_state_gpu state; };
layout(scalar, set = 0, binding = 2) writeonly buffer Particles { virga_particle_gpu particles[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Added { virga_particle_gpu added[]; };
layout(std430, set = 0, binding = 4) writeonly buffer SlotPressures { vec2 slot_pressures[]; };

layout(local_size_x = VIRGA_FLUID_LANES) in;

virga_particle_gpu lattice_particle(uint i)
{
    const uvec3 at = uvec3(i % block.counts[0], i / block.counts[0] % block.counts[1],
                           i / (block.counts[0] * block.counts[1]));
    virga_particle_gpu particle;
    for (uint axis = 0u; axis < 3u; axis++)
        particle.position[axis] = block.low_m[axis] + block.spacing_m * float(at[axis]);
    particle.velocity = block.velocity_m_s;
    return particle;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= block.count)
        return;
    virga_particle_gpu particle;
    if (block.counts[0] == 0u)
        particle = added[i];
    else
        particle = lattice_particle(i);
    const vec3 velocity = to_vec(particle.velocity);
    const bool slow = all(lessThan(abs(velocity), vec3(1e3))); // false for NaN
    if (!slow)
        particle.velocity = float[3](0.0, 0.0, 0.0);
    particle.share = all(lessThan(abs(to_vec(particle.position)), vec3(1e9))) ? 1.0 : 0.0;
    particle.id = block.first_id + i;
    particles[block.first_slot + i] = particle;
    slot_pressures[block.first_slot + i] = vec2(0.0);
    atomicMax(state.max_speed2, floatBitsToUint(slow ? dot(velocity, velocity) : 0.0));
}
