// body_hit.comp - single particles have no pressure; those that a body's surface stopped in advance.comp give it their
// momentum here.
// One workgroup per body. Reads: contacts, touches, sorted_indices, particles. Writes: bodies.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define BODIES_ACCESS
#include "fluid.glsl"
#include "bodies.glsl"
#include "body_sums.glsl"

void main()
{
    const uint body = gl_WorkGroupID.x, count = contact_count(body);
    const vec3 center = to_vec(bodies[body].center);
    Push own = Push(vec3(0.0), vec3(0.0));
    for (uint n = gl_LocalInvocationIndex; n < count; n += VIRGA_FLUID_LANES) {
        const uint touch = contact_of(body, n), slot = sorted_indices[touch / VIRGA_FLUID_TOUCHES];
        const vec3 given = uintBitsToFloat(touch_texel(touch)).xyz;
        own.force += given;
        own.torque += cross(to_vec(particles[slot].position) - center, given);
    }
    const Push sum = sum_of_lanes(own);
    if (gl_LocalInvocationIndex != 0u || shapes.of[body].inv_mass == 0.0)
        return;
    const vec3 velocity = shapes.of[body].inv_mass * sum.force;
    const vec3 spin = times(shapes.of[body].inv_inertia, rotation_of(body), sum.torque);
    for (uint axis = 0u; axis < 3u; axis++) {
        bodies[body].velocity[axis] += velocity[axis];
        bodies[body].spin[axis] += spin[axis];
    }
}
