// picture_tiles.glsl - balls, the tiles of the map that they reach, and how much there is to do.
// In any order: what they come to is added up in whole numbers.
layout(scalar, set = 0, binding = 6) buffer Balls { virga_glass_ball_gpu balls[]; };
layout(scalar, set = 0, binding = 7) buffer Tiles { virga_glass_tile_gpu tiles[]; };
layout(scalar, set = 0, binding = 18) buffer Work { virga_glass_work_gpu work; uint wet[]; };

vec2 tile_m() { return texel_m() * float(VIRGA_GLASS_TILE); }

// First and last tile that what lies within `reach_m` of a place reaches; none where the last lies before the first.
void tiles_around(vec2 middle, float reach_m, out ivec2 first, out ivec2 last)
{
    const ivec2 most = ivec2(look.tile_columns, look.tile_rows) - 1;
    first = max(ivec2(floor(clamp((middle - reach_m) / tile_m(), vec2(-1.0), vec2(1e4)))), ivec2(0));
    last = min(ivec2(floor(clamp((middle + reach_m) / tile_m(), vec2(-1.0), vec2(1e4)))), most);
}

uint tile_number(ivec2 tile) { return uint(tile.x) + uint(tile.y) * look.tile_columns; }

// A ball's reach: mist is spread over a texel.
float ball_reach(float radius_m, float density_reach)
{
    return max(radius_m * density_reach, max(look.texel_m[0], look.texel_m[1]));
}
