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
layout(set = 0, binding = 12) uniform sampler2DArray fields;
layout(location = 0) flat out uint beside;
layout(location = 1) flat out vec4 near_limits;
layout(location = 2) flat out vec4 far_limits;
layout(location = 3) flat out uint layers_there; // see overlay.frag
layout(location = 4) flat out vec4 per_texel;
layout(set = 0, binding = 35) uniform sampler2D coarse_far;

// With entries for every tile, one draw has all that are blended, whether they have a near field or not, and one all
// that overwrite the target.
bool is_drawn_as(uint found, uint drawn)
{
    return found == drawn || (drawn == VIRGA_LENS_TILES_BLURRED && found == VIRGA_LENS_TILES_FAR) ||
           (drawn == VIRGA_LENS_TILES_WIDE && found == VIRGA_LENS_TILES_SOFT);
}

// What the tile beside a tile has. Beyond the picture's edge nothing is read, see look_at in compose.glsl.
uint entry_beside(uvec2 tile, ivec2 step_of)
{
    const ivec2 at = ivec2(tile) + step_of, size = ivec2(view.tile_columns, view.tile_rows);
    const ivec2 there = clamp(at, ivec2(0), size - 1);
    return at == there ? listed[there.y * size.x + there.x] : VIRGA_LENS_HAS_NEAR | VIRGA_LENS_HAS_FINE;
}

// The first and the last middles of texels of a tile, in texture coordinates; without a limit where the tile beside it
// has that bit. `around`: entries to the left and right, above and below. A little less, so that no rounding, to 1/256
// of a texel on GPUs, lets in what is left beyond it of another picture.
const float LESS = 1.0 / 64.0; // texels
vec4 limits_of(uvec2 tile, uvec4 around, uint bit)
{
    const vec2 per_texel = 1.0 / vec2(textureSize(fields, 0).xy), first = vec2(tile * VIRGA_LENS_TILE);
    const vec4 ends = vec4(first + 0.5 + LESS, first + float(VIRGA_LENS_TILE) - 0.5 - LESS) * per_texel.xyxy;
    return mix(ends, vec4(vec2(-1.0), vec2(2.0)), notEqual(around.xzyw & bit, uvec4(0u)));
}

// A layer that is in focus has no words: it may be anywhere, and its own pixels are seen.
uint word_of_layer(uint layer, uint tile)
{
    const uint tiles = view.tile_columns * view.tile_rows, words = tiles * (1u + layer) + tile;
    if (((view.fine_layers | view.coarse_layers) >> layer & 1u) == 0u)
        return VIRGA_LENS_LAYER_FINE | VIRGA_LENS_LAYER_SEEN;
    uint word = 0u;
    if ((view.fine_layers >> layer & 1u) != 0u)
        word = listed[words];
    if ((view.coarse_layers >> layer & 1u) != 0u)
        word |= listed[words + tiles * VIRGA_LENS_LAYERS];
    return word;
}

uint layers_of_tile(uint tile)
{
    uint there = 0u;
    for (uint layer = 0u; layer < view.layers; layer++)
        there |= word_of_layer(layer, tile) << (VIRGA_LENS_LAYER_BITS * layer);
    return there;
}

void main()
{
    const uint entry = uint(gl_VertexIndex) / VIRGA_LENS_TILE_VERTICES;
    const uint vertex = uint(gl_VertexIndex) % VIRGA_LENS_TILE_VERTICES;
    const uint corner = 0xDA4u >> 2u * vertex & 3u; // 0 1 2 and 2 1 3; bits say whether it is right and at the bottom
    uvec2 tile;
    beside = VIRGA_LENS_HAS_NEAR;
    near_limits = far_limits = vec4(vec2(-1.0), vec2(2.0));
    layers_there = ~0u;
    per_texel = 1.0 / vec4(textureSize(fields, 0).xy, textureSize(coarse_far, 0));
    if ((kind & VIRGA_LENS_EVERY) == 0u) {
        tile = listed_tile(kind, entry);
    } else { // all tiles: those of another kind are drawn nowhere
        const uint found = listed[entry], drawn = kind & VIRGA_LENS_KIND_MASK;
        layers_there = layers_of_tile(entry);
        if (!is_drawn_as(found & VIRGA_LENS_KIND_MASK, drawn) ||
            (drawn == VIRGA_LENS_TILES_SHARP && layers_there == 0u)) {
            gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
            return;
        }
        tile = uvec2(entry % view.tile_columns, entry / view.tile_columns);
        beside = found;
        const uvec4 around = uvec4(entry_beside(tile, ivec2(-1, 0)), entry_beside(tile, ivec2(1, 0)),
                                   entry_beside(tile, ivec2(0, -1)), entry_beside(tile, ivec2(0, 1)));
        near_limits = limits_of(tile, around, VIRGA_LENS_HAS_NEAR);
        far_limits = limits_of(tile, around, VIRGA_LENS_HAS_FINE);
    }
    const uvec2 pixel = (tile + uvec2(corner & 1u, corner >> 1u)) * VIRGA_LENS_TILE * STEP;
    const uvec2 size = uvec2(view.width, view.height);
    gl_Position = vec4(vec2(min(pixel, size)) / vec2(size) * 2.0 - 1.0, 0.0, 1.0);
}
