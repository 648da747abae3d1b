// block_compact.comp - the list of blocks, third pass.
// One invocation per 32 cells. Reads: selection. Writes: the list.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 8
#define COMPACT_LIST_BINDING 10
#include "gpu/compact_write.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main() { write_own_word(); }
