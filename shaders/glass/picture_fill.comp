// picture_fill.comp - balls enter themselves in the lists of the tiles that they reach, in any order: the gathering
// pass adds in
// whole numbers.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "picture_density.glsl"
#include "picture_tiles.glsl"

layout(local_size_x = VIRGA_GLASS_FILL_GROUP) in;
layout(scalar, set = 0, binding = 8) writeonly buffer Entries { uint entries[]; };

layout(scalar, set = 0, binding = 10) readonly buffer Counts { uint ball_count, cut_count; };

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i < ball_count) {
        ivec2 first, last;
        tiles_around(vec2(balls[i].middle[0], balls[i].middle[1]), balls[i].radius_m * density_reach(), first, last);
        for (int y = first.y; y <= last.y; y++)
            for (int x = first.x; x <= last.x; x++) {
                const uint tile = tile_number(ivec2(x, y));
                if (tiles[tile].count != 0u)
                    entries[tiles[tile].first + atomicAdd(tiles[tile].filled, 1u)] = i;
            }
    }
}
