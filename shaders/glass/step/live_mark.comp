// live_mark.comp - live list, first pass: marks live and free slots. See gpu/compact_buffers.glsl.
// One invocation per slot. Reads: drops. Writes: selection (second kind: live, first kind: free).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "live_list.glsl"
#include "gpu/compact_mark.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

void main() { mark_selected(kind_of(drops[gl_GlobalInvocationID.x]) == VIRGA_GLASS_FREE ? FIRST_KIND : SECOND_KIND); }
