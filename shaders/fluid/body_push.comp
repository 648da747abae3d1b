// body_push.comp - the velocity of a body that the pressures lead to: that without them, and the pushes of all
// particles that touch it. What push.comp is for particles.
// One workgroup per body. Reads: contacts, touches, sorted. Writes: bodies.
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
        const uint index = contact_of(body, n);
        const uvec4 touch = touch_texel(index);
        const vec4 place = place_at(index / VIRGA_FLUID_TOUCHES);
        const vec3 force = place.w * uintBitsToFloat(touch.xyz) + frame.spacing_m * body_carries(touch);
        own.force += force;
        own.torque += cross(frame.spacing_m * place.xyz - center, force);
    }
    const Push sum = sum_of_lanes(own);
    if (gl_LocalInvocationIndex != 0u || shapes.of[body].inv_mass == 0.0)
        return;
    const float each = state.dt_s * frame.inv_spacing_m;
    const vec3 velocity = to_vec(bodies[body].free_velocity) + each * shapes.of[body].inv_mass * sum.force;
    const vec3 spin =
        to_vec(bodies[body].free_spin) + each * times(shapes.of[body].inv_inertia, rotation_of(body), sum.torque);
    for (uint axis = 0u; axis < 3u; axis++) {
        bodies[body].velocity[axis] = velocity[axis];
        bodies[body].spin[axis] = spin[axis];
    }
}
