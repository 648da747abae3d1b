// hit_offsets.comp - prefix sum of the counts: the index of each slot's first hit, in the order of slots; and the head
// of the impacts.
// One workgroup. Reads: counts. Writes: offsets, the head.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_buffers.glsl"
#define SOFTWARE_LANES VIRGA_RAIN_GROUP
#include "gpu/long_scan.glsl"
#include "hit.glsl"
#include "hit_list.glsl"

void main()
{
    const uint lane = gl_LocalInvocationIndex, run = (list.count + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, list.count), end = min(begin + run, list.count);
    uint sum = 0u;
    for (uint i = begin; i < end; i++)
        sum += hit_offsets[i];
    uvec2 all;
    uint offset = scan_group(uvec2(sum, 0u), all).x;
    for (uint i = begin; i < end; i++) {
        const uint count_here = hit_offsets[i];
        hit_offsets[i] = offset;
        offset += count_here;
    }
    if (lane != 0u)
        return;
    const uint count = min(all.x, VIRGA_RAIN_MAX_HITS);
    hit_head.count = count;
    hit_head.dropped = all.x - count;
    hit_head.water_nl_low = hit_head.water_nl_high = 0u;
    hit_head.group_count = uint[3]((count + 63u) / 64u, 1u, 1u);
    hit_head.capacity = VIRGA_RAIN_MAX_HITS;
    hit_head.origin = float[3](0.0, 0.0, 0.0);
    hit_head.tick_s = tick.tick_s;
    hit_head.ticks = pane.ticks;
    hit_head.first_tick = pane.first_tick;
    hit_head.is_return = 0u;
}
