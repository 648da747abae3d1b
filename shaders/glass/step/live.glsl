// live.glsl - invocations over the live slots, or over the active ones: those whose drop may move, merge or meet a
// blade in this tick. The includer defines FEW for a pass over active slots or seeds. These are few, and idle lanes
// cost software Vulkan as much as busy ones, so such passes have small workgroups.
#include "shared/compact.h"
#ifdef FEW
layout(local_size_x = VIRGA_GLASS_SMALL_GROUP) in;
#else
layout(local_size_x = VIRGA_GLASS_GROUP) in;
#endif
layout(scalar, set = 0, binding = 4) readonly buffer List
{
    virga_list_gpu list;
    uint listed[];
};

layout(scalar, set = 0, binding = 16) readonly buffer Active
{
    virga_list_gpu active_list;
    uint active_entries[]; // indices into `listed`; particles come first
};

// The slot of this invocation, or NONE.
uint live_slot() { return gl_GlobalInvocationID.x < state.alive ? listed[gl_GlobalInvocationID.x] : NONE; }

uint slot_of_active(uint i) { return listed[active_entries[i]]; }
uint active_slot()
{
    return gl_GlobalInvocationID.x < state.active_count ? slot_of_active(gl_GlobalInvocationID.x) : NONE;
}
