// correct.comp - one iteration of the solver: how far the velocities miss their aim, and the change of pressure that
// this asks for.
//
// The aim is that water does not become denser in the substep (the divergence-free solver of Bender and Koschier 2017,
// equation 8). A sum of small errors would make it denser in the end, so density above that at rest is also taken back,
// by a part BETA in each substep. Bender and Koschier take all of it back, in a second solver (equation 12). The
// velocity that does so stays with the water and makes it boil: a density of 0.1 % too much is 0.4 mm in 0.4 m of
// water, and that in a substep of 4 ms is 0.1 m/s.
//
// Where the density is lower than at rest, there is room, which may be filled. In the water there is always a little of
// it; it counts with its square, or the water would sink by filling it over and over.
//
// The step is that of Jacobi, relaxed, on pressures that never pull (Koschier et al. 2019, algorithm 2):
//
//     p_i = max(0, y_i + OMEGA error_i alpha_i / dt^2),
//
// from a point y ahead of the last pressures, y = p + k / (k + 3) (p - p_before), in iteration k (Nesterov's method,
// see Beck and Teboulle 2009, A Fast Iterative Shrinkage-Thresholding Algorithm). Without it pressure takes as many
// iterations as the square of the depth in particles to arrive at the floor; with it, as the depth.
//
// One invocation per sorted particle. Reads: sorted, moved, velocities, walls, lists, touches, bodies, solved. Writes:
// positions, solved, state.error.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define FLUID_ACCESS
#define STATE_ACCESS
#include "fluid.glsl"
#include "bodies.glsl"
#include "kernel.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

#define OMEGA 0.3
#define BETA  0.05
#define ROOM  0.2

shared uint group_error;

vec3 here, velocity;
float sum;

void pair(uint j)
{
    const vec3 apart = here - sorted_at(j).xyz;
    sum += slope(dot(apart, apart)) * dot(velocity - moved_at(j).xyz, apart);
}

// What the density grows by as bodies move towards the particle, over the same as below.
float approach(uint i)
{
    float approaching = 0.0;
    for (uint k = 0u; k < VIRGA_FLUID_TOUCHES; k++) {
        const uvec4 touch = touch_texel(VIRGA_FLUID_TOUCHES * i + k);
        if (touch.w != NO_BODY)
            approaching -= dot(body_velocity(touch_body(touch), frame.spacing_m * here), uintBitsToFloat(touch.xyz));
    }
    return approaching;
}

// What the density grows by in the substep.
float growth(uint i, uint texels, vec4 wall)
{
    sum = 0.0;
    for (uint t = 0u, at = i; t < texels; t++, at += frame.stride) {
        const uvec4 four = list_texel(at);
        pair(four.x);
        pair(four.y);
        pair(four.z);
        pair(four.w);
    }
    float walls = dot(velocity, wall.xyz);
    if (WITH_BODIES)
        walls += approach(i);
    return state.dt_s * frame.inv_spacing_m * (KERNEL_FACTOR * sum + walls);
}

// Improves the pressure of a particle, and returns its error.
float improve(uint i)
{
    const vec4 own = sorted_at(i), wall = uintBitsToFloat(wall_texel(i));
    here = own.xyz;
    velocity = moved_at(i).xyz;
    const float excess = uintBitsToFloat(velocity_texel(i)).w - 1.0, room = max(-excess, 0.0);
    const float error = growth(i, uint(own.w), wall) + BETA * max(excess, 0.0) - room * room / (room + ROOM);
    const float step = state.dt_s * frame.inv_spacing_m, gain = OMEGA * wall.w / (step * step);
    const float from = place_at(i).w, pressure = max(from + gain * error, 0.0), before = solved[i];
    const float ahead = float(state.iteration) / float(state.iteration + 3u);
    positions[i] = vec4(here, max(pressure + ahead * (pressure - before), 0.0));
    solved[i] = pressure;
    // A particle that has no pressure and parts from the others has no error.
    return gain > 0.0 ? abs(pressure - from) / gain : 0.0;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (gl_LocalInvocationIndex == 0u)
        group_error = 0u;
    barrier();
    if (i < grid.sorted)
        atomicAdd(group_error, min(uint(improve(i) * VIRGA_FLUID_ERROR_ONE), VIRGA_FLUID_ERROR_MAX));
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        atomicAdd(state.error, group_error >> VIRGA_FLUID_ERROR_SHIFT);
}
