// state.glsl - what splash's passes share: buffers, places in the rings, counts.
#define VIRGA_GLSL
#include "shared/splash_gpu.h"
#include "shared/droplet.h"
#include "shared/ground_limits.h"
#include "shared/random.h"
#include "gpu/vectors.glsl"

layout(scalar, set = 0, binding = 0) uniform Tick { virga_splash_tick_gpu tick; };
layout(scalar, set = 0, binding = 2) uniform Rules { virga_splash_rules_gpu rules; };
layout(scalar, set = 0, binding = 4) buffer State { virga_splash_state_gpu state; };
layout(scalar, set = 0, binding = 5) buffer Splashes { virga_splash_gpu splashes[]; };
layout(scalar, set = 0, binding = 6) buffer Droplets { virga_droplet_gpu droplets[]; };

#define GRAVITY 9.80665
#define NO_PLACE 0xffffffffu

// Place of the droplet or splash that an invocation of a dispatch over the ring works for; past the end: NO_PLACE.
uint ring_place(uint first, uint end, uint size)
{
    const uint place = (first & ~uint(VIRGA_SPLASH_GROUP - 1)) + gl_GlobalInvocationID.x;
    return place - first < end - first ? place & (size - 1u) : NO_PLACE;
}

uint[3] ring_groups(uint first, uint end)
{
    const uint from = first & ~uint(VIRGA_SPLASH_GROUP - 1);
    return uint[3]((end - from + VIRGA_SPLASH_GROUP - 1u) / VIRGA_SPLASH_GROUP, 1u, 1u);
}

void count(uint index, uint amount)
{
    if (amount == 0u)
        return;
    const uint old = atomicAdd(state.counts[index].low, amount);
    if (old + amount < old)
        atomicAdd(state.counts[index].high, 1u);
}

bool is_physical() { return rules.mode == VIRGA_SPLASH_PHYSICAL; }
