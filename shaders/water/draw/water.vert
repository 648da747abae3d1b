// water.vert - a triangle that covers the view, or the tiles of contact_tiles.comp.
// One invocation per corner. Reads: tiles.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "tiles.glsl"

#include "gpu/own_view.glsl"

void main()
{
    vec2 at = 4.0 * vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) - 1.0;
    if (gl_VertexIndex >= int(FIRST_CORNER)) {
        const int index = gl_VertexIndex - int(FIRST_CORNER), corner = index % TILE_CORNERS;
        const uint word = tile_words[index / TILE_CORNERS], x = uint(corner == 1 || corner == 2 || corner == 4),
                   y = uint(corner == 2 || corner >= 4);
        const uvec2 tile = uvec2(word & 0xfffu, word >> 12 & 0xfffu) + uvec2(x, y) * (word >> 24);
        const vec2 size = vec2(view.viewport[2], view.viewport[3]);
        at = min(2.0 * vec2(tile * VIRGA_WATER_TILE_PX) / size - 1.0, 1.0);
    }
    gl_Position = vec4(at, 0.0, 1.0);
}
