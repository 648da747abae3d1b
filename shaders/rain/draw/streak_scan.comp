// streak_scan.comp - streaks, scan: prefix sum of the selection, and the draw of wide streaks (the others are known
// after order_indices.comp). Clears the counts of order_count.comp.
// Not on GPUs: there streak_mark.comp and order_scan.comp do these.
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
#include "order_draws.glsl"

void main()
{
    order[total_index(gl_LocalInvocationIndex)] = 0u;
    const uvec2 found = scan_selection(tick.groups, look.max_streaks);
    if (gl_LocalInvocationIndex == 0u)
        begin_draws(found.x + found.y);
}
