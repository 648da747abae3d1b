// order_scan.comp - prefix sum of the counts: where the streaks of each bucket and workgroup begin. See order.glsl.
// One invocation per bucket. Reads: counts. Writes: counts; on GPUs draw arguments.
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
#include "order_draws.glsl"

layout(local_size_x = VIRGA_RAIN_ORDER_LANES) in;

// An invocation reads the counts of this many workgroups before it writes any: a read after a write to the same buffer
// has to wait, and a million streaks are 3,900 workgroups in sequence.
#define AHEAD 8u

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    if (FOR_GPU && gl_GlobalInvocationID.x == 0u)
        begin_draws(list.found);
    const uint first_bucket = gl_WorkGroupID.x * SCAN_LANES, bucket = first_bucket + lane;
    uint before = 0u; // streaks in the buckets of the workgroups before
    for (uint i = lane; i < first_bucket; i += SCAN_LANES)
        before += order[total_index(i)];
    uvec2 all;
    uint index = scan_group(uvec2(order[total_index(bucket)], before), all).x + all.y;
    const uint groups = list.group_count[0];
    for (uint group = 0u; group < groups; group += AHEAD) {
        uint counts[AHEAD];
        for (uint i = 0u; i < AHEAD; i++)
            counts[i] = order[count_index(bucket, min(group + i, groups - 1u))];
        for (uint i = 0u; i < AHEAD && group + i < groups; i++) {
            order[count_index(bucket, group + i)] = index;
            index += counts[i];
        }
    }
}
