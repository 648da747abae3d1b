// corner_tile.glsl - a vertex of the quad around everything that a tile shows. Include it after corner.glsl.
layout(scalar, set = 0, binding = 19) readonly buffer Corners { uint corners[]; }; // written by tile_quads.comp

#define OVERLAP (1.0 / 32.0) // texel

// Four vertices per quad: lower left, lower right, upper left, upper right.
Corner emit_tile_corner(uint vertex)
{
    const uint at = look.bounds_offset + vertex / 4u * 2u, tile = corners[at], box = corners[at + 1u];
    const float side = float(VIRGA_GLASS_TILE);
    vec2 low = max(vec2(box & 15u, box >> 4 & 15u) - 1.0 - look.beside, 0.0);
    vec2 high = min(vec2(box >> 8 & 15u, box >> 12 & 15u) + look.beside, side);
    // Two neighbouring tiles may have quads that share only a part of their border. Their vertices are rounded to
    // subpixels independently, which could leave a gap, so such quads overlap a little.
    const bvec2 in_part = lessThan((high - low).yx, vec2(side));
    low -= OVERLAP * vec2(in_part) * vec2(equal(low, vec2(0.0)));
    high += OVERLAP * vec2(in_part) * vec2(equal(high, vec2(side)));
    const bvec2 at_high = bvec2((vertex & 1u) != 0u, (vertex & 2u) != 0u);
    const vec2 texel = vec2(tile & 0xffffu, tile >> 16) * side + mix(low, high, at_high);
    return emit_corner(clamp(texel / vec2(look.map_columns, look.map_rows), vec2(0.0), vec2(1.0)));
}
