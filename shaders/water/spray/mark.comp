// mark.comp - the list of splash particles, first pass: selects particles of low density. Those of which others have
// water are selected whatever their density is, and first, so that none of them is forgotten.
//
// A particle whose droplets were handed over has no volume here, and one of which others have water has less.
// One invocation per sorted particle. Reads: densities, the last frame's splashes. Writes: selection, sorted.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "spray.glsl"
#include "water/packed_share.glsl"
#include "table.glsl"
#include "leaver.glsl"
#include "count.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 7
#define COMPACT_LIST_BINDING 9
#include "gpu/compact_mark.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

// Part of its volume that is here.
float part_here(uint particle, virga_leaver_gpu before, float part)
{
    const uint all = max(particle_nl(particle), 1u);
    const bool hidden = (before.flags & VIRGA_LEAVER_HANDED) != 0u && (!is_back(part) || frame.serial == 0u);
    return hidden ? 0.0 : float(own_nl(particle, given_before(before))) / float(all);
}

void main()
{
    const uint own = gl_GlobalInvocationID.x;
    uint kind = NOT_SELECTED;
    if (own < grid.sorted) {
        const uint particle = sorted_indices[own];
        const float part = spray_part(densities[particle]);
        const uint before = frame.looks_back == 0u ? frame.max_splashes : find_before(particles[particle].id);
        kind = part > 0.0 ? FIRST_KIND : NOT_SELECTED;
        if (before < frame.max_splashes) {
            const virga_leaver_gpu leaver = splashes[splash_before(before)];
            if (leaver.given_nl > 0u) {
                kind = SECOND_KIND;
                if (frame.serial != 0u && leaver.taken_nl > 0u)
                    count_taken(leaver.taken_nl);
                const float share = sorted[own].w;
                sorted[own].w =
                    with_share(share * part_here(particle, leaver, part), share_in(floatBitsToUint(share)));
            }
        }
    }
    mark_selected(kind);
}
