// active_compact.comp - the list of them.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#define COMPACT_GROUP VIRGA_GLASS_GROUP
#define COMPACT_PICKS_BINDING 3
#define COMPACT_LIST_BINDING 16
#include "gpu/compact_write.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

void main() { list_pick(gl_GlobalInvocationID.x); }
