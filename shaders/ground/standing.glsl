// standing.glsl - water on ground where no drop was counted: what stood in the same rain for as long has as much. Needs
// cells.glsl. engine/ground/standing.c keeps count of it, material by material, in the open and under cover.
#define FAR_BUMP_UM 10.0

// `open_share`: of the rain that reaches the place. Hollows fill with rain where the place is level.
virga_standing_gpu standing_at(uint material, float open_share, float level_share)
{
    const virga_standing_gpu open = tick.standing[material];
    virga_standing_gpu place = tick.standing[VIRGA_GROUND_MATERIALS + material];
    // Written so that it is exact where both are the same.
    place.held += (open.held - place.held) * open_share;
    place.film_nl += (open.film_nl - place.film_nl) * open_share;
    place.level_um += (open.level_um - place.level_um) * (open_share * level_share);
    place.spots += (open.spots - place.spots) * open_share;
    return place;
}

// Rain that fell before stands in the hollows; on the humps is only what their roughness holds.
virga_cell_gpu water_standing(virga_standing_gpu standing, virga_soil_gpu soil, float bump_um)
{
    const float hump_um = max(bump_um + 0.5 * soil.bumps_um, 0.0);
    const float depth_um = max(standing.level_um - hump_um, 0.0);
    const uint free_nl = max(uint(depth_um * float(tick.nl_per_um)), uint(standing.film_nl));
    virga_cell_gpu cell = virga_cell_gpu(soil.drain != 0u ? 0u : free_nl, soil.capacity_nl);
    if (cell.free_nl == 0u)
        cell.held_nl = min(uint(float(soil.capacity_nl) * standing.held), soil.capacity_nl);
    return cell;
}

// Of 8 x 8 bits as many as spots cover, by lot: each bit of that share, from the lowest on, halves what there is and
// adds a half or not.
uvec2 spots_standing(float spots, uint hash)
{
    const uint share = uint(round((1.0 - exp(-spots)) * 64.0));
    uvec2 bits = uvec2(0u);
    for (uint i = 0u; i < 6u; i++) {
        const uvec2 coins = uvec2(virga_hash2(hash, 2u * i), virga_hash2(hash, 2u * i + 1u));
        bits = (share >> i & 1u) != 0u ? bits | coins : bits & coins;
    }
    return share >= 64u ? uvec2(0xffffffffu) : bits;
}

// ---- a cell of the far map, packed

uint far_traits(uint material, float open_share, float level_share, float bump_um)
{
    const int bump = int(clamp(round(bump_um / FAR_BUMP_UM), -32768.0, 32767.0));
    return material | uint(round(open_share * 15.0)) << 8 | uint(round(level_share * 15.0)) << 12 | uint(bump) << 16;
}

float far_open(uint traits) { return float(traits >> 8 & 15u) / 15.0; }
float far_level(uint traits) { return float(traits >> 12 & 15u) / 15.0; }
float far_bump_um(uint traits) { return float(int(traits) >> 16) * FAR_BUMP_UM; }
