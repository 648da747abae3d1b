// neighbours.comp - lists the neighbours of each particle, and sums up what does not depend on its pressure: the
// density, the gradient of the walls' part of it, alpha, how much pressure a change of density asks for (Bender and
// Koschier 2017, equation 9), and the velocity to which gravity and viscosity lead.
//
// A pressure p_i / rho accelerates particle i by -p_i (sum_j g_ij + G_i) and each neighbour j by p_i g_ij, where g_ij
// is the gradient of V W at i, and G_i that of the walls' part. In a substep dt this changes the density of i by -p_i
// dt^2 / alpha_i with
//
//     1 / alpha_i = |sum_j g_ij + G_i|^2 + sum_j |g_ij|^2.
//
// A body yields to the pressure as well: a particle of mass m that pushes a body of mass M with its gradient G adds
// |G|^2 m / M. All particles around the body do so at once, and in the worst case in step. Theirs are as many as the
// body's area has squares of a spacing, which is what `response` has: m / M times this number.
//
// Gravity is less what walls and bodies carry of it. Viscosity is that of Monaghan (2005, Smoothed Particle
// Hydrodynamics, Reports on Progress in Physics 68), which keeps momentum and angular momentum: 10 nu sum_j V (v_ij .
// x_ij) / (x_ij^2 + 0.01 d^2) grad W. It is explicit, and so limited to what is stable in this substep.
//
// One invocation per sorted particle. Reads: sorted, moved (velocities before the substep), cell_starts, bodies, maps.
// Writes: lists, gradients, walls, velocities, solved.y, touches.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define FLUID_ACCESS
#define STATE_ACCESS readonly
#define TOUCHES_ACCESS
#include "fluid.glsl"
#include "bodies.glsl"
#include "kernel.glsl"
#include "pairs.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

#define MAX_DIFFUSION 0.05 // nu dt / d^2
#define MAX_NEIGHBOURS (4u * VIRGA_FLUID_LIST_TEXELS)

// What decides how much of a particle's weight walls carry, see kernel.glsl.
struct Weight {
    vec3 gravity; // m/s^2, less what they carry
    vec3 rise;    // gradient of the pressure between the particles (m/s^2)
    float rests;  // share across walls
};

// Of the gradient of water at rest, in directions along walls, which have `seen` of it in `rise`.
float share_of(vec3 rise, vec3 gravity, float seen)
{
    return clamp(dot(rise, gravity) / max(dot(gravity, gravity) * seen, 1e-9), 0.0, 1.0);
}

// Nothing while the particle has no pressure, as in free fall. In the first layer over a floor pressure is half of what
// a spacing adds.
float share_at(float pressure)
{
    return min(pressure / max(0.5 * frame.spacing_m * length(to_vec(frame.gravity_m_s2)), 1e-9), 1.0);
}

void carry_by_box(vec3 p, vec3 low, vec3 high, inout Weight weight)
{
    const BoxCarries carries = box_carries(p, low, high);
    for (uint axis = 0u; axis < 3u; axis++) {
        const vec3 pull = frame.gravity_m_s2[axis] * vec3(axis == 0u, axis == 1u, axis == 2u);
        const float seen = 1.0 - carries.across[axis] - carries.along[axis];
        weight.gravity -= (weight.rests * carries.across[axis] +
                           share_of(weight.rise, pull, max(seen, 0.2)) * carries.along[axis]) * pull;
    }
}

// The word of a touch, and what the body carries off the weight.
uvec4 touch_of(uint body, Near near, inout Weight weight)
{
    const vec3 gravity = to_vec(frame.gravity_m_s2), normal = near.gradient;
    const vec3 along = gravity - dot(gravity, normal) / max(dot(normal, normal), 1e-12) * normal;
    const float across = near.density / max(plane_density(near.distance), 1e-6) *
                         carried_across(max(near.distance, 0.0));
    const vec2 shares = vec2(weight.rests * across,
                             share_of(weight.rise, along, max(1.0 - near.density, 0.2)) * near.density);
    const uvec4 touch = uvec4(floatBitsToUint(normal), touch_word(body, shares));
    weight.gravity -= body_carries(touch);
    return touch;
}

// Adds the bodies near a particle to what it has from the walls, and notes which it touches. Returns their part of 1 /
// alpha.
float add_bodies(uint i, vec3 p, inout BoxWalls wall, inout Weight weight)
{
    uint count = 0u;
    float yielding = 0.0;
    for (uint body = 0u; body < frame.bodies; body++) {
        const Near near = near_body(body, p);
        const float squared = dot(near.gradient, near.gradient);
        if (squared == 0.0)
            continue;
        wall.density += near.density;
        wall.gradient += near.gradient;
        wall.pull += near.pull;
        if (count >= VIRGA_FLUID_TOUCHES)
            continue;
        yielding += shapes.of[body].response * squared;
        touches[VIRGA_FLUID_TOUCHES * i + count++] = touch_of(body, near, weight);
    }
    for (; count < VIRGA_FLUID_TOUCHES; count++)
        touches[VIRGA_FLUID_TOUCHES * i + count] = uvec4(uvec3(0u), NO_BODY);
    return yielding;
}

// Which of up to 32 sorted particles from `first` on are neighbours, as bits.
uint near_bits(uint i, vec3 here, uint first, uint end)
{
    uint bits = 0u;
    const uint count = min(end - first, 32u);
    for (uint k = 0u; k < count; k++) {
        const vec3 apart = here - place_at(first + k).xyz;
        bits |= dot(apart, apart) < 4.0 ? 1u << k : 0u;
    }
    const uint own = i - first;
    return own < 32u ? bits & ~(1u << own) : bits;
}

// Lists the neighbours of a particle, four in a texel; the last texel is filled up with the particle itself. Returns
// their number. Seven of eight particles in the cells around are too far away. So these are first only marked: lanes of
// a group would wait for each other wherever one of them does more, and they store where any of them has a neighbour.
uint list_neighbours(uint i, vec3 here)
{
    const uvec3 dims = grid_dims();
    const uint cell = cell_at(to_vec(particles[sorted_indices[i]].position)), stride = frame.stride;
    uvec4 four = uvec4(i);
    uint count = 0u;
    for (uint row = 0u; row < 9u; row++) {
        const uvec2 run = neighbour_row(cell, row, dims);
        for (uint first = run.x; first < run.y; first += 32u) {
            uint bits = near_bits(i, here, first, run.y);
            for (; bits != 0u && count < MAX_NEIGHBOURS; bits &= bits - 1u) {
                four = uvec4(four.yzw, first + uint(findLSB(bits)));
                count++;
                if ((count & 3u) != 0u)
                    continue;
                lists[(count / 4u - 1u) * stride + i] = four;
                four = uvec4(i);
            }
        }
    }
    if ((count & 3u) != 0u)
        lists[count / 4u * stride + i] = four;
    return count;
}

float dt;
vec4 place;
float density, squares;
vec3 velocity, sum, rise, drag;

// Adds a neighbour, and returns its words. The particle itself adds nothing.
uvec2 add(uint i, uint j)
{
    const vec4 other = place_at(j);
    const vec3 apart = place.xyz - other.xyz;
    const float r2 = dot(apart, apart);
    const vec3 gradient = slope(r2) * apart;
    density += j == i ? 0.0 : kernel(sqrt(r2));
    sum += gradient;
    rise += (other.w - place.w) * gradient;
    squares += dot(gradient, gradient);
    drag += dot(velocity - moved_at(j).xyz, apart) / (r2 + 0.01) * gradient;
    return pair_words(j, gradient);
}

void add_neighbours(uint i, uint texels)
{
    density = squares = 0.0;
    sum = rise = drag = vec3(0.0);
    const uint stride = frame.stride;
    for (uint t = 0u, at = i; t < texels; t++, at += stride) {
        const uvec4 four = lists[at];
        const uvec2 x = add(i, four.x), y = add(i, four.y), z = add(i, four.z), w = add(i, four.w);
        lists[at] = uvec4(x.x, y.x, z.x, w.x);
        gradients[at] = uvec4(x.y, y.y, z.y, w.y);
    }
}

// The velocity after the substep without pressure.
vec3 free_velocity(vec3 gravity)
{
    const float diffusion = min(dt * frame.viscosity_m2_s * frame.inv_spacing_m * frame.inv_spacing_m,
                                MAX_DIFFUSION);
    return velocity + dt * gravity + (10.0 * KERNEL_FACTOR * diffusion) * drag;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    dt = state.dt_s; // read before the branch, see push.comp
    if (i >= grid.sorted)
        return;
    place = place_at(i);
    velocity = moved_at(i).xyz;
    const vec3 here = place.xyz;
    const uint texels = (list_neighbours(i, here) + 3u) / 4u;
    add_neighbours(i, texels);
    const vec3 low = to_vec(frame.low_m) * frame.inv_spacing_m, high = to_vec(frame.high_m) * frame.inv_spacing_m;
    BoxWalls wall = box_walls(here, low, high);
    Weight weight = Weight(to_vec(frame.gravity_m_s2), KERNEL_FACTOR * frame.inv_spacing_m * rise, share_at(place.w));
    carry_by_box(here, low, high, weight);
    float yielding = 0.0;
    if (WITH_BODIES)
        yielding = add_bodies(i, frame.spacing_m * here, wall, weight);
    sum = KERNEL_FACTOR * sum + wall.gradient;
    const float inverse = dot(sum, sum) + KERNEL_FACTOR * KERNEL_FACTOR * squares + yielding;
    walls[i] = vec4(wall.gradient, inverse > 1e-6 ? 1.0 / inverse : 0.0);
    velocities[i] = vec4(free_velocity(weight.gravity), KERNEL_SELF + density + wall.density);
    solved[i].y = solved_word(texels, wall.pull);
}
