// neighbours.comp - lists the neighbours of each particle, and sums up what only positions decide: the density, the
// gradient of the walls' part of it, and alpha, how much pressure a change of density asks for (Bender and Koschier
// 2017, equation 9).
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
// One invocation per sorted particle. Reads: sorted, cell_starts, bodies, maps. Writes: lists, walls, velocities.w,
// sorted.w, touches.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#define FLUID_ACCESS
#define TOUCHES_ACCESS
#include "fluid.glsl"
#include "bodies.glsl"
#include "kernel.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

// Adds the bodies near a particle to what it has from the walls, and notes which it touches. Returns their part of 1 /
// alpha.
float add_bodies(uint i, vec3 p, inout BoxWalls wall)
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
        touches[VIRGA_FLUID_TOUCHES * i + count++] = uvec4(floatBitsToUint(near.gradient), body);
    }
    for (; count < VIRGA_FLUID_TOUCHES; count++)
        touches[VIRGA_FLUID_TOUCHES * i + count] = uvec4(uvec3(0u), NO_BODY);
    return yielding;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= grid.sorted)
        return;
    const vec3 here = place_at(i).xyz;
    const uvec3 dims = grid_dims();
    const uint cell = cell_at(to_vec(particles[sorted_indices[i]].position));
    float density = 0.0, squares = 0.0;
    vec3 sum = vec3(0.0);
    uvec4 four = uvec4(i);
    uint count = 0u;
    for (uint row = 0u; row < 9u; row++) {
        const uvec2 run = neighbour_row(cell, row, dims);
        for (uint j = run.x; j < run.y; j++) {
            const vec3 apart = here - place_at(j).xyz;
            const float r2 = dot(apart, apart);
            if (r2 >= 4.0 || j == i || count >= 4u * VIRGA_FLUID_LIST_TEXELS)
                continue;
            const float s = slope(r2);
            density += kernel(sqrt(r2));
            sum += s * apart;
            squares += s * s * r2;
            four = uvec4(four.yzw, j);
            count++;
            if ((count & 3u) == 0u) {
                lists[(count / 4u - 1u) * frame.stride + i] = four;
                four = uvec4(i);
            }
        }
    }
    // The last ones, filled up with the particle itself, whose gradient is 0.
    if ((count & 3u) != 0u)
        lists[count / 4u * frame.stride + i] = four;
    BoxWalls wall =
        box_walls(here, to_vec(frame.low_m) * frame.inv_spacing_m, to_vec(frame.high_m) * frame.inv_spacing_m);
    float yielding = 0.0;
    if (WITH_BODIES)
        yielding = add_bodies(i, frame.spacing_m * here, wall);
    sum = KERNEL_FACTOR * sum + wall.gradient;
    const float inverse = dot(sum, sum) + KERNEL_FACTOR * KERNEL_FACTOR * squares + yielding;
    walls[i] = vec4(wall.gradient, inverse > 1e-6 ? 1.0 / inverse : 0.0);
    velocities[i].w = KERNEL_SELF + density + wall.density;
    sorted[i] = vec4(here, float((count + 3u) / 4u));
    moved[i].w = wall.pull;
}
