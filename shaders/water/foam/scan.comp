// scan.comp - the list of slots, second pass: slots in use come first.
// One workgroup, in which each invocation takes a run of words. Reads and writes: selection, the list's head, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "foam.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 7
#define COMPACT_LIST_BINDING 9
#include "gpu/compact_scan.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint in_use = scan_selection((frame.max_foam + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES, frame.max_foam).y;
    if (gl_LocalInvocationIndex == 0u)
        state.foam = in_use;
}
