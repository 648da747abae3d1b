// advance.comp - moves the particles with their new velocities, and keeps them in the box and out of bodies.
// The pressure for the host is that which acts between the particles (the virial of their forces), a mean over each of
// them and its neighbours:
//
//     P_i = 1/3 (sum_j (p_i + p_j) / 2 V |x_ij . grad W| + p_i (the walls' part of this sum)).
//
// The host sees that of the last substep only.
//
// One invocation per sorted particle. Reads: moved, sorted, lists, solved, bodies, maps. Writes: particles,
// slot_pressures, touches, state.max_speed2.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define FLUID_ACCESS
#define STATE_ACCESS
#define PARTICLES_ACCESS
#define TOUCHES_ACCESS
#include "fluid.glsl"
#include "bodies.glsl"
#include "kernel.glsl"
#include "pairs.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

#define FOREVER      1e30 // s
#define FILM_DENSITY 0.6 // without the floor's part, of which an even sheet of particles has 0.7
#define SIDES        0.75 // spacings from an open side at which a particle has left. Water at rest keeps half of one.

shared uint group_speed2;

vec4 own;
float sum;

void pair(uint first)
{
    const vec4 other = place_at(pair_index(first));
    const vec3 apart = own.xyz - other.xyz;
    const float r2 = dot(apart, apart);
    sum -= (own.w + other.w) * slope(r2) * r2;
}

float mean_pressure(uint i, float word)
{
    own = place_at(i);
    sum = 0.0;
    const uint texels = state.time_left_s > 0.0 ? 0u : solved_texels(word);
    for (uint t = 0u, at = i; t < texels; t++, at += frame.stride) {
        const uvec4 four = list_texel(at);
        pair(four.x);
        pair(four.y);
        pair(four.z);
        pair(four.w);
    }
    return (0.5 * KERNEL_FACTOR * sum + own.w * solved_wall_pull(word)) / 3.0;
}

// A particle that came into a body is put back to its surface, and loses the velocity into it. The body gets that.
void leave_body(uint touch, inout vec3 p, inout vec3 velocity)
{
    const uint body = touch_body(touches[touch]);
    if (body == NO_BODY)
        return;
    vec3 given = vec3(0.0);
    const Near near = near_body(body, p);
    if (near.distance < 0.0) {
        p -= frame.spacing_m * near.distance * near.normal;
        given = min(dot(velocity - body_velocity(body, p), near.normal), 0.0) * near.normal;
        velocity -= given;
    }
    touches[touch].xyz = floatBitsToUint(given);
}

// For how long a particle has been at rest (s): behind the pressures. FOREVER: it leaves the box. Particles come to
// rest near the floor, and not in the region in which water is taken from the ground.
void note_rest(uint i, uint slot, vec3 p, float speed2)
{
    const vec2 low = vec2(frame.region_low_m[0], frame.region_low_m[1]);
    const vec2 high = vec2(frame.region_high_m[0], frame.region_high_m[1]);
    const bool outside = any(lessThan(p.xz, low)) || any(greaterThanEqual(p.xz, high));
    const vec3 from_low = p - to_vec(frame.low_m), from_high = to_vec(frame.high_m) - p;
    const vec2 nearest = min(min(from_low.xz, from_high.xz), from_high.yy);
    const bool leaves = frame.open_sides != 0u && min(nearest.x, nearest.y) < SIDES * frame.spacing_m;
    const float around = velocities[i].w - wall(max(from_low.y, 0.0) * frame.inv_spacing_m).x; // density without floor
    const bool is_film = around < FILM_DENSITY && from_low.y < frame.spacing_m;
    const bool is_slow = p.y < frame.rest_top_m && speed2 < (is_film ? frame.film_speed2 : frame.rest_speed2);
    const uint at = frame.max_particles + slot;
    const float rest = is_slow ? slot_pressures[at].x + state.dt_s : 0.0;
    slot_pressures[at].x = outside ? leaves ? FOREVER : rest : 0.0;
}

// Returns the square of the particle's speed.
float advance(uint i, vec3 velocity)
{
    const uint slot = sorted_indices[i];
    vec3 free = to_vec(particles[slot].position) + state.dt_s * velocity;
    if (WITH_BODIES)
        for (uint k = 0u; k < VIRGA_FLUID_TOUCHES; k++)
            leave_body(VIRGA_FLUID_TOUCHES * i + k, free, velocity);
    const vec3 p = clamp(free, to_vec(frame.low_m), to_vec(frame.high_m));
    velocity = mix(velocity, vec3(0.0), notEqual(free, p));
    for (uint axis = 0u; axis < 3u; axis++) {
        particles[slot].position[axis] = p[axis];
        particles[slot].velocity[axis] = velocity[axis];
    }
    if (WITH_EXCHANGE)
        note_rest(i, slot, p, dot(velocity, velocity));
    return dot(velocity, velocity);
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (gl_LocalInvocationIndex == 0u)
        group_speed2 = 0u;
    barrier();
    if (i < grid.sorted) {
        const vec2 own_solved = solved[i];
        slot_pressures[sorted_indices[i]] = vec2(mean_pressure(i, own_solved.y), own_solved.x);
        atomicMax(group_speed2, floatBitsToUint(advance(i, moved_at(i).xyz)));
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        atomicMax(state.max_speed2, group_speed2);
}
