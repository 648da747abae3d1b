// hit_write.comp - writes the drops that met the pane.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "field.glsl"
#include "compact.glsl"
#include "gpu/compact_buffers.glsl"
#include "hit.glsl"
#include "hit_list.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

// Water of one of a slot's drops, rounded so that sums are right on average.
uint water_of(Slot slot, uint k)
{
    const float mm = classes[slot.size_class].diameter_m * 1e3, stands_for = max(slot.weight / float(MOST_DROPS), 1.0);
    return uint(523.598776 * mm * mm * mm * stands_for + virga_unit(virga_hash3(slot.id, tick.tick, k)));
}

void main()
{
    if (gl_GlobalInvocationID.x >= list.count)
        return;
    const Slot slot = slot_at(listed[gl_GlobalInvocationID.x]);
    uint place = hit_places[gl_GlobalInvocationID.x];
    for (uint k = 0u; k < slot.count && place < VIRGA_RAIN_MAX_HITS; k++) {
        const Hit hit = find_hit(slot, k);
        if (hit.share < 0.0)
            continue;
        virga_impact_gpu impact;
        impact.position = float[3](hit.place.x, hit.place.y, 0.0);
        impact.time_s = hit.share * pane.step_s;
        impact.velocity = float[3](slot.velocity.x, slot.velocity.y, slot.velocity.z);
        impact.diameter_m = classes[slot.size_class].diameter_m;
        impact.normal = float[3](0.0, 0.0, 1.0);
        impact.weight = 1.0;
        impact.id = k == 0u ? slot.id : virga_hash2(slot.id, k);
        impact.material = 0u;
        impact.water_nl = water_of(slot, k);
        impact.tick = pane.first_tick + uint(hit.share * float(pane.ticks));
        hits[place++] = impact;
    }
}
