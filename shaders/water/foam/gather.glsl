// gather.glsl - visits the sorted particles in the 27 cells around a cell, in the order of the sorted list.
//
// The includer defines `void visit(uint sorted_index, vec4 particle)`, with its position and the part of its volume
// that counts.
#include "gpu/texels.glsl"

TEXELS(sorted_texel, 15, 5)

void gather(uint cell)
{
    const uvec3 dims = grid_dims();
    for (uint row = 0u; row < 9u; row++) {
        const uvec2 run = neighbour_row(cell, row, dims);
        for (uint i = run.x; i < run.y; i++)
            visit(i, uintBitsToFloat(sorted_texel(i)));
    }
}
