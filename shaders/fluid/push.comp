// push.comp - the velocities that the pressures lead to (Bender and Koschier 2017, equation 7): each pair of particles
// is pushed apart by the sum of both pressures.
// One invocation per sorted particle. Reads: positions, sorted, velocities, walls, lists. Writes: moved.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define FLUID_ACCESS
#include "fluid.glsl"
#include "kernel.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

vec4 own;
vec3 sum;

void pair(uint j)
{
    const vec4 other = place_at(j);
    const vec3 apart = own.xyz - other.xyz;
    sum += ((own.w + other.w) * slope(dot(apart, apart))) * apart;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= grid.sorted)
        return;
    own = place_at(i);
    sum = vec3(0.0);
    const uint texels = uint(sorted_at(i).w);
    for (uint t = 0u, at = i; t < texels; t++, at += frame.stride) {
        const uvec4 four = list_texel(at);
        pair(four.x);
        pair(four.y);
        pair(four.z);
        pair(four.w);
    }
    const vec3 wall = uintBitsToFloat(wall_texel(i)).xyz, velocity = uintBitsToFloat(velocity_texel(i)).xyz;
    const vec3 acceleration = -frame.inv_spacing_m * (KERNEL_FACTOR * sum + own.w * wall);
    moved[i].xyz = velocity + state.dt_s * acceleration;
}
