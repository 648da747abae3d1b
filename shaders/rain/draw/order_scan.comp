// order_scan.comp - prefix sum of the counts: where the streaks of each bucket and workgroup begin. See order.glsl.
// Software Vulkan: one invocation per bucket. GPUs: one workgroup per bucket, as a million streaks are 3,900
// workgroups, which one invocation would read one after another.
// Reads: counts. Writes: counts; on GPUs draw arguments.
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

// The counts of one bucket, by the workgroup: each invocation takes a run of workgroups.
void scan_bucket(uint bucket)
{
    const uint lane = gl_LocalInvocationIndex, groups = list.group_count[0];
    const uint run = (groups + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, groups), end = min(begin + run, groups);
    uint before = 0u, sum = 0u; // streaks in the buckets before, and of this run
    for (uint i = lane; i < bucket; i += SCAN_LANES)
        before += order[total_index(i)];
    for (uint group = begin; group < end; group++)
        sum += order[count_index(bucket, group)];
    uvec2 all;
    uint index = scan_group(uvec2(sum, before), all).x + all.y;
    for (uint group = begin; group < end; group++) {
        const uint count = order[count_index(bucket, group)];
        order[count_index(bucket, group)] = index;
        index += count;
    }
}

// The counts of as many buckets as the workgroup has invocations.
void scan_buckets()
{
    const uint lane = gl_LocalInvocationIndex;
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

void main()
{
    if (FOR_GPU && gl_GlobalInvocationID.x == 0u)
        begin_draws(list.found);
    if (FOR_GPU)
        scan_bucket(gl_WorkGroupID.x);
    else
        scan_buckets();
}
