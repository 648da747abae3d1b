// source_scan.comp - the list of particles that make foam, second pass.
// One workgroup, in which each invocation takes a run of words. Reads and writes: selection, the list's head, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "foam.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 7
#define COMPACT_LIST_BINDING 13
#include "gpu/compact_scan.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    scan_selection(grid.sorted_groups[0], frame.particles);
    if (gl_LocalInvocationIndex != 0u)
        return;
    const uint words = grid.sorted_groups[0] * (VIRGA_WATER_LANES / 32u);
    state.foam_word_groups = uint[3]((words + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES, 1u, 1u);
}
