// field.comp - the density of the water at the grid points of each block (equation 1 and section 4.2 of Iwasaki et al.
// 2006), and which of them are inside the water.
// One workgroup per block; each invocation has a column of four points. Reads: centers, shapes. Writes: fields,
// block_insides, block_of.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"
#include "water/block_list.glsl"
#define BLOCKS_ACCESS
#include "water/blocks.glsl"

layout(local_size_x = 16) in;

shared uint inside[2];

vec2 here;
vec4 along, sum; // positions along z, and densities there
float inv_h2;

#include "water/kernel_types.glsl"

void visit(Kernel kernel)
{
    const vec2 aside = kernel.center.xy - here;
    const vec4 apart = kernel.center.z - along;
    vec4 x;
    if (KERNEL == VIRGA_WATER_ISOTROPIC) {
        x = (1.0 - dot(aside, aside) * inv_h2) - apart * apart * inv_h2;
    } else {
        // A quadratic form is a parabola along z.
        const float flat_part = dot(kernel.squares.xy, aside * aside) + 2.0 * kernel.products.x * aside.x * aside.y;
        const float slope = 2.0 * dot(kernel.products.yz, aside);
        x = 1.0 - inv_h2 * (flat_part + apart * (slope + kernel.squares.z * apart));
    }
    x = max(x, 0.0);
    sum += kernel.center.w * (x * x * x);
}
#include "water/gather_kernels.glsl"

void main()
{
    const uint block = list_item(), lane = gl_LocalInvocationIndex;
    if (block >= block_list.count)
        return;
    if (lane < 2u)
        inside[lane] = 0u;
    barrier();
    const uint cell = blocks[block];
    const vec3 corner = cell_corner(cell);
    inv_h2 = frame.inv_h2;
    here = corner.xy + frame.point_m * vec2(lane & 3u, lane >> 2);
    along = corner.z + frame.point_m * vec4(0.0, 1.0, 2.0, 3.0);
    sum = vec4(0.0);
    gather(cell);
    sum *= frame.kernel;
    for (uint i = 0u; i < 4u; i++) {
        fields[VIRGA_WATER_POINTS * block + 16u * i + lane] = sum[i];
        if (sum[i] >= frame.level)
            atomicOr(inside[i >> 1], 1u << (16u * (i & 1u) + lane));
    }
    barrier();
    if (lane == 0u) {
        block_of[cell] = block;
        block_insides[block] = uvec2(inside[0], inside[1]);
    }
}
