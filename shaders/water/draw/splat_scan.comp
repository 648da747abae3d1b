// splat_scan.comp - the list of visible surfels, second pass.
// One workgroup, in which each invocation takes a run of words. Reads and writes: selection, the list's head, prepared.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#define STATE_ACCESS readonly
#include "water/state.glsl"
#include "prepared.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 4
#define COMPACT_LIST_BINDING 5
#include "gpu/compact_scan.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint found = scan_selection(state.surfel_groups[0], look.max_splats).x;
    if (gl_LocalInvocationIndex != 0u)
        return;
    prepared.vertices = 3u * min(found, look.max_splats);
    prepared.instances = 1u;
    prepared.first_vertex = prepared.first_instance = 0u;
    const uint words = state.surfel_groups[0] * GROUP_WORDS;
    prepared.word_groups = uint[3]((words + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES, 1u, 1u);
}
