// active_counts.glsl - what follows from the numbers of active drops (x) and particles (y): the sizes of the dispatches
// of the tick. By one invocation.
#include "shared/impact.h"

layout(scalar, set = 0, binding = 14) readonly buffer Impacts { virga_impacts_gpu head; };

uint[3] groups_of(uint invocations)
{
    return uint[3]((invocations + VIRGA_GLASS_SMALL_GROUP - 1u) / VIRGA_GLASS_SMALL_GROUP, 1u, 1u);
}

void write_active_counts(uvec2 found)
{
    state.active_count = found.x + found.y;
    state.active_particles = found.y;
    state.active_groups = groups_of(found.x + found.y);
    state.particle_groups = groups_of(found.y);
    state.impacts = tick.impacts == 0u ? 0u : min(head.count, tick.impacts);
    const uint all =
        landing_count() + found.x + found.y + tick.blade_count * VIRGA_GLASS_BINS + tick.sites + tick.fog_sites;
    state.seed_groups = groups_of(all);
    state.settle_groups = groups_of(max(all, state.alive));
    for (uint i = 0u; i < VIRGA_GLASS_ROUNDS; i++) { // one round more than moves: the last one records
        state.round_groups[3u * i] = i <= state.max_rounds ? state.active_groups[0] : 0u;
        state.round_groups[3u * i + 1u] = state.round_groups[3u * i + 2u] = 1u;
    }
}
