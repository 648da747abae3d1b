// normal.comp - the normal of the surface at each particle near it, and how much air is trapped there.
//
// Trapped air (equation 2 of Ihmsen et al. 2012): the sum over the neighbours j of |v_ij| (1 - v_ij . x_ij) W, where
// v_ij = v_i - v_j and x_ij = x_i - x_j, the second pair as unit vectors, and W = 1 - r / h. It is 0 for neighbours
// that move away from each other, and largest for those that meet head-on. Here it is divided by the sum of W in the
// middle of water at rest: it is a speed, which does not depend on how many neighbours a kernel has.
//
// Walls count as particles that are at rest behind them, spread evenly (Ihmsen et al. count those of their boundaries).
// Along a wall the water slides, so v_ij is the speed v into the wall alone, and the sum over the space behind it has a
// closed form. With u = z / h for a particle at the distance z, divided as the rest,
//
//     v (A + B),    A = 1/2 - u + u^3 - u^4 / 2,    B = 1/4 - 3/2 u^2 + 2 u^3 - 3/4 u^4,
//
// where A is the integral of W over that space and B that of W times the cosine to the wall's normal.
//
// A body beside a particle is such a wall that moves: v is the speed of the water into it.
//
// The normal is that of the density, and only where its slope is steep: at the surface. A body counts as water there:
// behind a plane at the distance z its slope is, with the kernel of virga_water_step_gpu,
//
//     315 / 256 (1 - u^2)^4 / h
//
// One invocation per sorted particle. Reads: sorted, sorted_velocities, bodies. Writes: normals.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_ACCESS readonly
#include "foam.glsl"
#include "shared/body_near.h"

layout(local_size_x = VIRGA_WATER_LANES) in;

vec3 here, gradient, velocity;
float inv_h2, air;

void visit(uint i, vec4 particle);
#include "gather.glsl"
TEXELS(velocity_texel, 16, 14)

void visit(uint i, vec4 particle)
{
    const vec3 apart = here - particle.xyz;
    const float q2 = dot(apart, apart) * inv_h2, x = max(1.0 - q2, 0.0);
    gradient += particle.w * x * x * apart;
    if (x > 0.0) {
        const vec3 moved = velocity - uintBitsToFloat(velocity_texel(i)).xyz;
        const float apart_m = sqrt(dot(apart, apart));
        // |v| (1 - v . x / (|v| |x|)) = |v| - v . x / |x|
        air += particle.w * (1.0 - sqrt(q2)) * (length(moved) - dot(moved, apart) / max(apart_m, 1e-20));
    }
}

float wall_air(float z, float into)
{
    const float u = clamp(z / frame.cell_m, 0.0, 1.0), u2 = u * u;
    return max(into, 0.0) * (0.75 - u - 1.5 * u2 + 3.0 * u2 * u - 1.25 * u2 * u2);
}

float walls_air()
{
    float sum = 0.0;
    for (uint axis = 0u; axis < 3u; axis++)
        sum += wall_air(here[axis] - frame.foam_low[axis], -velocity[axis]) +
               wall_air(frame.foam_high[axis] - here[axis], velocity[axis]);
    return sum;
}

layout(scalar, set = 0, binding = 18) readonly buffer Bodies { virga_body_near_gpu bodies[]; };

// What a body adds: to the slope, out of the surface; and w, to the air.
vec4 body_part(uint particle)
{
    if (frame.bodies_given == 0u)
        return vec4(0.0);
    const virga_body_near_gpu body = bodies[particle];
    if (!(body.distance_m < frame.cell_m)) // also NaN
        return vec4(0.0);
    const vec3 normal = to_vec(body.normal), moved = velocity - to_vec(body.velocity);
    const float u = max(body.distance_m * frame.inv_cell_m, 0.0), inside2 = (1.0 - u * u) * (1.0 - u * u);
    const float slope = 315.0 / 256.0 * inside2 * inside2 * frame.inv_cell_m;
    return clamp(body.share, 0.0, 1.0) * vec4(slope * normal, wall_air(body.distance_m, -dot(moved, normal)));
}

// Of the slope of the density, times h. In the outermost layer of a flat surface with h = 2 spacings it is 0.95, in the
// one below it 0.045.
#define STEEP 0.3

void main()
{
    const uint own = gl_GlobalInvocationID.x;
    if (own >= grid.sorted)
        return;
    here = uintBitsToFloat(sorted_texel(own)).xyz;
    velocity = uintBitsToFloat(velocity_texel(own)).xyz;
    inv_h2 = frame.inv_h2;
    gradient = vec3(0.0);
    air = 0.0;
    gather(cell_at(here));
    const vec4 body = body_part(sorted_indices[own]);
    const vec3 out_of_water = body.xyz - frame.kernel_gradient * gradient;
    const float steep = length(out_of_water);
    normals[own] = vec4(steep * frame.cell_m > STEEP ? out_of_water / steep : vec3(0.0),
                        air * frame.foam_inv_weights + walls_air() + body.w);
}
