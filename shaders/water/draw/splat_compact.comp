// splat_compact.comp - the list of visible surfels, third pass.
// One invocation per 32 surfels. Reads: selection. Writes: the list.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 4
#define COMPACT_LIST_BINDING 5
#include "gpu/compact_write.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main() { write_own_word(); }
