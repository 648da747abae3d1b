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
// One invocation per sorted particle. Reads: sorted, cell_starts. Writes: lists, walls, velocities.w, sorted.w.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#define FLUID_ACCESS
#include "fluid.glsl"
#include "kernel.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

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
    const BoxWalls wall =
        box_walls(here, to_vec(frame.low_m) * frame.inv_spacing_m, to_vec(frame.high_m) * frame.inv_spacing_m);
    sum = KERNEL_FACTOR * sum + wall.gradient;
    const float inverse = dot(sum, sum) + KERNEL_FACTOR * KERNEL_FACTOR * squares;
    walls[i] = vec4(wall.gradient, inverse > 1e-6 ? 1.0 / inverse : 0.0);
    velocities[i].w = KERNEL_SELF + density + wall.density;
    sorted[i] = vec4(here, float((count + 3u) / 4u));
    moved[i].w = wall.pull;
}
