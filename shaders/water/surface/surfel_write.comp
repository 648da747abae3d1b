// surfel_write.comp - moves surfels onto the surface. A surfel begins where the density, taken as linear along a
// crossed edge of the grid, has the value of the surface. There the density and its gradient are summed up, and a step
// of Newton's method along the gradient leads onto the surface itself. Its share is the mean cover of the particles
// around it, see cover.comp.
// One invocation per surfel. Reads: fields, block_of, centers, shapes, sorted_velocities. Reads and writes: surfels.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"
#include "water/block_list.glsl"
#include "water/blocks.glsl"
#include "water/octahedron.glsl"
#include "water/packed_share.glsl"
#define STATE_ACCESS readonly
#include "water/state.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(std430, set = 0, binding = 15) buffer Surfels { uvec4 surfels[]; };

vec3 here;
float sum, cover_sum, inv_h2;
vec3 gradient, velocity_sum;

#include "water/kernel_types.glsl"

void visit(Kernel kernel)
{
    const vec3 apart = here - kernel.center.xyz, conjugate = shaped(kernel, apart);
    const float x = max(1.0 - dot(apart, conjugate) * inv_h2, 0.0), weight = kernel.center.w * (x * x);
    sum += weight * x;
    gradient += weight * conjugate;
    velocity_sum += (weight * x) * kernel.velocity;
    cover_sum += (weight * x) * kernel.cover;
}
#define GATHER_VELOCITIES
#include "water/gather_kernels.glsl"

// Where the surface crosses an edge.
vec3 crossing(uint cell, uint block, uint point, uint axis)
{
    const uvec3 dims = grid_dims(), start = uvec3(point & 3u, point >> 2 & 3u, point >> 4);
    const uvec3 end = start + uvec3(axis == 0u, axis == 1u, axis == 2u), local = end & 3u, next = end >> 2;
    const uint end_block = block_of[cell + next.x + dims.x * (next.y + dims.y * next.z)];
    const float from = fields[VIRGA_WATER_POINTS * block + point];
    const float to = fields[VIRGA_WATER_POINTS * end_block + 16u * local.z + 4u * local.y + local.x];
    return cell_corner(cell) + frame.point_m * mix(vec3(start), vec3(end), (frame.level - from) / (to - from));
}

void main()
{
    const uint surfel = gl_GlobalInvocationID.x;
    if (surfel >= state.surfels)
        return;
    const uvec2 edge = surfels[2u * surfel].xy;
    const uint cell = blocks[edge.x];
    here = crossing(cell, edge.x, edge.y & 63u, edge.y >> 6);
    inv_h2 = frame.inv_h2;
    sum = cover_sum = 0.0;
    gradient = velocity_sum = vec3(0.0);
    gather(cell);
    const float slope2 = dot(gradient, gradient) * frame.kernel_gradient * frame.kernel_gradient;
    const float missing = frame.level - frame.kernel * sum;
    vec3 step_m = gradient * (frame.kernel_gradient * missing / max(slope2, 1e-20));
    step_m *= min(1.0, 0.5 * frame.point_m * inversesqrt(max(dot(step_m, step_m), 1e-20)));
    const vec3 normal = gradient * inversesqrt(max(dot(gradient, gradient), 1e-30));
    surfels[2u * surfel] = uvec4(floatBitsToUint(here + step_m), pack_octahedron(normal));
    const float radius = with_share(frame.surfel_m, cover_sum / max(sum, 1e-20));
    surfels[2u * surfel + 1u] = uvec4(floatBitsToUint(velocity_sum / max(sum, 1e-20)), floatBitsToUint(radius));
}
