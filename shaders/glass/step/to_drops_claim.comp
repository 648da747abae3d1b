// to_drops_claim.comp - particles that left the bands beside the blades become drops again. Here each claims the cell
// at its position, unless a large drop is near (section 4.6). Particles over the edge are removed.
// One invocation per particle. Reads: positions, blades, occupants. Writes: drops, claims, the grid (cleared).
// Paper: Goto et al. 2009, sections 4.5 and 4.6.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#define FEW
#include "live.glsl"
#include "blades.glsl"
#include "particles.glsl"

bool near_large_drop(ivec2 cell)
{
    const int reach = int(tick.hold_back_cells);
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            const ivec2 near = cell + ivec2(x, y);
            if (!on_pane(near))
                continue;
            const uint other = occupants[cell_number(near)];
            if (other != 0u && drops[other - 1u].water_nl >= tick.hold_back_nl)
                return true;
        }
    return false;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= state.active_particles)
        return;
    const uint slot = slot_of_active(i);
    grid[drops[slot].cell] = 0u; // every particle clears its cell: a tick begins with an empty grid
    if (i == 0u)
        places[places_taken()] = 0u;
    if ((drops[slot].kind & VIRGA_GLASS_KIND) != VIRGA_GLASS_PARTICLE)
        return; // it has merged
    const vec2 at = to_vec2(drops[slot].position);
    const ivec2 cell = cell_at(at);
    const bool in_a_band = is_in_band(at);
    if (!has_glass(at)) {
        const bool wiped = in_a_band || (drops[slot].kind & VIRGA_GLASS_PUSHED) != 0u;
        count(wiped ? VIRGA_GLASS_WIPED : VIRGA_GLASS_RUN_OFF, drops[slot].water_nl + drops[slot].merged_nl);
        drops[slot].kind = VIRGA_GLASS_FREE;
        drops[slot].water_nl = drops[slot].merged_nl = 0u;
        drops[slot].merged_momentum = drops[slot].merged_nl_10um = int[2](0, 0);
        return;
    }
    if (in_a_band)
        return;
    drops[slot].kind |= VIRGA_GLASS_WAITING; // until it wins a cell
    if (near_large_drop(cell))
        return;
    drops[slot].target = cell_number(cell);
    atomicMin(claims[cell_count() + cell_number(cell)], slot);
}
