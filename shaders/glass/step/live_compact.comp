// live_compact.comp - live list, third pass: writes the slots.
// One invocation per slot. Reads: selection. Writes: the live list.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "live_list.glsl"
#include "gpu/compact_write.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

void main() { write_slot(gl_GlobalInvocationID.x); }
