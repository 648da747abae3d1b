// order.glsl - the order in which streaks are drawn: by their position on the picture, not by slot.
//
// Slots are anywhere. A device that fills the picture tile by tile, such as software Vulkan and mobile GPUs, would find
// the triangles of a tile all over memory and wait for each: 25,000 streaks in random order took a third longer. Areas
// smaller than these gain nothing.
//
// It is a counting sort, with the same result in whatever order the device runs workgroups:
//
//     streak_write   gives each streak its bucket: its area and, where some streaks are lines (see streak.glsl),
//                    whether it is a line
//     order_count    counts the streaks of each bucket in a workgroup; a streak's rank is the number of those before it
//     order_scan     prefix sum of the counts, one invocation per bucket
//     order_indices  writes the indices of each streak, six or, for a line, two; and the draws' arguments
//
// Wide streaks are few and come first in the list. They are drawn in the order of the list; then all lines, then all
// other streaks.
#include "shared/rain_limits.h"

#define BUCKETS uint(VIRGA_RAIN_BUCKETS)
#define AREA_COLUMNS 16u
#define NOT_DRAWN 0xffffffffu // instead of a bucket: a streak that covers nothing

layout(scalar, set = 0, binding = 21) buffer Order
{
    uint order[]; // up to six indices per streak, then the count of each bucket, then counts by workgroup
};

// Lines have the lower half of the buckets, so areas are twice as high.
uint area_rows() { return look.lines != 0u ? 8u : 16u; }
uint first_bucket_of_quads() { return look.lines != 0u ? BUCKETS / 2u : 0u; }

// Index of a bucket's total count.
uint total_index(uint bucket) { return 6u * look.max_streaks + bucket; }

// Index of a bucket's count in a workgroup; after the scan: the index of its first streak there among thin streaks.
uint count_index(uint bucket, uint group) { return total_index(BUCKETS) + group * BUCKETS + bucket; }
