// find.glsl - the finding half of ordered compaction, see scan_buffers.glsl.
#include "scan_buffers.glsl"

shared uint group_bits[2 * GROUP_WORDS];

void mark_pick(uint kind)
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane < 2u * GROUP_WORDS)
        group_bits[lane] = 0u;
    barrier();
    if (kind != NOT_PICKED)
        atomicOr(group_bits[(kind - FIRST_KIND) * GROUP_WORDS + (lane >> 5)], 1u << (lane & 31u));
    barrier();
    if (lane < GROUP_WORDS)
        picks[gl_WorkGroupID.x * GROUP_WORDS + lane] = uvec4(group_bits[lane], group_bits[GROUP_WORDS + lane], 0u, 0u);
}
