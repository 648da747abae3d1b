// order_scan.comp - where the streaks of a bucket begin that a workgroup of prepare_write has: behind those of
// all buckets before it, and of its own in the workgroups before.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define SCAN_LANES VIRGA_RAIN_ORDER_LANES
#include "rain/tick.glsl"
#include "view.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_buffers.glsl"
#include "order.glsl"
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_RAIN_ORDER_LANES) in;

// A lane reads the counts of this many workgroups before it writes any: a read after a write to the same buffer waits,
// and a million streaks are 3,900 workgroups one after another.
#define AHEAD 8u

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    const uint first_bucket = gl_WorkGroupID.x * SCAN_LANES, bucket = first_bucket + lane;
    uint before = 0u; // streaks of the buckets of the workgroups before
    for (uint i = lane; i < first_bucket; i += SCAN_LANES)
        before += order[total_at(i)];
    uvec2 all;
    uint place = scan_group(uvec2(order[total_at(bucket)], before), all).x + all.y;
    const uint groups = list.group_count[0];
    for (uint group = 0u; group < groups; group += AHEAD) {
        uint counts[AHEAD];
        for (uint i = 0u; i < AHEAD; i++)
            counts[i] = order[count_at(bucket, min(group + i, groups - 1u))];
        for (uint i = 0u; i < AHEAD && group + i < groups; i++) {
            order[count_at(bucket, group + i)] = place;
            place += counts[i];
        }
    }
}
