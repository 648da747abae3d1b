// compact_scan.glsl - the scanning part of ordered compaction, see compact_buffers.glsl. One workgroup: counts of words
// into places, in order. Each lane takes a run of words.
#include "gpu/compact_buffers.glsl"
#include "gpu/group_scan.glsl"

// The words of the lane's run, of `count` from `first` on: the run's first, and behind its last.
uvec2 lane_words(uint first, uint count)
{
    const uint run = (count + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(gl_LocalInvocationIndex * run, count);
    return first + uvec2(begin, min(begin + run, count));
}

// Places of all picks of `count` words from `first` on, in a list that has room for `most` (the second kind first).
// Returns to all lanes how many there are of each kind.
uvec2 place_picks(uint first, uint count, uint most)
{
    const uvec2 words = lane_words(first, count);
    uvec2 sum = uvec2(0u);
    for (uint i = words.x; i < words.y; i++)
        sum += uvec2(bitCount(picks[i].xy));
    uvec2 total;
    const uvec2 before = scan_group(sum, total);
    uvec2 place = before + uvec2(min(total.y, most), 0u);
    for (uint i = words.x; i < words.y; i++) {
        const uvec2 bits = picks[i].xy;
        picks[i].zw = place;
        place += uvec2(bitCount(bits));
    }
    return total;
}

virga_list_gpu list_head(uvec2 total, uint most)
{
    virga_list_gpu head;
    head.second_kind = min(total.y, most);
    head.count = min(total.x + total.y, most);
    head.group_count = uint[3]((head.count + COMPACT_GROUP - 1u) / COMPACT_GROUP, 1u, 1u);
    return head;
}

#ifndef COMPACT_LISTS
// The same for all picks of `groups` workgroups, and the list's head.
uvec2 scan_picks(uint groups, uint most)
{
    const uvec2 total = place_picks(0u, groups * GROUP_WORDS, most);
    if (gl_LocalInvocationIndex == 0u) {
        const virga_list_gpu head = list_head(total, most);
        list.second_kind = head.second_kind;
        list.count = head.count;
        list.group_count = head.group_count;
        list.words = groups * GROUP_WORDS;
    }
    return total;
}
#endif
