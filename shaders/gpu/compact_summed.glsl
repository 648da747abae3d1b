// compact_summed.glsl - ordered compaction, second and third pass in one, for GPUs: writes the list and its head. See
// compact_buffers.glsl. One invocation per word, in workgroups of COMPACT_GROUP. Each workgroup adds up the sums of all
// workgroups of the first pass itself. They are 8 bytes per 256 slots, so a million slots are 15 loads per invocation.
#include "gpu/compact_scan.glsl"
#include "gpu/compact_write.glsl"

shared uint sums_before[2], sums_of_all[2];

// The selected slots of each kind before the words of this workgroup; `total` gets those of all. Has barriers.
uvec2 add_up_groups(out uvec2 total)
{
    const uint lane = gl_LocalInvocationIndex, groups = list.word_count / GROUP_WORDS;
    const uint first = gl_WorkGroupID.x * (COMPACT_GROUP / GROUP_WORDS); // of this workgroup
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

// Has barriers: call it from all invocations of a workgroup, and only once in a shader.
void write_summed()
{
    const uint word = gl_GlobalInvocationID.x;
    uvec2 total, here;
    const uvec2 before = add_up_groups(total);
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
