// compact_write.glsl - the listing part of ordered compaction, see compact_buffers.glsl.
#include "gpu/compact_buffers.glsl"

// Writes a word's picks into the entries from `entry` on, each at its place where there is room; `slot` is that of its
// first bit. A lane for a word: 32 lanes that read the same word cost software Vulkan four times as much.
void list_word(uint word_index, uint slot, uint entry, virga_list_gpu head)
{
    const uvec4 word = picks[word_index];
    uvec2 place = word.zw;
    for (uint bits = word.x | word.y; bits != 0u; bits &= bits - 1u) {
        const uint bit = findLSB(bits), second = (word.y >> bit) & 1u;
        const uint own = second != 0u ? place.y : place.x;
        if (own < (second != 0u ? head.second_kind : head.count))
            listed[entry + own] = slot + bit;
        place += uvec2(1u - second, second);
    }
}

#ifndef COMPACT_LISTS
// Writes a slot into the list, at its place, if it was picked and there is room.
void list_pick(uint slot_index)
{
    const uvec4 word = picks[slot_index >> 5];
    const uint bit = 1u << (slot_index & 31u);
    const bool second = (word.y & bit) != 0u;
    const uint bits = second ? word.y : word.x;
    const uint place = (second ? word.w : word.z) + bitCount(bits & (bit - 1u));
    if ((bits & bit) != 0u && place < (second ? list.second_kind : list.count))
        listed[place] = slot_index;
}
#endif
