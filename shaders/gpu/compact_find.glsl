// compact_find.glsl - the finding part of ordered compaction, see compact_buffers.glsl.
#include "gpu/compact_buffers.glsl"

#ifndef COMPACT_FIRST_GROUP
#define COMPACT_FIRST_GROUP 0u // of this dispatch among the workgroups of all slots
#endif

shared uint group_bits[2 * GROUP_WORDS];

// Of the invocation's slot. For all invocations of a workgroup alike: there are barriers in it.
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
        picks[(COMPACT_FIRST_GROUP + gl_WorkGroupID.x) * GROUP_WORDS + lane] = uvec4(group_bits[lane], group_bits[GROUP_WORDS + lane], 0u, 0u);
}
