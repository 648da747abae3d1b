// gather.glsl - visits all particles in the 27 cells around a cell, in the order of the sorted list.
//
// All invocations of a workgroup work for the same cell, so all of them read the same particle at the same time. It is
// read as a texel: software Vulkan fetches that three times as fast as it reads a storage buffer and passes the values
// on by subgroup shuffles.
//
// The includer defines `void visit(vec4 particle)`, with its position and the part of its volume that counts; with
// GATHER_SHIFTS, `void visit(vec4 particle, vec4 shift)`.
#include "gpu/texels.glsl"

TEXELS(sorted_texel, 13, 5)
#ifdef GATHER_SHIFTS
TEXELS(shift_texel, 14, 9)
#endif

void gather(uint cell)
{
    const uvec3 dims = grid_dims();
    for (uint row = 0u; row < 9u; row++) {
        const uvec2 run = neighbour_row(cell, row, dims);
        for (uint i = run.x; i < run.y; i++) {
            const vec4 particle = uintBitsToFloat(sorted_texel(i));
#ifdef GATHER_SHIFTS
            visit(particle, uintBitsToFloat(shift_texel(i)));
#else
            visit(particle);
#endif
        }
    }
}
