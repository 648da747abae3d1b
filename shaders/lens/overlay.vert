// overlay.vert - the tiles of a list, as two triangles each, see overlay.frag.
// One invocation per vertex. Reads: lists.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#define LISTS_DRAWN
#include "lists.glsl"
#include "gpu/own_view.glsl"

layout(push_constant) uniform List { uint kind; }; // and perhaps VIRGA_LENS_EVERY
layout(location = 0) flat out uint beside;

// With entries for every tile, one draw has all that are blended, whether they have a near field or not.
bool is_drawn_as(uint found, uint drawn)
{
    return found == drawn || (drawn == VIRGA_LENS_TILES_BLURRED && found == VIRGA_LENS_TILES_FAR);
}

void main()
{
    const uint entry = uint(gl_VertexIndex) / VIRGA_LENS_TILE_VERTICES;
    const uint vertex = uint(gl_VertexIndex) % VIRGA_LENS_TILE_VERTICES;
    const uint corner = 0xDA4u >> 2u * vertex & 3u; // 0 1 2 and 2 1 3; bits say whether it is right and at the bottom
    uvec2 tile;
    beside = VIRGA_LENS_HAS_NEAR;
    if ((kind & VIRGA_LENS_EVERY) == 0u) {
        tile = listed_tile(kind, entry);
    } else { // all tiles: those of another kind are drawn nowhere
        const uint found = listed[entry];
        if (!is_drawn_as(found & VIRGA_LENS_KIND_MASK, kind & VIRGA_LENS_KIND_MASK)) {
            gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
            return;
        }
        tile = uvec2(entry % view.tile_columns, entry / view.tile_columns);
        beside = found;
    }
    const uvec2 pixel = (tile + uvec2(corner & 1u, corner >> 1u)) * VIRGA_LENS_TILE * STEP;
    const uvec2 size = uvec2(view.width, view.height);
    gl_Position = vec4(vec2(min(pixel, size)) / vec2(size) * 2.0 - 1.0, 0.0, 1.0);
}
