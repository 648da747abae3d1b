// to_drops_claim.comp - particles that left the bands beside the blades become drops again (Goto et al. 2009,
// section 4.5),
// each in the cell that it claims, but not while a large drop is near (section 4.6). What is over the edge is gone.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#define FEW
#include "live.glsl"
#include "blades.glsl"
#include "particles.glsl"

bool held_back(ivec2 cell)
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
    if (i >= state.awake_particles)
        return;
    const uint place = place_of_awake(i);
    const vec2 at = moved[moved_at(i, 0u)]; // after an even number of rounds
    grid[drops[place].cell] = 0u; // by all that hang on this head: a tick begins with an empty grid
    drops[place].position = to_array(at);
    const ivec2 cell = cell_at(at);
    const bool beside = in_band(at);
    if (!has_glass(at)) {
        const bool wiped = beside || (drops[place].kind & VIRGA_GLASS_PUSHED) != 0u;
        count(wiped ? VIRGA_GLASS_WIPED : VIRGA_GLASS_RUN_OFF, drops[place].water_nl + drops[place].merged_nl);
        drops[place].kind = VIRGA_GLASS_FREE;
        drops[place].water_nl = drops[place].merged_nl = 0u;
        drops[place].merged_momentum = drops[place].merged_nl_10um = int[2](0, 0);
        return;
    }
    if (beside)
        return;
    drops[place].kind |= VIRGA_GLASS_HELD; // until it wins its cell
    if (held_back(cell))
        return;
    drops[place].target = cell_number(cell);
    atomicMin(claims[cell_count() + cell_number(cell)], place);
}
