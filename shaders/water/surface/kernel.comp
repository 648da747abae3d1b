// kernel.comp - the kernels of the surface. What leaves the surface as spray has no part in it.
//
// Isotropic: a ball of radius h around each particle, as it is.
//
// Anisotropic (Yu and Turk 2013, "Reconstructing surfaces of particle-based fluids using anisotropic kernels"): the
// kernel is an ellipsoid with the axes of the neighbours' covariance. On a flat surface and in a thin sheet it is a
// disk. Here it differs from the paper in four ways:
//
//   - Centers (equation 6) move towards the mean of their neighbours, which on a surface is inside the water. There the
//     paper loses a quarter of a spacing of water on every side. We subtract what the neighbours move on average, times
//     a constant that leaves the surface of flat water in its position (cf. Vollmer et al. 1999).
//   - The largest axis is cut so that no kernel reaches beyond h from its particle: the cells around a grid point hold
//     just the particles within h, and what reaches farther would end at the border of a cell.
//   - Axes grow as the square root of the eigenvalues, as these are squares of lengths (equation 15 is linear in them).
//   - With few neighbours (equation 15 has a limit of 25) a kernel becomes a small ball, by degrees: particles that
//     leave the water do not jump from one shape to the other.
//
// One invocation per sorted particle. Reads: sorted, shifts, selection, densities. Writes: centers; reads and writes:
// shapes.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"
#include "water/kernels.glsl"
#include "water/spray_part.glsl"
#define GATHER_SHIFTS

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(std430, set = 0, binding = 8) readonly buffer Densities { float densities[]; };
layout(std430, set = 0, binding = 10) readonly buffer Selection { uvec4 selection[]; };

vec3 here, shift;
float inv_h2;

void visit(vec4 particle, vec4 shifted)
{
    const vec3 apart = particle.xyz - here;
    const float q2 = dot(apart, apart) * inv_h2;
    shift += particle.w * max(1.0 - q2 * sqrt(q2), 0.0) * shifted.xyz;
}
#include "water/gather.glsl"

// Whether a block of the surface is around a cell: only then the kernels in the cell matter.
bool is_near_surface(uint cell)
{
    const uvec3 dims = grid_dims();
    uint found = 0u;
    for (uint i = 0u; i < 27u; i++) {
        const uint at = cell + i % 3u + (i / 3u % 3u) * dims.x + (i / 9u) * dims.x * dims.y - 1u - dims.x -
                        dims.x * dims.y;
        found |= selection[at >> 5].x >> (at & 31u) & 1u;
    }
    return found != 0u;
}

// A rotation of Jacobi's method, which makes element (p, q) of a symmetric matrix 0.
void rotate(inout mat3 a, inout mat3 axes, int p, int q)
{
    const float off = a[q][p], gap = a[q][q] - a[p][p];
    if (abs(off) <= 1e-9 * (abs(a[p][p]) + abs(a[q][q])))
        return;
    // Tangent of the angle, the smaller solution of t^2 + t gap / off - 1 = 0.
    const float t = 2.0 * off * (gap >= 0.0 ? 1.0 : -1.0) / (abs(gap) + sqrt(gap * gap + 4.0 * off * off));
    const float c = inversesqrt(1.0 + t * t), s = t * c;
    const int r = 3 - p - q;
    const float rp = a[r][p], rq = a[r][q];
    a[p][p] -= t * off;
    a[q][q] += t * off;
    a[p][q] = a[q][p] = 0.0;
    a[r][p] = a[p][r] = c * rp - s * rq;
    a[r][q] = a[q][r] = s * rp + c * rq;
    const vec3 axis = axes[p];
    axes[p] = c * axis - s * axes[q];
    axes[q] = s * axis + c * axes[q];
}

// The axes of the ellipsoid (m), for a covariance with these eigenvalues, `room` at most.
vec3 axis_lengths(vec3 eigenvalues, float weight, float room)
{
    // In the middle of water the eigenvalues are those of the weights alone, 0.15 h^2: there the axes are h.
    const float largest = max(max(eigenvalues.x, max(eigenvalues.y, eigenvalues.z)), 1e-12 * frame.cell_m);
    const vec3 ratios = sqrt(max(eigenvalues / largest, vec3(1.0 / frame.stretch2)));
    const float longest = min(frame.cell_m * sqrt(largest * inv_h2 / 0.15), room);
    const float crowded = smoothstep(0.1, 0.25, weight * frame.crowd);
    return mix(vec3(min(frame.lonely_m, room)), longest * ratios, crowded);
}

void main()
{
    const uint own = gl_GlobalInvocationID.x;
    if (own >= grid.sorted)
        return;
    vec4 particle = uintBitsToFloat(sorted_texel(own));
    if (frame.spray_high > 0.0)
        particle.w *= 1.0 - spray_part(densities[sorted_indices[own]]);
    if (KERNEL == VIRGA_WATER_ISOTROPIC) {
        centers[own] = particle;
        return;
    }
    here = particle.xyz;
    const uint cell = cell_at(here);
    if (!is_near_surface(cell))
        return;
    shift = vec3(0.0);
    inv_h2 = frame.inv_h2;
    gather(cell);
    const vec4 own_shift = uintBitsToFloat(shift_texel(own));
    shift = frame.smoothing * (own_shift.xyz - VIRGA_WATER_UNSHIFT * shift / max(own_shift.w, 1e-20));
    const float far = length(shift);
    shift *= min(1.0, VIRGA_WATER_MAX_SHIFT * frame.cell_m / max(far, 1e-20));
    const vec4 first = shapes[2u * own];
    const vec2 second = shapes[2u * own + 1u].xy;
    mat3 covariance = mat3(first.x, first.w, second.x, first.w, first.y, second.y, second.x, second.y, first.z);
    mat3 axes = mat3(1.0);
    for (int sweep = 0; sweep < 5; sweep++) {
        rotate(covariance, axes, 0, 1);
        rotate(covariance, axes, 0, 2);
        rotate(covariance, axes, 1, 2);
    }
    const float room = frame.cell_m - min(far, VIRGA_WATER_MAX_SHIFT * frame.cell_m);
    const vec3 lengths = axis_lengths(vec3(covariance[0][0], covariance[1][1], covariance[2][2]), own_shift.w, room) *
                         frame.inv_cell_m;
    // Times h^2: the unit matrix is the ball of radius h. The weight keeps the integral of the kernel: its volume.
    const vec3 sharp = 1.0 / (lengths * lengths);
    const mat3 shape = mat3(sharp.x * axes[0], sharp.y * axes[1], sharp.z * axes[2]) * transpose(axes);
    shapes[2u * own] = vec4(shape[0][0], shape[1][1], shape[2][2], shape[1][0]);
    shapes[2u * own + 1u] = vec4(shape[2][0], shape[2][1], 0.0, 0.0);
    centers[own] = vec4(here + shift, particle.w / (lengths.x * lengths.y * lengths.z));
}
