// corner_tile.glsl - a corner of the box around all that a tile has to show. After corner.glsl.
layout(scalar, set = 0, binding = 19) readonly buffer Corners { uint corners[]; }; // as tile_quads.comp writes them

#define OVERLAP (1.0 / 32.0) // texel

// Four to a box: low left, low right, high left, high right.
Corner place_tile_corner(uint vertex)
{
    const uint at = look.box_word + vertex / 4u * 2u, number = corners[at], box = corners[at + 1u];
    const float side = float(VIRGA_GLASS_TILE);
    vec2 low = max(vec2(box & 15u, box >> 4 & 15u) - 1.0 - look.beside, 0.0);
    vec2 high = min(vec2(box >> 8 & 15u, box >> 12 & 15u) + look.beside, side);
    // Of two tiles side by side one may have less of their border than the other. Their corners are rounded to parts of
    // pixels then, each for itself, and between them there might be a gap.
    const bvec2 in_part = lessThan((high - low).yx, vec2(side));
    low -= OVERLAP * vec2(in_part) * vec2(equal(low, vec2(0.0)));
    high += OVERLAP * vec2(in_part) * vec2(equal(high, vec2(side)));
    const bvec2 at_high = bvec2((vertex & 1u) != 0u, (vertex & 2u) != 0u);
    const vec2 texel = vec2(number % look.tile_columns, number / look.tile_columns) * side + mix(low, high, at_high);
    return place_corner(clamp(texel / vec2(look.map_columns, look.map_rows), vec2(0.0), vec2(1.0)));
}
