// streak_scan.comp - streaks, scan: prefix sum of the selection, and the draw of wide streaks (the others are known
// after order_indices.comp). Clears the counts of order_count.comp.
// One workgroup. Reads: selection. Writes: selection, the list's head, draw arguments, counts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "view.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_scan.glsl"
#include "order.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(scalar, set = 0, binding = 6) writeonly buffer Prepared { virga_prepared_gpu prepared; };

void main()
{
    order[total_index(gl_LocalInvocationIndex)] = 0u;
    const uvec2 found = scan_selection(tick.groups, look.max_streaks);
    if (gl_LocalInvocationIndex != 0u)
        return;
    prepared.wide_quads = virga_draw_gpu(6u * list.second_kind, 1u, 0u, 0, 0u);
    prepared.lines = virga_draw_gpu(0u, 1u, 0u, 0, 0u);
    prepared.thin_quads = virga_draw_gpu(0u, 1u, 0u, 0, 0u);
    prepared.streaks = list.count;
    prepared.dropped = found.x + found.y - list.count;
}
