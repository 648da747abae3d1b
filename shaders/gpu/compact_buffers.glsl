// compact_buffers.glsl - ordered compaction: which slots are picked, and the list of them.
//
// Four passes, of which an effect writes what is its own around compact_find, compact_scan, compact_list and this file:
//
// find:  each slot's pick becomes a bit in shared memory (an OR does not care for order), 32 slots to a word
// scan:  one workgroup turns the words' counts into places
// list:  each picked slot's number goes to its place: a lane for each word of slots, or for each slot, which finds its
//        place by counting the bits before its own
// write: a dispatch as long as the list, so that no invocation works for a slot that was not picked
//
// The list is in the order of slots, whatever order the device runs groups in. Slots are picked as one of two kinds,
// and the list has all of the second kind first.
//
// The includer says in COMPACT_GROUP how many slots a workgroup has (a multiple of 32, and the local size of find, list
// and write; that of scan is SCAN_LANES, 256 where nothing else is said), and in COMPACT_PICKS_BINDING and
// COMPACT_LIST_BINDING where the two buffers are bound. The host gives the picks VIRGA_PICK_BYTES, records the first
// three passes with virga_record_list and the last with virga_dispatch_indirect.
//
// With COMPACT_LISTS there are so many lists in the buffer: their heads, then what they list. Which words of picks
// belong to which is the includer's affair, and so is the recording; place_picks and list_word take the words.
#ifndef COMPACT_BUFFERS
#define COMPACT_BUFFERS
#include "shared/compact.h"

#ifndef COMPACT_ACCESS
#define COMPACT_ACCESS // readonly where a vertex shader reads the list, coherent where lanes see what others wrote
#endif

layout(std430, set = 0, binding = COMPACT_PICKS_BINDING) COMPACT_ACCESS buffer Picks
{
    uvec4 picks[]; // a word's bits of each kind; places of each kind
};
layout(scalar, set = 0, binding = COMPACT_LIST_BINDING) COMPACT_ACCESS buffer List
{
#ifdef COMPACT_LISTS
    virga_list_gpu lists[COMPACT_LISTS];
#else
    virga_list_gpu list;
#endif
    uint listed[]; // slots
};

#define NOT_PICKED 0u
#define FIRST_KIND 1u
#define SECOND_KIND 2u
#define GROUP_WORDS (COMPACT_GROUP / 32)
#endif
