// scan_buffers.glsl - ordered compaction: which slots are picked, counted by workgroup, then scanned.
//
// A pass marks its picks as bits in shared memory (an OR does not care for order), the scan turns counts of groups into
// places, and the writing pass finds a slot's place by counting the bits before its own. So the list is in the order
// of slots, whatever order the device runs groups in.
layout(scalar, set = 0, binding = 5) buffer Picks { uint picks[]; }; // per group: 8 words of bits, a count, a place

#define PICK_WORDS 8
#define PICK_STRIDE 10

shared uint group_bits[PICK_WORDS];

void mark_pick(bool picked)
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane < PICK_WORDS)
        group_bits[lane] = 0u;
    barrier();
    if (picked)
        atomicOr(group_bits[lane >> 5], 1u << (lane & 31u));
    barrier();
    if (lane == 0u) {
        uint count = 0u;
        for (uint i = 0u; i < PICK_WORDS; i++) {
            picks[gl_WorkGroupID.x * PICK_STRIDE + i] = group_bits[i];
            count += bitCount(group_bits[i]);
        }
        picks[gl_WorkGroupID.x * PICK_STRIDE + PICK_WORDS] = count;
    }
}

// Place of this invocation's slot in the list, or 0xffffffff if it was not picked.
uint pick_place()
{
    const uint lane = gl_LocalInvocationIndex, base = gl_WorkGroupID.x * PICK_STRIDE;
    const uint own = picks[base + (lane >> 5)], bit = 1u << (lane & 31u);
    if ((own & bit) == 0u)
        return 0xffffffffu;
    uint place = picks[base + PICK_WORDS + 1] + bitCount(own & (bit - 1u));
    for (uint i = 0u; i < (lane >> 5); i++)
        place += bitCount(picks[base + i]);
    return place;
}
