// tile_fill.comp - adds each ball to the lists of the tiles that it reaches, in any order: as many entries as
// balls.comp counted, or none where a tile shows the same as before.
// One invocation per ball. Reads: balls, the tiles' ranges. Writes: entries.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "tiles.glsl"

layout(local_size_x = VIRGA_GLASS_FILL_GROUP) in;
layout(scalar, set = 0, binding = 8) writeonly buffer Entries { uint entries[]; };

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    const uint[2] reached = balls[min(i, max(work.balls, 1u) - 1u)].tiles;
    if (i < work.balls) {
        const uvec2 first = uvec2(reached[0], reached[1]) & 0xffffu, extent = uvec2(reached[0], reached[1]) >> 16;
        for (uint y = 0u; y < extent.y; y++)
            for (uint x = 0u; x < extent.x; x++) {
                const uint tile = tile_number(first + uvec2(x, y));
                if (tiles[tile].count != 0u)
                    entries[tiles[tile].first + atomicAdd(tiles[tile].filled, 1u)] = i;
            }
    }
}
