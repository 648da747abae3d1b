// body_move.comp - moves bodies with their new velocities. The walls of the box stop them, without a bounce and with
// Coulomb's friction.
//
// A turning body keeps its angular momentum I w, not its angular velocity. Each of its outermost points that is behind
// a wall and moves on gets the impulse that stops it (Guendelman et al. 2003, Nonconvex Rigid Bodies with Stacking,
// section 5), one after the other, some times over.
//
// One workgroup per body. Reads: maps (points). Writes: bodies, state.max_speed2.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_ACCESS
#define BODIES_ACCESS
#include "fluid.glsl"
#include "bodies.glsl"

layout(local_size_x = 1) in;

#define ROUNDS 8

uint body;
vec4 rotation;
vec3 center, velocity, spin;

// The velocity that an impulse of 1 (times the mass of a particle) at a point gives to this point.
vec3 answer(vec3 arm, vec3 impulse)
{
    return shapes.of[body].inv_mass * impulse +
           cross(times(shapes.of[body].inv_inertia, rotation, cross(arm, impulse)), arm);
}

void hit(vec3 arm, vec3 impulse)
{
    velocity += shapes.of[body].inv_mass * impulse;
    spin += times(shapes.of[body].inv_inertia, rotation, cross(arm, impulse));
}

// A point that is `deep` behind a wall with this normal (m).
void stop(vec3 arm, vec3 normal, float deep)
{
    const vec3 at = velocity + cross(spin, arm);
    const float along = dot(at, normal);
    if (deep < 0.0 || along >= 0.0)
        return;
    const float impulse = -along / dot(answer(arm, normal), normal);
    hit(arm, impulse * normal);
    const vec3 sliding = velocity + cross(spin, arm), slip = sliding - dot(sliding, normal) * normal;
    const float speed = length(slip);
    if (speed < 1e-6)
        return;
    const vec3 way = slip / speed;
    hit(arm, -min(speed / dot(answer(arm, way), way), shapes.of[body].friction * impulse) * way);
}

vec3 point_arm(uint index)
{
    return turn(rotation, uintBitsToFloat(map_texel(shapes.of[body].first_point + index)).xyz);
}

// How deep a point is behind the low walls, and behind the high ones (m).
vec3 deep_low(vec3 arm) { return to_vec(frame.low_m) - center - arm; }
vec3 deep_high(vec3 arm) { return center + arm - to_vec(frame.high_m); }

void meet_walls()
{
    vec3 low = vec3(0.0), high = vec3(0.0);
    for (uint n = 0u; n < shapes.of[body].points; n++) {
        low = max(low, deep_low(point_arm(n)));
        high = max(high, deep_high(point_arm(n)));
    }
    if (low == vec3(0.0) && high == vec3(0.0))
        return;
    center += low - high;
    for (uint round = 0u; round < ROUNDS; round++)
        for (uint n = 0u; n < shapes.of[body].points; n++) {
            const vec3 arm = point_arm(n), below = deep_low(arm), above = deep_high(arm);
            // Points that rest at a wall are at it, give or take a little.
            const float near = 0.01 * frame.spacing_m;
            for (uint axis = 0u; axis < 3u; axis++) {
                vec3 normal = vec3(0.0);
                normal[axis] = 1.0;
                stop(arm, normal, below[axis] + near);
                stop(arm, -normal, above[axis] + near);
            }
        }
}

void main()
{
    body = gl_WorkGroupID.x;
    rotation = rotation_of(body);
    center = to_vec(bodies[body].center);
    velocity = to_vec(bodies[body].velocity);
    spin = to_vec(bodies[body].spin);
    const bool is_free = shapes.of[body].inv_mass > 0.0;
    const vec3 momentum = times(shapes.of[body].inertia, rotation, spin);
    center += state.dt_s * velocity;
    rotation = turned_by(rotation, state.dt_s * spin);
    if (is_free) {
        spin = times(shapes.of[body].inv_inertia, rotation, momentum);
        meet_walls();
    }
    const vec3 origin = center - turn(rotation, to_vec(shapes.of[body].center));
    for (uint axis = 0u; axis < 3u; axis++) {
        bodies[body].center[axis] = center[axis];
        bodies[body].origin[axis] = origin[axis];
        bodies[body].velocity[axis] = velocity[axis];
        bodies[body].spin[axis] = spin[axis];
    }
    for (uint k = 0u; k < 4u; k++)
        bodies[body].rotation[k] = rotation[k];
    const float speed = length(velocity) + length(spin) * shapes.of[body].radius_m;
    atomicMax(state.max_speed2, floatBitsToUint(speed * speed));
}
