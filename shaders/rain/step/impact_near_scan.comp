// impact_near_scan.comp - impacts, first list, scan: prefix sum of the selection.
// One workgroup. Reads: selection. Writes: selection, the list's head.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_scan.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

void main() { scan_selection(tick.groups, tick.groups * VIRGA_RAIN_GROUP); }
