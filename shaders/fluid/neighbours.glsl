// neighbours.glsl - sums up over the neighbours of each particle what does not depend on its pressure: the density, the
// gradient of the walls' part of it, alpha, how much pressure a change of density asks for (Bender and Koschier 2017,
// equation 9), and the velocity to which gravity and viscosity lead. neighbours.comp and neighbours_shuffle.comp list
// the neighbours before, each in its way.
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
// Reads: sorted, moved (velocities before the substep), bodies, maps. Writes: lists, gradients, walls, velocities,
// solved.y, touches.
#define FLUID_ACCESS
#define STATE_ACCESS readonly
#define TOUCHES_ACCESS
#include "fluid.glsl"
#include "bodies.glsl"
#include "kernel.glsl"
#include "pairs.glsl"

#define MAX_DIFFUSION 0.05 // nu dt / d^2
#define MAX_NEIGHBOURS (4u * VIRGA_FLUID_LIST_TEXELS)

// Only pairs nearer than 1.9 spacings are listed, though the kernel reaches to 2. Between the two are a seventh of all
// pairs, 1 - 0.95^3. These have 1e-4 of the density, the integral of W q^2, and 0.25 % of what pressure does, that of
// |W'| q^3.
#define REACH2 3.61 // 1.9^2

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
    const vec2 both = kernel_and_slope(r2);
    const vec3 gradient = both.y * apart;
    density += j == i ? 0.0 : both.x;
    sum += gradient;
    rise += (other.w - place.w) * gradient;
    squares += dot(gradient, gradient);
    drag += dot(velocity - moved_at(j).xyz, apart) / (r2 + 0.01) * gradient;
    return pair_words(j, gradient);
}

// The neighbours 4 t to 4 t + 3 of particle i; in their place behind the last one, the particle itself.
uvec4 listed(uint i, uint t);

void add_neighbours(uint i, uint texels)
{
    density = squares = 0.0;
    sum = rise = drag = vec3(0.0);
    const uint stride = frame.stride;
    for (uint t = 0u, at = i; t < texels; t++, at += stride) {
        const uvec4 four = listed(i, t);
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

// What follows when the `count` neighbours of particle i are known.
void sum_up(uint i, uint count)
{
    velocity = moved_at(i).xyz;
    const vec3 here = place.xyz;
    const uint texels = (count + 3u) / 4u;
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
    velocities[i] = vec4(free_velocity(weight.gravity), KERNEL_SELF + KERNEL_FACTOR * density + wall.density);
    solved[i].y = solved_word(texels, wall.pull);
}
