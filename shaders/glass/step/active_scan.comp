// active_scan.comp - list of active slots, second pass (begin_tick.comp is the first): prefix sum, and the sizes of the
// dispatches that follow.
// One workgroup. Reads: selection, the host's impacts. Writes: selection, the list's head, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#define COMPACT_GROUP VIRGA_GLASS_GROUP
#define COMPACT_SELECTION_BINDING 3
#define COMPACT_LIST_BINDING 16
#include "gpu/compact_scan.glsl"
#include "shared/impact.h"

layout(local_size_x = VIRGA_GLASS_GROUP) in;
layout(scalar, set = 0, binding = 14) readonly buffer Impacts { virga_impacts_gpu head; };

uint[3] groups_of(uint invocations)
{
    return uint[3]((invocations + VIRGA_GLASS_SMALL_GROUP - 1u) / VIRGA_GLASS_SMALL_GROUP, 1u, 1u);
}

void main()
{
    const uvec2 found = scan_selection(state.alive_groups[0], tick.pane.max_drops);
    if (gl_LocalInvocationIndex != 0u)
        return;
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
