// compact_scan.glsl - the scanning part of ordered compaction, see compact_buffers.glsl. One workgroup: counts of words
// into places, in order. Each lane takes a run of words.
#include "gpu/compact_buffers.glsl"
#include "gpu/group_scan.glsl"

// Places of all picks of `groups` workgroups in the list, which has room for `most` (the second kind first). Returns to
// all lanes how many there are of each kind.
uvec2 scan_picks(uint groups, uint most)
{
    const uint words = groups * GROUP_WORDS;
    const uint lane = gl_LocalInvocationIndex;
    const uint run = (words + COMPACT_GROUP - 1u) / COMPACT_GROUP;
    const uint begin = min(lane * run, words), end = min(begin + run, words);
    uvec2 sum = uvec2(0u);
    for (uint i = begin; i < end; i++)
        sum += uvec2(bitCount(picks[i].xy));
    uvec2 total;
    const uvec2 before = scan_group(sum, total);
    uvec2 place = before + uvec2(min(total.y, most), 0u);
    for (uint i = begin; i < end; i++) {
        const uvec2 bits = picks[i].xy;
        picks[i].zw = place;
        place += uvec2(bitCount(bits));
    }
    if (lane == 0u) {
        list.second_kind = min(total.y, most);
        list.count = min(total.x + total.y, most);
        list.group_count = uint[3]((list.count + COMPACT_GROUP - 1u) / COMPACT_GROUP, 1u, 1u);
    }
    return total;
}
