// to_drops.comp - of the particles that claimed a cell one becomes a drop, or joins the one that is there.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#define FEW
#include "live.glsl"
#include "rounds.glsl"

void main()
{
    if (gl_GlobalInvocationID.x >= state.awake_particles)
        return;
    const uint place = place_of_awake(gl_GlobalInvocationID.x);
    const virga_glass_drop_gpu drop = drops[place];
    if (kind_of(drop) != VIRGA_GLASS_PARTICLE || drop.target == NOWHERE || claims[cell_count() + drop.target] != place)
        return;
    const uint occupant = occupants[drop.target];
    count(VIRGA_GLASS_TO_DROPS, 1u);
    if (occupant != 0u) {
        give_to(occupant - 1u, drop);
        end_drop(place);
        count(VIRGA_GLASS_MERGED, 1u);
        return;
    }
    occupants[drop.target] = place + 1u;
    drops[place].cell = drops[place].from_cell = drop.target;
    drops[place].ahead_m = 0.0;
    drops[place].tail_m = 0.0;
    drops[place].kind = VIRGA_GLASS_DROP | VIRGA_GLASS_CHANGED;
}
