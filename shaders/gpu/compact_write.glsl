// compact_write.glsl - ordered compaction, third pass: writes the list. See compact_buffers.glsl.
#include "gpu/compact_buffers.glsl"

// Writes the selection of one word. The list's entries begin at `entry`; `slot` is the slot of the word's first bit,
// `index` the list index of the first selected slot of each kind. Selected beyond the list's capacity are dropped. One
// invocation per word: where 32 invocations read the same word, software Vulkan took four times as long.
void write_bits(uvec2 word, uvec2 index, uint slot, uint entry, virga_list_gpu head)
{
    for (uint bits = word.x | word.y; bits != 0u; bits &= bits - 1u) {
        const uint bit = findLSB(bits), second = (word.y >> bit) & 1u;
        const uint own_index = second != 0u ? index.y : index.x;
        if (own_index < (second != 0u ? head.second_kind : head.count))
            listed[entry + own_index] = slot + bit;
        index += uvec2(1u - second, second);
    }
}

// The same for a word of the selection that was scanned.
void write_word(uint word_index, uint slot, uint entry, virga_list_gpu head)
{
    const uvec4 word = selection[word_index];
    write_bits(word.xy, word.zw, slot, entry, head);
}

#ifndef COMPACT_LISTS
// Writes the invocation's word of the selection that was scanned, if there is one.
void write_own_word()
{
    const uint word = gl_GlobalInvocationID.x;
    virga_list_gpu head;
    head.count = list.count;
    head.second_kind = list.second_kind;
    if (word < list.word_count)
        write_word(word, 32u * word, 0u, head);
}

// Writes one slot into the list, if it is selected and there is room.
void write_slot(uint slot_index)
{
    const uvec4 word = selection[slot_index >> 5];
    const uint bit = 1u << (slot_index & 31u);
    const bool second = (word.y & bit) != 0u;
    const uint bits = second ? word.y : word.x;
    const uint index = (second ? word.w : word.z) + bitCount(bits & (bit - 1u));
    if ((bits & bit) != 0u && index < (second ? list.second_kind : list.count))
        listed[index] = slot_index;
}
#endif
