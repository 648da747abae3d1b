// active_compact.comp - list of active slots, third pass: writes their indices in the live list, particles first.
// One invocation per live slot. Reads: selection. Writes: the active list.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#define COMPACT_GROUP VIRGA_GLASS_GROUP
#define COMPACT_SELECTION_BINDING 3
#define COMPACT_LIST_BINDING 16
#include "gpu/compact_write.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

void main() { write_slot(gl_GlobalInvocationID.x); }
