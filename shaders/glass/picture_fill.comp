// picture_fill.comp - balls enter themselves in the lists of the tiles that they reach, in any order: the gathering
// pass adds in whole numbers.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "picture_density.glsl"
#include "picture_tiles.glsl"

layout(local_size_x = VIRGA_GLASS_FILL_GROUP) in;
layout(scalar, set = 0, binding = 8) writeonly buffer Entries { uint entries[]; };

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    const virga_glass_ball_gpu ball = balls[min(i, max(work.balls, 1u) - 1u)];
    if (i < work.balls) {
        ivec2 first, last;
        tiles_around(vec2(ball.middle[0], ball.middle[1]),
                     ball_reach(ball.peak > 0.0 ? ball.radius_m : 0.0, density_reach()), first, last);
        for (int y = first.y; y <= last.y; y++)
            for (int x = first.x; x <= last.x; x++) {
                const uint tile = tile_number(ivec2(x, y));
                if (tiles[tile].count != 0u)
                    entries[tiles[tile].first + atomicAdd(tiles[tile].filled, 1u)] = i;
            }
    }
}
