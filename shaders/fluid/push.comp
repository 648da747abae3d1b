// push.comp - the velocities that the pressures lead to (Bender and Koschier 2017, equation 7): each pair of particles
// is pushed apart by the sum of both pressures.
// One invocation per sorted particle. Reads: sorted, solved, velocities, walls, lists, gradients. Writes:
// moved.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define FLUID_ACCESS
#include "fluid.glsl"
#include "kernel.glsl"
#include "pairs.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

float own;
vec3 sum;

void pair(uint first, uint second)
{
    sum += (own + place_at(pair_index(first)).w) * pair_gradient(first, second);
}

void main()
{
    const uint i = gl_GlobalInvocationID.x, stride = frame.stride;
    const float dt = state.dt_s; // software Vulkan reads it once for all lanes before a branch, not behind it
    if (i >= grid.sorted)
        return;
    own = place_at(i).w;
    sum = vec3(0.0);
    const uint texels = solved_texels(solved[i].y);
    for (uint t = 0u, at = i; t < texels; t++, at += stride) {
        const uvec4 four = list_texel(at), seconds = gradient_texel(at);
        pair(four.x, seconds.x);
        pair(four.y, seconds.y);
        pair(four.z, seconds.z);
        pair(four.w, seconds.w);
    }
    const vec3 wall = uintBitsToFloat(wall_texel(i)).xyz, velocity = uintBitsToFloat(velocity_texel(i)).xyz;
    const vec3 acceleration = -frame.inv_spacing_m * (KERNEL_FACTOR / GRADIENT_ONE * sum + own * wall);
    moved[i].xyz = velocity + dt * acceleration;
}
