// spray.glsl - spray: what the passes that make it share.
//
// A particle with little water around it is a splash particle (section 4.1 of Iwasaki et al. 2006). It leaves the
// surface and becomes droplets. What it was in the frame before is found by its id: a table of ids, in which the
// particles of a frame are entered anew, leads to the states of that frame. Buffers have two halves, for this frame and
// the last one.
#include "water/grid.glsl"
#include "water/state.glsl"
#include "shared/random.h"
#include "shared/spray.h"

layout(std430, set = 0, binding = 8) readonly buffer Densities { float densities[]; };
layout(scalar, set = 0, binding = 10) buffer Splashes
{
    virga_leavers_gpu leavers;
    virga_leaver_gpu splashes[];
};
layout(std430, set = 0, binding = 12) buffer Table { uint table[]; }; // 1 + index of a splash particle; 0: free
layout(std430, set = 0, binding = 13) buffer DropletStarts { uint droplet_starts[]; };

// Index of a splash particle in this frame's half, and of one in the last frame's.
uint splash_now(uint splash) { return state.splash_half * frame.max_splashes + splash; }
uint splash_before(uint splash) { return (1u - state.splash_half) * frame.max_splashes + splash; }
