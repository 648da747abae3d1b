// tiles.glsl - balls, the tiles of the height map that they reach, and the work lists. Lists are in any order, because
// their entries are summed as integers.
layout(scalar, set = 0, binding = 6) buffer Balls { virga_glass_ball_gpu balls[]; };
layout(scalar, set = 0, binding = 7) buffer Tiles { virga_glass_tile_gpu tiles[]; };
layout(scalar, set = 0, binding = 18) buffer Work
{
    virga_glass_work_gpu work;
    uint work_list[];
};

#define TILE VIRGA_GLASS_TILE

// ---- what a tile shows
//
// Most water on a pane stands still from one picture to the next. So each tile knows what its texels were made of: the
// sum of a hash of each ball on it, and of what all tiles have in common. A sum does not depend on the order. Where it
// is that of the newest view, the tile's texels are those of that view to the bit, and nothing writes them. Two hashes
// have 64 bits together: with a million changes a second, one in 600,000 years would be taken for none.
//
// Film dries and breaks, a little everywhere. To look for it in each tile costs more than it saves where each view has
// ticks of its own, so tiles with film are kept within a tick only: film is the same there.

// Absorbs a word in both hashes.
uvec2 absorb(uvec2 hashes, uint word)
{
    return uvec2(virga_hash_absorb(hashes.x, word), virga_hash_absorb(hashes.y, word));
}

uvec2 absorb(uvec2 hashes, float number) { return absorb(hashes, floatBitsToUint(number)); }

#define BALL_HASH uvec2(0x243f6a88u, 0x85a308d3u) // pi: first words of hashes
#define FILM_HASH uvec2(0x13198a2eu, 0x03707344u)

// Heights are divided by this, about the radius of the view's widest ball. It is rounded up, to 1, 1.25, 1.5 or 1.75
// times a power of two: else it would change with every drop that runs.
float widest_m() { return uintBitsToFloat((work.highest + 0x1fffffu) & ~0x1fffffu); }

// Both hashes of what a tile shows besides balls. `fits`: the tile's balls are in its list.
uvec2 common_hash(bool fits, bool film)
{
    const uvec2 all_tiles = absorb(absorb(uvec2(look.map_seed[0], look.map_seed[1]), widest_m()), fits ? 1u : 0u);
    return film ? all_tiles + absorb(FILM_HASH, look.tick) : all_tiles;
}

vec2 tile_m() { return texel_m() * float(TILE); }

// The first and the last tile within `reach_m` of a point along u and along v. There are none if the last is before the
// first.
void tiles_around(vec2 middle, vec2 reach_m, out ivec2 first, out ivec2 last)
{
    const ivec2 last_tile = ivec2(look.tile_columns, look.tile_rows) - 1;
    first = max(ivec2(floor(clamp((middle - reach_m) / tile_m(), vec2(-1.0), vec2(1e4)))), ivec2(0));
    last = min(ivec2(floor(clamp((middle + reach_m) / tile_m(), vec2(-1.0), vec2(1e4)))), last_tile);
}

// In lists a tile is its column and row, u16 each: a pass over a list then has no division, which each invocation of a
// tile would repeat.
uint packed_tile(uvec2 tile) { return tile.x | tile.y << 16; }
ivec2 unpacked_tile(uint packed) { return ivec2(packed & 0xffffu, packed >> 16); }

uint tile_number(uvec2 tile) { return tile.x + tile.y * look.tile_columns; }

// The tiles of a ball, along u and along v: the first | their count << 16. Computed once and kept with the ball: the
// pass that sizes the tiles' lists and the one that fills them must agree, and two compilations of a formula may round
// differently.
uvec2 tiles_reached(vec2 middle, vec2 reach_m)
{
    ivec2 first, last;
    tiles_around(middle, reach_m, first, last);
    return uvec2(first) | uvec2(max(last - first + 1, ivec2(0))) << 16;
}

// The tiles that film with a shape on a cell reaches.
void film_tiles_of(uvec2 cell, out ivec2 first, out ivec2 last)
{
    tiles_around((vec2(cell) + 0.5) * look.pane.cell_m, vec2(1.6 * look.pane.cell_m), first, last);
}

void mark_film_tiles(uvec2 cell)
{
    ivec2 first, last;
    film_tiles_of(cell, first, last);
    for (int y = first.y; y <= last.y; y++)
        for (int x = first.x; x <= last.x; x++)
            atomicOr(tiles[tile_number(uvec2(x, y))].film, 1u);
}

// A ball's reach. Mist is spread over one texel. `stretch`: see virga_glass_ball_gpu; the ellipse whose points x have
// c |x|^2 + q (x^2 - y^2) + 2 p x y = 1, with c^2 = 1 + q^2 + p^2, ends at sqrt(c - q) along u.
vec2 ball_reach(float radius_m, float density_reach, vec2 stretch)
{
    const float c = sqrt(1.0 + dot(stretch, stretch));
    return max(radius_m * density_reach * sqrt(vec2(c - stretch.x, c + stretch.x)),
               max(look.texel_m[0], look.texel_m[1]));
}
