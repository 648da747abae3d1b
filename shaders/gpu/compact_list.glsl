// compact_list.glsl - the listing part of ordered compaction, see compact_buffers.glsl.
#include "gpu/compact_buffers.glsl"

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
