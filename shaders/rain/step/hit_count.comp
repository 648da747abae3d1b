// hit_count.comp - counts the drops of each listed slot that hit the pane.
// One invocation per listed slot. Reads: the list, drops, occlusion maps. Writes: counts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_buffers.glsl"
#include "hit.glsl"
#include "hit_list.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= list.count)
        return;
    const Slot slot = slot_at(listed[i]);
    Traversal traversal = start_traversal(slot);
    Hit hit;
    uint found = 0u;
    while (next_hit(slot, traversal, hit))
        found += is_under_sky(slot, hit) ? 1u : 0u;
    hit_offsets[i] = found;
}
