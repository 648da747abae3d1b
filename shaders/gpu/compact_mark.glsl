// compact_mark.glsl - ordered compaction, first pass: selects slots. See compact_buffers.glsl.
#include "gpu/compact_buffers.glsl"

#ifndef COMPACT_SETS
#define COMPACT_SETS 1 // an invocation handles one slot in each of this many sets
#endif
#define SET_WORDS (2 * GROUP_WORDS) // bits of both kinds

shared uint group_bits[COMPACT_SETS * SET_WORDS];

// Selected slots of each kind in the workgroup. Kept beside its first word.
uvec2 sums_of_group(uint set)
{
    uvec2 sums = uvec2(0u);
    for (uint i = set * SET_WORDS; i < set * SET_WORDS + GROUP_WORDS; i++)
        sums += uvec2(bitCount(group_bits[i]), bitCount(group_bits[i + GROUP_WORDS]));
    return sums;
}

// Selects the invocation's slot in each set as the kind given. Set i has groups[i] workgroups of slots, and first[i] is
// the first of them among the workgroups of all slots. Has barriers: call it from all invocations of a workgroup.
void mark_selected_sets(uint kinds[COMPACT_SETS], uint first[COMPACT_SETS], uint groups[COMPACT_SETS])
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane < COMPACT_SETS * SET_WORDS)
        group_bits[lane] = 0u;
    barrier();
    for (uint i = 0u; i < COMPACT_SETS; i++) {
        const uint word = i * SET_WORDS + (kinds[i] - FIRST_KIND) * GROUP_WORDS + (lane >> 5);
        if (kinds[i] != NOT_SELECTED)
            atomicOr(group_bits[word], 1u << (lane & 31u));
    }
    barrier();
    if (lane < COMPACT_SETS * GROUP_WORDS) {
        const uint set = lane / GROUP_WORDS, word = lane % GROUP_WORDS, bits = set * SET_WORDS + word;
        const uvec2 both = uvec2(group_bits[bits], group_bits[bits + GROUP_WORDS]);
        const uvec2 sums = FOR_GPU && word == 0u ? sums_of_group(set) : uvec2(0u);
        if (gl_WorkGroupID.x < groups[set])
            selection[(first[set] + gl_WorkGroupID.x) * GROUP_WORDS + word] = uvec4(both, sums);
    }
}

#if COMPACT_SETS == 1 && !defined COMPACT_LISTS
// For a list of virga_record_list, with room for so many: what its third pass needs where there is no scan.
void begin_list(uint capacity)
{
    if (!FOR_GPU || gl_GlobalInvocationID.x != 0u)
        return;
    list.word_count = gl_NumWorkGroups.x * GROUP_WORDS;
    list.capacity = capacity;
}
#endif

#if COMPACT_SETS == 1
void mark_selected(uint kind) { mark_selected_sets(uint[1](kind), uint[1](0u), uint[1](gl_NumWorkGroups.x)); }
#endif
