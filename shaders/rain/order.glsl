// order.glsl - the order that streaks are drawn in: by where they are on the picture, and not by slot.
//
// Slots lie anywhere. Who fills a picture tile by tile, as software Vulkan and GPUs of phones do, would find a tile's
// triangles all over memory and wait for each of them: 25,000 streaks at random took a third longer than in order. In
// finer areas than these nothing is gained.
//
// It is a counting sort, the same whatever order the device runs workgroups in:
//
// write: tells each streak's area
// count: each workgroup of streaks counts those of each area; a streak's rank is how many of its workgroup and area
//        come before it
// scan:  a lane for each area turns counts into places
// order: each streak's six indices go to their place
//
// Wide streaks, which are few and first in the list, are drawn as they are listed.
#include "shared/rain_limits.h"

#define AREAS_ACROSS 16u // and down
#define AREAS uint(VIRGA_RAIN_AREAS)

layout(scalar, set = 0, binding = 21) buffer Order
{
    uint order[]; // six indices a streak, then each area's streaks, then counts
};

// Of streaks of an area, all in all.
uint total_at(uint area) { return 6u * look.max_streaks + area; }

// Of streaks of an area in a workgroup; after the scan: where they begin among thin streaks.
uint count_at(uint area, uint group) { return total_at(AREAS) + group * AREAS + area; }
