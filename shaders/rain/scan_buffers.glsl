// scan_buffers.glsl - ordered compaction: which slots are picked, and the list of them.
//
// find:  each slot's pick becomes a bit in shared memory (an OR does not care for order), 32 slots to a word
// scan:  one workgroup turns the words' counts into places
// list:  each picked slot finds its place by counting the bits before its own, and writes its number there
// write: a dispatch as long as the list, so that no invocation works for a slot that was not picked
//
// The list is in the order of slots, whatever order the device runs groups in. Slots are picked as one of two kinds,
// and the list has all of the second kind first.
layout(std430, set = 0, binding = 5) buffer Picks { uvec4 picks[]; }; // a word's bits of each kind; places of each kind
layout(scalar, set = 0, binding = 16) buffer List
{
    virga_list_gpu list;
    uint listed[]; // slots
};

#define NOT_PICKED 0u
#define FIRST_KIND 1u
#define SECOND_KIND 2u
#define GROUP_WORDS (VIRGA_RAIN_GROUP / 32)
