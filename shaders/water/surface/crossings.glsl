// crossings.glsl - the edges of a block's grid that the surface crosses: between two points of which one is inside the
// water. A block has the edges that begin at its points and lead to the next point along x, y and z. The edges of an
// axis are 64 bits, by the number of the point that they begin at.

// The bits of a block's points; `known` is 0 where there is no block, and the surface does not come there.
struct Points {
    uvec2 inside, known;
};

Points points_of(uint block)
{
    if (block == NO_BLOCK)
        return Points(uvec2(0u), uvec2(0u));
    return Points(block_insides[block], uvec2(0xffffffffu));
}

// Bits of the points that follow on an axis: from the same block, and at its high face from the next one.
uvec2 next_x(uvec2 own, uvec2 next) { return (own >> 1 & 0x77777777u) | (next << 3 & 0x88888888u); }
uvec2 next_y(uvec2 own, uvec2 next) { return (own >> 4 & 0x0fff0fffu) | (next << 12 & 0xf000f000u); }
uvec2 next_z(uvec2 own, uvec2 next) { return uvec2(own.x >> 16 | own.y << 16, own.y >> 16 | next.x << 16); }

struct Crossings {
    uvec2 edges[3]; // for each axis
};

Crossings crossings_of(uint cell, uint block)
{
    const uvec3 dims = grid_dims();
    const Points own = points_of(block), x = points_of(block_of[cell + 1u]), y = points_of(block_of[cell + dims.x]),
                 z = points_of(block_of[cell + dims.x * dims.y]);
    Crossings found;
    found.edges[0] = (own.inside ^ next_x(own.inside, x.inside)) & next_x(own.known, x.known);
    found.edges[1] = (own.inside ^ next_y(own.inside, y.inside)) & next_y(own.known, y.known);
    found.edges[2] = (own.inside ^ next_z(own.inside, z.inside)) & next_z(own.known, z.known);
    return found;
}
