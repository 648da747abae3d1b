// state.glsl - what all passes of splash share: buffers, and slots in the rings. Vertex shaders define STATE_ACCESS
// readonly.
#define VIRGA_GLSL
#include "shared/splash_gpu.h"
#include "shared/droplet.h"
#include "shared/ground_limits.h"
#include "shared/random.h"
#include "gpu/vectors.glsl"

#ifndef STATE_ACCESS
#define STATE_ACCESS
#endif

layout(scalar, set = 0, binding = 0) uniform Tick { virga_splash_tick_gpu tick; };
layout(scalar, set = 0, binding = 2) uniform Rules { virga_splash_rules_gpu rules; };
layout(scalar, set = 0, binding = 4) STATE_ACCESS buffer State { virga_splash_state_gpu state; };
layout(scalar, set = 0, binding = 5) STATE_ACCESS buffer Splashes { uvec4 splashes[]; };
layout(scalar, set = 0, binding = 6) STATE_ACCESS buffer Droplets { uvec4 droplets[]; };
#include "texels.glsl"

#define GRAVITY 9.80665
#define NO_SLOT 0xffffffffu

// The slot of the droplet or splash that an invocation of a dispatch over a ring handles; NO_SLOT past the end.
uint ring_slot(uint first, uint end, uint size, uint invocation)
{
    const uint slot = (first & ~uint(VIRGA_SPLASH_GROUP - 1)) + invocation;
    return slot - first < end - first ? slot & (size - 1u) : NO_SLOT;
}

uint[3] ring_groups(uint first, uint end)
{
    const uint from = first & ~uint(VIRGA_SPLASH_GROUP - 1);
    return uint[3]((end - from + VIRGA_SPLASH_GROUP - 1u) / VIRGA_SPLASH_GROUP, 1u, 1u);
}

bool is_physical() { return rules.mode == VIRGA_SPLASH_PHYSICAL; }
