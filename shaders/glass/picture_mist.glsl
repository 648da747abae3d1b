// picture_mist.glsl - water too small for the map: the share of a texel that it covers, in whole numbers, so that
// sums do not
// depend on their order.
layout(scalar, set = 0, binding = 9) buffer Mist { uint mist[]; };

void add_mist_at(ivec2 texel, float share)
{
    const ivec2 size = ivec2(look.map_columns, look.map_rows);
    const bool on_map = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size));
    const uint whole = uint(share * float(VIRGA_GLASS_MIST_ONE) + 0.5);
    if (on_map && whole != 0u)
        atomicAdd(mist[uint(texel.x) + uint(texel.y) * look.map_columns], whole);
}

// For all tiles that what lies there reaches, in one loop: each place in a shader that sets flags costs, taken or not.
void mark_tiles(vec2 middle, float reach_m, uint flags)
{
    ivec2 first, last;
    tiles_around(middle, reach_m, first, last);
    for (int y = first.y; y <= last.y; y++)
        for (int x = first.x; x <= last.x; x++)
            atomicOr(tiles[tile_number(ivec2(x, y))].film, flags);
}

// The caller marks the tiles. A disc, spread over the four texels around its middle by how near they are: all of its
// area, wherever it lies.
void add_mist(vec2 middle, float radius_m, float share)
{
    const vec2 place = middle / texel_m() - 0.5, low = floor(place), t = place - low;
    const float covers = share * min(3.14159265 * radius_m * radius_m / (look.texel_m[0] * look.texel_m[1]), 4.0);
    add_mist_at(ivec2(low), covers * (1.0 - t.x) * (1.0 - t.y));
    add_mist_at(ivec2(low) + ivec2(1, 0), covers * t.x * (1.0 - t.y));
    add_mist_at(ivec2(low) + ivec2(0, 1), covers * (1.0 - t.x) * t.y);
    add_mist_at(ivec2(low) + ivec2(1, 1), covers * t.x * t.y);
}
