// hit_write.comp - writes the drops that hit the pane, as impacts.
// One invocation per listed slot. Reads: the list, drops, offsets. Writes: impacts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_buffers.glsl"
#include "hit.glsl"
#include "hit_list.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

// Water of one of the slot's drops, rounded at random so that sums are right on average.
uint water_of(Slot slot, uint number)
{
    const float mm = classes[slot.size_class].diameter_m * 1e3;
    const float stands_for = number == 0u ? 1.0 : max(slot.chance, 1.0);
    return uint(523.598776 * mm * mm * mm * stands_for + virga_unit(virga_hash3(slot.id, tick.tick, number)));
}

virga_impact_gpu impact_of(Slot slot, Hit hit)
{
    virga_impact_gpu impact;
    impact.position = float[3](hit.pane_position.x, hit.pane_position.y, 0.0);
    impact.time_s = hit.share * pane.step_s;
    impact.velocity = float[3](slot.velocity.x, slot.velocity.y, slot.velocity.z);
    impact.diameter_m = classes[slot.size_class].diameter_m;
    impact.normal = float[3](0.0, 0.0, 1.0);
    impact.weight = 1.0;
    impact.id = hit.number == 0u ? slot.id : virga_hash2(slot.id, hit.number);
    impact.material = 0u;
    impact.water_nl = water_of(slot, hit.number);
    impact.tick = pane.first_tick + uint(hit.share * float(pane.ticks));
    return impact;
}

// A hit that was counted but not found again, because floats may differ between shaders: an impact without water, where
// an old drop would be left otherwise.
virga_impact_gpu no_drop(Slot slot)
{
    Hit hit;
    hit.share = 0.0;
    hit.pane_position = vec2(0.0);
    hit.number = 0u;
    virga_impact_gpu impact = impact_of(slot, hit);
    impact.water_nl = 0u;
    return impact;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= list.count)
        return;
    // Up to the first hit of the next slot. Most slots have none, and are done at once.
    const uint all = hit_head.count + hit_head.dropped;
    const uint end = min(i + 1u < list.count ? hit_offsets[i + 1u] : all, VIRGA_RAIN_MAX_HITS);
    const Slot slot = slot_at(listed[i]);
    Traversal traversal = start_traversal(slot);
    Hit hit;
    uint index = hit_offsets[i];
    while (index < end && next_hit(slot, traversal, hit))
        if (is_under_sky(slot, hit))
            hits[index++] = impact_of(slot, hit);
    for (; index < end; index++)
        hits[index] = no_drop(slot);
}
