// correct.glsl - one iteration of the solver: how far the velocities miss their aim, and the change of pressure that
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
// from a point y ahead of the last pressures, y = p + (k + 2) / (k + 5) (p - p_before), in iteration k, from 0 on
// (Nesterov's method, see Beck and Teboulle 2009, A Fast Iterative Shrinkage-Thresholding Algorithm). Without it
// pressure takes as many iterations as the square of the depth in particles to arrive at the floor; with it, as the
// depth. That paper begins with k / (k + 3), for pressures of which nothing is known; ours are those of the substep
// before.
//
// With a share b ahead, an error that belongs to the eigenvalue l of the system (over its diagonal) fades if
// OMEGA l < (2 + 2 b) / (1 + 2 b). The largest l is 2.9 on a lattice, up to 3.7 for disordered particles, and 4.0 if
// these are a quarter too dense. So 0.35 is stable for l up to 3.8 in any number of iterations, and up to 4.0 in the
// first eight.
//
// The last workgroup ends the iterations when the mean error is small.
//
// One invocation per sorted particle. Reads: moved, velocities, walls, lists, gradients, touches, bodies. Reads and
// writes: sorted (pressures), solved, state.
#define GRID_ACCESS
#define FLUID_ACCESS
#define STATE_ACCESS coherent
#include "fluid.glsl"
#include "bodies.glsl"
#include "kernel.glsl"
#include "pairs.glsl"

#define OMEGA 0.35
#define BETA  0.05
#define ROOM  0.2

// The first iterations find out what is wrong near each particle, not yet what that means for those far from it: a
// small error does not say much then.
#define MIN_ITERATIONS 4u

shared uint group_error;

// The time of the substep in spacings per (m/s), and the number of the iteration. Read before any branch: software
// Vulkan then reads them once for all lanes.
float dt, iteration;
vec3 here, velocity;
float sum;

void pair(uint first, uint second)
{
    sum += dot(velocity - moved_at(pair_index(first)).xyz, pair_gradient(first, second));
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
    const uint stride = frame.stride;
    sum = 0.0;
    for (uint t = 0u, at = i; t < texels; t++, at += stride) {
        const uvec4 four = list_texel(at), seconds = gradient_texel(at);
        pair(four.x, seconds.x);
        pair(four.y, seconds.y);
        pair(four.z, seconds.z);
        pair(four.w, seconds.w);
    }
    float walls = dot(velocity, wall.xyz);
    if (WITH_BODIES)
        walls += approach(i);
    return dt * (KERNEL_FACTOR / GRADIENT_ONE * sum + walls);
}

// Improves the pressure of a particle, and returns its error.
float improve(uint i)
{
    const vec4 own = place_at(i), wall = uintBitsToFloat(wall_texel(i));
    const vec2 before = solved[i];
    here = own.xyz;
    velocity = moved_at(i).xyz;
    const float excess = uintBitsToFloat(velocity_texel(i)).w - 1.0, room = max(-excess, 0.0);
    const float grows = growth(i, solved_texels(before.y), wall);
    const float error = grows + BETA * max(excess, 0.0) - room * room / (room + ROOM);
    const float gain = OMEGA * wall.w / (dt * dt);
    const float from = own.w, pressure = max(from + gain * error, 0.0);
    const float ahead = (iteration + 2.0) / (iteration + 5.0);
    sorted[i].w = max(pressure + ahead * (pressure - before.x), 0.0);
    solved[i].x = pressure;
    // A particle that has no pressure and parts from the others has no error.
    return gain > 0.0 ? abs(pressure - from) / gain : 0.0;
}

void end_iteration()
{
    const float one = VIRGA_FLUID_ERROR_ONE / float(1u << VIRGA_FLUID_ERROR_SHIFT);
    const float error = float(atomicExchange(state.error, 0u)) / (one * float(max(grid.sorted, 1u)));
    state.groups_done = 0u;
    state.iteration++;
    state.iterations++;
    state.solver_error = error;
    if (state.iteration >= MIN_ITERATIONS && error <= frame.solver_error)
        state.loop_groups = state.loop_body_groups = uint[3](0u, 1u, 1u);
}

// Adds up the errors of a workgroup, in fixed point. All of its invocations call it.
void add_error(uint error);

void iterate()
{
    const uint i = gl_GlobalInvocationID.x;
    uint error = 0u;
    dt = state.dt_s * frame.inv_spacing_m;
    iteration = float(state.iteration);
    if (gl_LocalInvocationIndex == 0u)
        group_error = 0u;
    barrier();
    if (i < grid.sorted)
        error = min(uint(improve(i) * VIRGA_FLUID_ERROR_ONE), VIRGA_FLUID_ERROR_MAX);
    add_error(error);
    barrier();
    // All of this workgroup have read the state, which the last one changes. Its error counts before it does.
    if (gl_LocalInvocationIndex == 0u) {
        atomicAdd(state.error, group_error >> VIRGA_FLUID_ERROR_SHIFT);
        memoryBarrierBuffer();
        if (atomicAdd(state.groups_done, 1u) + 1u == gl_NumWorkGroups.x)
            end_iteration();
    }
}
