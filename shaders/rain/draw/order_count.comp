// order_count.comp - counts the streaks of each bucket in a workgroup, and gives each its rank in its bucket: the
// number of bits before its own, with a bit per streak. See order.glsl.
// One invocation per streak. Reads: streaks. Writes: ranks, counts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_buffers.glsl"
#include "order.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(scalar, set = 0, binding = 7) buffer Streaks { virga_streak_gpu streaks[]; };

#define BUCKET_WORDS (VIRGA_RAIN_GROUP / 32)
shared uint in_bucket[BUCKETS * BUCKET_WORDS], counts[BUCKETS];

void main()
{
    const uint index = gl_GlobalInvocationID.x, lane = gl_LocalInvocationIndex;
    const uint word = lane >> 5, bit = 1u << (lane & 31u);
    const bool thin = index >= list.second_kind && index < list.count;
    const uint bucket_or_none = thin ? streaks[index].order : NOT_DRAWN;
    const bool counted = bucket_or_none != NOT_DRAWN;
    const uint bucket = counted ? bucket_or_none : 0u;
    for (uint i = 0u; i < BUCKET_WORDS; i++)
        in_bucket[i * BUCKETS + lane] = 0u;
    counts[lane] = 0u;
    barrier();
    if (counted)
        atomicOr(in_bucket[word * BUCKETS + bucket], bit);
    barrier();
    uint rank = 0u, bucket_count = 0u;
    for (uint i = 0u; i < BUCKET_WORDS; i++) {
        const uint bits = in_bucket[i * BUCKETS + bucket];
        rank += bitCount(i < word ? bits : i == word ? bits & (bit - 1u) : 0u);
        bucket_count += bitCount(bits);
    }
    if (counted) {
        streaks[index].order = bucket * VIRGA_RAIN_GROUP + rank;
        if (rank == 0u)
            counts[bucket] = bucket_count;
    }
    barrier();
    order[count_index(lane, gl_WorkGroupID.x)] = counts[lane];
    if (counts[lane] > 0u)
        atomicAdd(order[total_index(lane)], counts[lane]);
}
