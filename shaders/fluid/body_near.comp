// body_near.comp - after the last substep: the nearest body to each particle, for the foam of the water effect.
// It is written over the touches, which only a substep needs.
// One invocation per slot. Reads: particles, bodies, maps. Writes: touches.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define TOUCHES_ACCESS writeonly
#include "fluid.glsl"
#include "bodies.glsl"
#include "kernel.glsl"
#include "shared/body_near.h"

layout(local_size_x = VIRGA_FLUID_LANES) in;

#define NONE_M 1e9

virga_body_near_gpu nearest_body(vec3 p)
{
    virga_body_near_gpu found = virga_body_near_gpu(float[3](0.0, 0.0, 0.0), NONE_M, float[3](0.0, 0.0, 0.0), 0.0);
    for (uint body = 0u; body < frame.bodies; body++) {
        const Near near = near_body(body, p);
        const float distance = frame.spacing_m * near.distance, of_plane = plane_density(near.distance);
        if (near.density <= 0.0 || of_plane <= 0.0 || distance >= found.distance_m)
            continue;
        const vec3 velocity = body_velocity(body, p);
        found.normal = float[3](near.normal.x, near.normal.y, near.normal.z);
        found.velocity = float[3](velocity.x, velocity.y, velocity.z);
        found.distance_m = distance;
        found.share = min(near.density / of_plane, 1.0);
    }
    return found;
}

void main()
{
    const uint slot = gl_GlobalInvocationID.x;
    if (slot >= frame.particles)
        return;
    const virga_body_near_gpu near = nearest_body(to_vec(particles[slot].position));
    touches[2u * slot] = floatBitsToUint(vec4(near.normal[0], near.normal[1], near.normal[2], near.distance_m));
    touches[2u * slot + 1u] = floatBitsToUint(vec4(near.velocity[0], near.velocity[1], near.velocity[2], near.share));
}
