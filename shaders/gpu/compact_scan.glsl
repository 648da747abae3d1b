// compact_scan.glsl - ordered compaction, second pass: prefix sum of the selection. See compact_buffers.glsl. One
// workgroup; each invocation takes a run of consecutive words.
#include "gpu/compact_buffers.glsl"
#include "gpu/group_scan.glsl"

// The words of this invocation's run, among `count` words from `first` on: the first one, and one past the last.
uvec2 lane_words(uint first, uint count)
{
    const uint run = (count + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(gl_LocalInvocationIndex * run, count);
    return first + uvec2(begin, min(begin + run, count));
}

// Computes the list index of the first selected slot in each of `count` words from `first` on, for a list with room for
// `capacity` entries. The second kind comes first. Returns the number of selected slots of each kind, to all
// invocations.
uvec2 scan_words(uint first, uint count, uint capacity)
{
    const uvec2 words = lane_words(first, count);
    uvec2 sum = uvec2(0u);
    for (uint i = words.x; i < words.y; i++)
        sum += uvec2(bitCount(selection[i].xy));
    uvec2 total;
    const uvec2 before = scan_group(sum, total);
    uvec2 index = before + uvec2(min(total.y, capacity), 0u);
    for (uint i = words.x; i < words.y; i++) {
        const uvec2 bits = selection[i].xy;
        selection[i].zw = index;
        index += uvec2(bitCount(bits));
    }
    return total;
}

virga_list_gpu list_head(uvec2 total, uint capacity)
{
    virga_list_gpu head;
    head.second_kind = min(total.y, capacity);
    head.count = min(total.x + total.y, capacity);
    head.group_count = uint[3]((head.count + COMPACT_GROUP - 1u) / COMPACT_GROUP, 1u, 1u);
    return head;
}

#ifndef COMPACT_LISTS
// By one invocation.
void write_head(uvec2 total, uint groups, uint capacity)
{
    const virga_list_gpu head = list_head(total, capacity);
    list.second_kind = head.second_kind;
    list.count = head.count;
    list.group_count = head.group_count;
    list.word_count = groups * GROUP_WORDS;
}

// scan_words for all selected slots of `groups` workgroups; also writes the head of the list.
uvec2 scan_selection(uint groups, uint capacity)
{
    const uvec2 total = scan_words(0u, groups * GROUP_WORDS, capacity);
    if (gl_LocalInvocationIndex == 0u)
        write_head(total, groups, capacity);
    return total;
}
#endif
