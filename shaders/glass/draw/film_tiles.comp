// film_tiles.comp - marks the tiles that have film with a shape. For software Vulkan: on a GPU mist.comp does it.
// One workgroup per block of cells that has such film. Reads: film. Writes: the tiles' flags.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "tiles.glsl"
#include "beads.glsl"

layout(local_size_x = 64) in;

bool has_shape(uint number)
{
    const uint water = film[number], wetted = passed[number];
    const float nl = float(water), fresh = film_fresh(water, wetted);
    const vec2 shapes = bead_shapes(bead_radii(number, nl, film_link(wetted), nl * (1.0 - fresh)));
    return water != 0u && ((look.sheets != 0u && fresh > 0.0) || shapes.x + shapes.y > 0.0);
}

void main()
{
    const uint block = work_list[2u * look.max_tiles + gl_WorkGroupID.x],
               side = VIRGA_GLASS_MIST_BLOCK * look.mist_cells;
    const uvec2 corner = uvec2(block & 0xffffu, block >> 16) * side;
    for (uint i = gl_LocalInvocationIndex; i < side * side; i += 64u) {
        const uvec2 cell = corner + uvec2(i % side, i / side);
        if (cell.x < look.pane.columns && cell.y < look.pane.rows && has_shape(cell.x + cell.y * look.pane.columns))
            mark_film_tiles(cell);
    }
}
