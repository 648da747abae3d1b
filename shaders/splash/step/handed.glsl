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

// Slots that drops from edges will need by the end of the step, if there are any edges: as many in a tick as in the
// step before, and four deviations more where that is a Poisson number (4 sqrt(n) <= n / 4 + 16). A step without ticks
// is followed by one that has some.
uint kept_for_drips()
{
    const uint drips = min(handed_head.drips, tick.max_handed) * clamp(tick.ticks, 1u, 64u);
    return tick.drip_sites > 0u ? min(drips + drips / 4u + 16u, tick.max_handed) : 0u;
}

// A writer may be the host: what it says is limited to what there is room for.
uint handed_count() { return min(handed_head.count, min(tick.max_handed, tick.max_droplets - state.staying)); }
