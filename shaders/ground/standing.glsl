// standing.glsl - water on ground where no drops were counted: as much as on all ground that was in the same rain for
// as long. Include cells.glsl before. engine/ground/standing.c tracks it, per material, in the open and under cover.
#define FAR_BUMP_UM 10.0

// `open_share`: the part of the rain that reaches the position. `level_share`: how level it is; only level ground has
// puddles.
virga_standing_gpu standing_at(uint material, float open_share, float level_share)
{
    const virga_standing_gpu open = tick.standing[material];
    virga_standing_gpu local = tick.standing[VIRGA_GROUND_MATERIALS + material];
    // Written so that it is exact where both are equal.
    local.held += (open.held - local.held) * open_share;
    local.film_nl += (open.film_nl - local.film_nl) * open_share;
    local.level_um += (open.level_um - local.level_um) * (open_share * level_share);
    local.spots += (open.spots - local.spots) * open_share;
    return local;
}

// Earlier rain stands in the hollows; humps have only what their roughness holds.
uint free_standing_nl(virga_standing_gpu standing, virga_soil_gpu soil, float bump_um)
{
    const float hump_um = max(bump_um + 0.5 * soil.bumps_um, 0.0);
    const float depth_um = max(standing.level_um - hump_um, 0.0);
    const uint free_nl = max(uint(depth_um * float(tick.nl_per_um)), uint(standing.film_nl));
    return soil.drain != 0u ? 0u : free_nl;
}

// In the pores where no water is free. Under free water they are full.
uint held_standing_nl(virga_standing_gpu standing, virga_soil_gpu soil)
{
    return min(uint(float(soil.capacity_nl) * standing.held), soil.capacity_nl);
}

virga_cell_gpu water_standing(virga_standing_gpu standing, virga_soil_gpu soil, float bump_um)
{
    virga_cell_gpu cell = virga_cell_gpu(free_standing_nl(standing, soil, bump_um), soil.capacity_nl);
    if (cell.free_nl == 0u)
        cell.held_nl = held_standing_nl(standing, soil);
    return cell;
}

// Random bits of 8 x 8, with the fraction that spots cover. For each bit of that fraction, from the lowest on: OR with
// random bits if it is set, else AND.
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

// ---- a packed cell of the far map

uint far_traits(uint material, float open_share, float level_share, float bump_um)
{
    const int bump = int(clamp(round(bump_um / FAR_BUMP_UM), -32768.0, 32767.0));
    return material | uint(round(open_share * 15.0)) << 8 | uint(round(level_share * 15.0)) << 12 | uint(bump) << 16;
}

float far_open(uint traits) { return float(traits >> 8 & 15u) / 15.0; }
float far_level(uint traits) { return float(traits >> 12 & 15u) / 15.0; }
float far_bump_um(uint traits) { return float(int(traits) >> 16) * FAR_BUMP_UM; }
