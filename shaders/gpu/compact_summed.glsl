// compact_summed.glsl - ordered compaction, second and third pass in one, for GPUs: writes the list and its head. See
// compact_buffers.glsl. One invocation per word or per slot, in workgroups of COMPACT_GROUP. Each workgroup adds up the
// sums of all workgroups of the first pass itself. They are 8 bytes per 256 slots, so a million slots are 15 loads per
// invocation.
#include "gpu/compact_scan.glsl"
#include "gpu/compact_write.glsl"

shared uint sums_before[2], sums_of_all[2];

// The selected slots of each kind before workgroup `first` of `groups` of the first pass; `total` gets those of all.
// Has barriers.
uvec2 add_up_groups(uint first, uint groups, out uvec2 total)
{
    const uint lane = gl_LocalInvocationIndex;
    uvec2 before = uvec2(0u), all = uvec2(0u);
    if (lane < 2u)
        sums_before[lane] = sums_of_all[lane] = 0u;
    barrier();
    for (uint group = lane; group < groups; group += COMPACT_GROUP) {
        const uvec2 sums = selection[group * GROUP_WORDS].zw;
        all += sums;
        before += group < first ? sums : uvec2(0u);
    }
    for (uint kind = 0u; kind < 2u; kind++) {
        if (before[kind] != 0u)
            atomicAdd(sums_before[kind], before[kind]);
        if (all[kind] != 0u)
            atomicAdd(sums_of_all[kind], all[kind]);
    }
    barrier();
    total = uvec2(sums_of_all[0], sums_of_all[1]);
    return uvec2(sums_before[0], sums_before[1]);
}

// One invocation per word. Has barriers: call it from all invocations of a workgroup, and only once in a shader.
void write_summed()
{
    const uint word = gl_GlobalInvocationID.x;
    uvec2 total, here;
    const uint first = gl_WorkGroupID.x * (COMPACT_GROUP / GROUP_WORDS); // workgroup of the first pass
    const uvec2 before = add_up_groups(first, list.word_count / GROUP_WORDS, total);
    const virga_list_gpu head = list_head(total, list.capacity);
    const uvec2 bits = word < list.word_count ? selection[word].xy : uvec2(0u);
    const uvec2 before_in_group = scan_group(uvec2(bitCount(bits)), here);
    write_bits(bits, before + before_in_group + uvec2(head.second_kind, 0u), 32u * word, 0u, head);
    if (word == 0u) {
        list.second_kind = head.second_kind;
        list.count = head.count;
        list.group_count = head.group_count;
        list.found = total.x + total.y;
    }
}

// One invocation per slot, of at least one workgroup; the first pass had `groups` of them. The list has room for all.
// Returns how many are selected, of each kind. Has barriers, as above.
uvec2 write_summed_slots(uint groups)
{
    const uint slot = gl_GlobalInvocationID.x, word = slot >> 5, bit = 1u << (slot & 31u);
    uvec2 total;
    uvec2 index = add_up_groups(gl_WorkGroupID.x, groups, total);
    if (gl_WorkGroupID.x < groups) {
        for (uint i = gl_WorkGroupID.x * GROUP_WORDS; i < word; i++)
            index += uvec2(bitCount(selection[i].xy));
        const uvec2 bits = selection[word].xy;
        index += uvec2(total.y, 0u) + uvec2(bitCount(bits & (bit - 1u)));
        if (((bits.x | bits.y) & bit) != 0u)
            listed[(bits.y & bit) != 0u ? index.y : index.x] = slot;
    }
    if (slot == 0u)
        write_head(total, groups, total.x + total.y);
    return total;
}
