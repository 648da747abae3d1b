// reach.glsl - how far a tile has to look for what reaches it: the largest circles of confusion, of each kind, and the
// levels of blocks that those discs are in, as the tiles around it told it (tile.comp). At half resolution it puts the
// tile into a list by what reaches it. It also says how many workgroups make blocks: none where no disc is wide.
// The includer has lens.glsl, lists.glsl and levels.glsl.
layout(std430, set = 0, binding = 10) writeonly buffer Reaches { vec4 reaches[]; };

// Up to POINT there is no near field.
uint kind_of(vec2 reach)
{
    if (reach.x > POINT)
        return VIRGA_LENS_TILES_BLURRED;
    return is_sharp(reach) ? VIRGA_LENS_TILES_SHARP : VIRGA_LENS_TILES_FAR;
}

void add_to_list(uint kind, uint tile)
{
    const uint entry = atomicAdd(lists[kind].count, 1u);
    const uint columns = min(entry + 1u, VIRGA_LENS_LIST_ROW), rows = entry / VIRGA_LENS_LIST_ROW + 1u;
    listed[kind * view.tile_columns * view.tile_rows + entry] =
        entry_of(uvec2(tile % view.tile_columns, tile / view.tile_columns));
    if (IN_PLACE)
        atomicMax(lists[kind].vertices, VIRGA_LENS_TILE_VERTICES * (entry + 1u));
    atomicMax(lists[kind].groups_y, columns);
    atomicMax(lists[kind].groups_z, rows);
}

// Whether a layer that is all at one depth needs blocks.
bool plane_needs_blocks()
{
    bool plane = false;
    for (uint i = 0u; i < view.layers; i++)
        plane = plane || (view.layer_inv_m[i] > 0.0 && level_of(circle(view.layer_inv_m[i])) > 0u);
    return plane;
}

void need_blocks()
{
    const ivec2 groups = ivec2(max(level_size(1u).x, level_size(2u).x + level_size(3u).x), blocks_rows()) / 8;
    atomicMax(lists[VIRGA_LENS_LIST_OF_BLOCKS].groups_x, uint(groups.x));
    atomicMax(lists[VIRGA_LENS_LIST_OF_BLOCKS].groups_y, VIRGA_LENS_BLOCK_KINDS * uint(groups.y));
    atomicMax(lists[VIRGA_LENS_LIST_OF_BLOCKS].groups_z, 1u);
}

void reach_tile(uint tile, virga_lens_tile_gpu told)
{
    const uint fine = level_bit(0u, 0u) | level_bit(1u, 0u) | level_bit(2u, 0u);
    if (told.levels != 0u)
        atomicOr(lists[0].levels, told.levels);
    if ((told.levels & ~fine) != 0u || (tile == 0u && plane_needs_blocks()))
        need_blocks();
    const vec3 reach = uintBitsToFloat(uvec3(told.near, told.far, told.layers));
    reaches[tile] = vec4(reach, float(told.told & ~VIRGA_LENS_SAMPLED));
    if (HALVED)
        add_to_list(kind_of(reach.xy), tile);
}
