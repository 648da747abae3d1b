// live.glsl - a pass over the places in use, or over those of them that something happens to in this tick.
// The includer of a pass over the latter, or over seeds, has FEW: they are few, and idle lanes cost software Vulkan as
// much as busy ones, so those go by small workgroups.
#include "shared/compact.h"
#ifdef FEW
layout(local_size_x = VIRGA_GLASS_FEW_GROUP) in;
#else
layout(local_size_x = VIRGA_GLASS_GROUP) in;
#endif
layout(scalar, set = 0, binding = 4) readonly buffer List
{
    virga_list_gpu list;
    uint listed[];
};

layout(scalar, set = 0, binding = 16) readonly buffer Awake
{
    virga_list_gpu awake_list;
    uint awake_entries[]; // of the list: particles first
};

// The invocation's place, or NOWHERE.
uint alive_place() { return gl_GlobalInvocationID.x < state.alive ? listed[gl_GlobalInvocationID.x] : NOWHERE; }

uint place_of_awake(uint i) { return listed[awake_entries[i]]; }
uint awake_place() { return gl_GlobalInvocationID.x < state.awake ? place_of_awake(gl_GlobalInvocationID.x) : NOWHERE; }
