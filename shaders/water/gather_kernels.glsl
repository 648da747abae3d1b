// gather_kernels.glsl - visits all kernels whose particles are in the 27 cells around a cell, in the order of the
// sorted list. See gather.glsl.
//
// The includer includes kernel_types.glsl and defines `void visit(Kernel kernel)`.
#include "gpu/texels.glsl"

TEXELS(center_texel, 16, 5)
TEXELS(shape_texel, 18, 6)
#ifdef GATHER_VELOCITIES
TEXELS(velocity_texel, 17, 14)
#endif

void gather(uint cell)
{
    const uvec3 dims = grid_dims();
    for (uint row = 0u; row < 9u; row++) {
        const uvec2 run = neighbour_row(cell, row, dims);
        for (uint i = run.x; i < run.y; i++) {
            Kernel kernel;
            kernel.center = uintBitsToFloat(center_texel(i));
            if (KERNEL == VIRGA_WATER_ANISOTROPIC) {
                const vec4 first = uintBitsToFloat(shape_texel(2u * i));
                const vec4 second = uintBitsToFloat(shape_texel(2u * i + 1u));
                kernel.squares = first.xyz;
                kernel.products = vec3(first.w, second.xy);
            }
#ifdef GATHER_VELOCITIES
            const vec4 moving = uintBitsToFloat(velocity_texel(i));
            kernel.velocity = moving.xyz;
            kernel.cover = moving.w;
#endif
            visit(kernel);
        }
    }
}
