// fog_grow.comp - vapour condenses on the glass, or fog evaporates. Where a drop sits the water joins it. Where
// droplets have grown large enough they become a drop of the pane; on the inside, where the pane has none, they run
// off. One workgroup per block of cells whose turn it is, one invocation per cell. Reads: occupants, what simulated
// water does. Writes: fog, drops, seeds, counters.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "fog.glsl"
#include "vapour.glsl"
#include "flood.glsl"
#include "seeds.glsl"

layout(local_size_x = VIRGA_GLASS_FILM_BLOCK, local_size_y = VIRGA_GLASS_FILM_BLOCK) in;

#define SITES_ALONG (VIRGA_GLASS_FILM_BLOCK / VIRGA_GLASS_FOG_SITE)
#define SITES (SITES_ALONG * SITES_ALONG)
#define UNEVEN vec2(0.6, 1.4) // glass lets droplets merge early or late: of the mean amount from which they are a drop

shared uint condensed[2], ripest[SITES]; // (site) its cell with most fog: that, and the cell's number in the block

// The change since the cell's last turn. Returns the fog then.
uint exchange(uint cell, uint here)
{
    const float gain = condensing_pl(cell_middle(cell));
    const uint amount = round_randomly(abs(gain), virga_hash3(tick.pane.seed ^ 0x666f6763u, tick.tick, cell));
    if (gain < 0.0) {
        const uint lost = min(amount, here);
        add_dried(lost);
        return here - lost;
    }
    atomicAdd(condensed[0], amount % 1000000u);
    if (amount >= 1000000u)
        atomicAdd(condensed[1], amount / 1000000u);
    return here + amount;
}

bool is_ripe(uint cell, uint here)
{
    const float random = virga_unit(virga_hash3(tick.pane.seed, 0x72697065u, cell));
    return float(here) >= tick.fog_drop_pl * mix(UNEVEN.x, UNEVEN.y, random) && here >= PL_OF_NL;
}

// On the outside: what lies on the cell takes whole nanolitres of the fog. Returns what is left.
uint give_outside(uint cell, uint here)
{
    if (is_under_water(cell)) {
        count(VIRGA_GLASS_JOINED, here / PL_OF_NL);
        atomicAdd(fog_given, here / PL_OF_NL);
        add_dried(here % PL_OF_NL);
        return 0u;
    }
    const uint occupant = occupants[cell];
    if (occupant == 0u)
        return here;
    drops[occupant - 1u].water_nl += here / PL_OF_NL; // a drop has one cell, so one invocation
    atomicAdd(fog_given, here / PL_OF_NL);
    return here % PL_OF_NL;
}

void give_inside(uint cell, inout uint here)
{
    if (!is_ripe(cell, here))
        return;
    count(VIRGA_GLASS_RUN_OFF, here / PL_OF_NL);
    atomicAdd(fog_given, here / PL_OF_NL);
    here %= PL_OF_NL;
}

uint site_of(uvec2 local)
{
    const uvec2 site = local / VIRGA_GLASS_FOG_SITE;
    return site.x + site.y * SITES_ALONG;
}

// The drop of a site, of the fog on one of its cells.
void write_seed(uint site, uint cell, bool ripe, inout uint here)
{
    const uint number = seed_count() - tick.fog_sites + gl_WorkGroupID.x * SITES + site;
    seeds[number].water_nl = 0u;
    if (!ripe)
        return;
    const uint hash = virga_hash3(tick.pane.seed, tick.tick, cell);
    const vec2 shift = vec2(virga_unit(virga_hash2(hash, 1u)), virga_unit(virga_hash2(hash, 2u))) - 0.5;
    seeds[number] = virga_glass_seed_gpu(to_array(to_pane(cell_middle(cell) + 0.8 * shift * tick.pane.cell_m)),
                                         float[2](0.0, 0.0), here / PL_OF_NL, 0u, 0u, cell, hash, VIRGA_GLASS_DROP);
    atomicAdd(fog_given, here / PL_OF_NL);
    here %= PL_OF_NL;
}

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u)
        condensed[0] = condensed[1] = 0u;
    if (lane < SITES)
        ripest[lane] = 0u;
    begin_fog_sums(); // has a barrier
    const uvec2 blocks = film_block_counts(), local = gl_LocalInvocationID.xy;
    const uint block = gl_WorkGroupID.x * VIRGA_GLASS_FOG_TURNS + tick.tick % VIRGA_GLASS_FOG_TURNS;
    const ivec2 at = ivec2(uvec2(block % blocks.x, block / blocks.x) * VIRGA_GLASS_FILM_BLOCK + local);
    const bool inside = block < blocks.x * blocks.y && on_pane(at);
    const uint cell = inside ? cell_number(at) : 0u;
    uint here = inside ? exchange(cell, film[fog_word(cell)]) : 0u;
    if (inside && tick.fog_side == VIRGA_GLASS_FOG_INSIDE)
        give_inside(cell, here);
    else if (inside)
        here = give_outside(cell, here);
    const bool ripe = inside && tick.fog_sites != 0u && occupants[cell] == 0u && is_ripe(cell, here);
    if (ripe)
        atomicMax(ripest[site_of(local)], min((here >> 4u) + 1u, 0xffffffu) << 8u | lane);
    barrier();
    const uint chosen = ripest[site_of(local)];
    const bool first = all(equal(local % VIRGA_GLASS_FOG_SITE, uvec2(0u)));
    if (tick.fog_sites != 0u && (chosen == 0u ? first : (chosen & 0xffu) == lane))
        write_seed(site_of(local), cell, ripe, here);
    if (inside)
        film[fog_word(cell)] = here;
    end_fog_sums();
    if (lane == 0u)
        count_pl(VIRGA_GLASS_CONDENSED, condensed[1], condensed[0]);
}
