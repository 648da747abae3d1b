// hit_find.comp - marks the slots of which a drop met the pane in the newest step.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "field.glsl"
#include "compact.glsl"
#include "gpu/compact_find.glsl"
#include "hit.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

void main()
{
    const Slot slot = slot_at(gl_GlobalInvocationID.x);
    bool any_hit = false;
    const uint count = far_away(slot) ? 0u : slot.count;
    for (uint k = 0u; k < count && !any_hit; k++)
        any_hit = find_hit(slot, k).share >= 0.0;
    mark_pick(any_hit ? FIRST_KIND : NOT_PICKED);
}
