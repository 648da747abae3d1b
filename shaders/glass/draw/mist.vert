// mist.vert - vertices of the blocks with mist.
// One invocation per vertex of the grid of blocks. Reads: nodes, the view. Writes: position, light of the mist.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/light.glsl"
#include "corner.glsl"
#include "corner_light.glsl"

// xy: texels of the mist map in use; zw: scale of its texture coordinates, per metre
layout(location = 14) flat out vec4 mist_grid;

#include "gpu/own_view.glsl"

void main()
{
    mist_grid = vec4(look.mist_columns, look.mist_rows, look.mist_scale[0], look.mist_scale[1]);
    const uint columns = look.mist_pitch / VIRGA_GLASS_MIST_BLOCK + 1u, number = uint(gl_VertexIndex);
    const float block_m = float(VIRGA_GLASS_MIST_BLOCK * look.mist_cells) * look.pane.cell_m;
    const vec2 at = vec2(number % columns, number / columns) * block_m;
    light_corner(emit_corner(min(at / vec2(look.pane.width_m, look.pane.height_m), vec2(1.0))));
}
