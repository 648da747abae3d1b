// order.glsl - the order that streaks are drawn in: by where they are on the picture, and not by slot.
//
// Slots lie anywhere. Who fills a picture tile by tile, as software Vulkan and GPUs of phones do, would find a tile's
// triangles all over memory and wait for each of them: 25,000 streaks at random took a third longer than in order. In
// finer areas than these nothing is gained.
//
// It is a counting sort, the same whatever order the device runs workgroups in:
//
// write: tells each streak's bucket: its area, and where some streaks are lines (see streak.glsl), whether it is one
// count: each workgroup of streaks counts those of each bucket; a streak's rank is how many of its workgroup and bucket
//        come before it
// scan:  a lane for each bucket turns counts into places
// order: each streak's indices go to their place, six or, of a line, two; the draws' arguments
//
// Wide streaks, which are few and first in the list, are drawn as they are listed; after them all lines, then all else.
#include "shared/rain_limits.h"

#define BUCKETS uint(VIRGA_RAIN_BUCKETS)
#define AREAS_ACROSS 16u
#define NOT_DRAWN 0xffffffffu // in place of a bucket: a streak that covers nothing

layout(scalar, set = 0, binding = 21) buffer Order
{
    uint order[]; // up to six indices a streak, then each bucket's streaks, then counts
};

// Lines have the lower half of the buckets, so that areas are twice as high.
uint areas_down() { return look.lines != 0u ? 8u : 16u; }
uint first_bucket_of_quads() { return look.lines != 0u ? BUCKETS / 2u : 0u; }

// Of streaks of a bucket, all in all.
uint total_at(uint bucket) { return 6u * look.max_streaks + bucket; }

// Of streaks of a bucket in a workgroup; after the scan: where they begin among thin streaks.
uint count_at(uint bucket, uint group) { return total_at(BUCKETS) + group * BUCKETS + bucket; }
