// impact_scan.comp - impacts, second list, scan: prefix sum of the selection, behind the impacts of the step's earlier
// ticks; and the head.
// One workgroup. Reads: selection. Writes: selection, the head of the impacts, the total of earlier steps.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_scan.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(scalar, set = 0, binding = 4) buffer Impacts
{
    virga_impacts_gpu head;
    virga_impact_gpu impacts[];
};

layout(scalar, set = 0, binding = 23) buffer Total
{
    virga_rain_total_gpu total;
};

void add_to_total(uint low, uint high)
{
    uint carry;
    total.nl_low = uaddCarry(total.nl_low, low, carry);
    total.nl_high += high + carry;
}

void main()
{
    const bool first_tick = tick.tick_in_step == 0u;
    const uint before = first_tick ? 0u : head.count;
    const uint dropped_before = first_tick ? 0u : head.dropped;
    const uint found = scan_words(0u, list.group_count[0] * GROUP_WORDS, 0xffffffffu).x;
    if (gl_LocalInvocationIndex != 0u)
        return;
    list.first = before;
    const uint count = min(before + found, tick.max_impacts);
    if (first_tick) {
        add_to_total(head.water_nl_low, head.water_nl_high);
        head.water_nl_low = 0u;
        head.water_nl_high = 0u;
        head.first_tick = tick.tick;
        head.is_return = 0u;
    }
    head.count = count;
    head.dropped = dropped_before + (before + found - count);
    head.group_count = uint[3]((count + 63u) / 64u, 1u, 1u);
    head.capacity = tick.max_impacts;
    head.origin = tick.origin;
    head.tick_s = tick.tick_s;
    head.ticks = tick.tick_in_step + 1u;
}
