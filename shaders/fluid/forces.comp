// forces.comp - gravity and viscosity.
//
// Viscosity is that of Monaghan (2005, Smoothed Particle Hydrodynamics, Reports on Progress in Physics 68), which keeps
// momentum and angular momentum: 10 nu sum_j V (v_ij . x_ij) / (x_ij^2 + 0.01 d^2) grad W. It is explicit, and so
// limited to what is stable in this substep. One invocation per sorted particle. Reads: sorted, moved (velocities
// before it), lists. Writes: velocities.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define FLUID_ACCESS
#define STATE_ACCESS
#include "fluid.glsl"
#include "kernel.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

#define MAX_DIFFUSION 0.05 // nu dt / d^2

vec3 here, velocity, sum;

void pair(uint j)
{
    const vec3 apart = here - sorted_at(j).xyz;
    const float r2 = dot(apart, apart);
    sum += (dot(velocity - moved_at(j).xyz, apart) * slope(r2) / (r2 + 0.01)) * apart;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= grid.sorted)
        return;
    const vec4 own = sorted_at(i);
    here = own.xyz;
    velocity = moved_at(i).xyz;
    sum = vec3(0.0);
    const uint texels = uint(own.w);
    for (uint t = 0u, at = i; t < texels; t++, at += frame.stride) {
        const uvec4 four = list_texel(at);
        pair(four.x);
        pair(four.y);
        pair(four.z);
        pair(four.w);
    }
    const float diffusion = min(state.dt_s * frame.viscosity_m2_s * frame.inv_spacing_m * frame.inv_spacing_m,
                                MAX_DIFFUSION);
    velocities[i].xyz =
        velocity + state.dt_s * uintBitsToFloat(velocity_texel(i)).xyz + (10.0 * KERNEL_FACTOR * diffusion) * sum;
}
