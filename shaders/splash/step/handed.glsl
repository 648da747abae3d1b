// handed.glsl - the list of droplets that water hands over.
#include "shared/handed_droplet.h"

#ifndef HANDED_BINDING
#define HANDED_BINDING 21
#endif

layout(scalar, set = 0, binding = HANDED_BINDING) buffer Handed
{
    virga_handed_droplets_gpu handed_head;
    virga_handed_droplet_gpu handed[];
};

// A writer may be the host: what it says is limited to what there is room for.
uint handed_count() { return min(handed_head.count, min(tick.max_handed, tick.max_droplets - state.staying)); }
