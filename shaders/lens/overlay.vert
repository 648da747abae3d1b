// overlay.vert - the tiles of a list, as two triangles each, see overlay.frag.
// One invocation per vertex. Reads: lists.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#define LISTS_DRAWN
#include "lists.glsl"
#include "gpu/own_view.glsl"

layout(push_constant) uniform List { uint kind; };

void main()
{
    const uint entry = uint(gl_VertexIndex) / VIRGA_LENS_TILE_VERTICES;
    const uint vertex = uint(gl_VertexIndex) % VIRGA_LENS_TILE_VERTICES;
    const uint corner = 0xDA4u >> 2u * vertex & 3u; // 0 1 2 and 2 1 3; bits say whether it is right and at the bottom
    const uvec2 pixel = (listed_tile(kind, entry) + uvec2(corner & 1u, corner >> 1u)) * VIRGA_LENS_TILE * STEP;
    const uvec2 size = uvec2(view.width, view.height);
    gl_Position = vec4(vec2(min(pixel, size)) / vec2(size) * 2.0 - 1.0, 0.0, 1.0);
}
