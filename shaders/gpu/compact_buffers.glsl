// compact_buffers.glsl - ordered stream compaction: buffers. Slots are selected, and the numbers of the selected slots
// become a list.
//
// Four passes. An effect writes its own part of each around this file and the ones named below:
//
//     mark     compact_mark.glsl: each slot that is selected sets a bit in shared memory; 32 slots share a word
//     scan     compact_scan.glsl: one workgroup computes the prefix sum of the bits in the words
//     compact  compact_write.glsl: each selected slot's number is written to its index in the list, by one invocation
//              for each word of 32 slots, or for each slot
//     use      the effect's own: an indirect dispatch as long as the list
//
// On a GPU a pass of one workgroup costs as much as waiting for it. Lists that virga_record_list records have no scan
// there: mark, with begin_list, leaves the sums of each workgroup, and compact (compact_summed.glsl) adds them up.
//
// The list is in the order of the slots, in whatever order the device runs workgroups. A slot is selected as one of two
// kinds. All entries of the second kind come first.
//
// The includer defines COMPACT_GROUP, the slots of a workgroup: a multiple of 32, and the local size of every pass but
// scan, whose local size is SCAN_LANES (256 by default). COMPACT_SELECTION_BINDING and COMPACT_LIST_BINDING are the
// bindings of the two buffers. The host gives the selection VIRGA_SELECTION_BYTES, records the first three passes with
// virga_record_list, and the last with virga_dispatch_indirect.
//
// With COMPACT_LISTS the list buffer holds that many lists: first their heads, then their entries. The includer decides
// which words belong to which list and records the passes itself, with scan_words and write_word.
#ifndef COMPACT_BUFFERS
#define COMPACT_BUFFERS
#include "shared/compact.h"

#ifndef COMPACT_ACCESS
#define COMPACT_ACCESS // readonly in vertex shaders; coherent where invocations read what others wrote
#endif

layout(std430, set = 0, binding = COMPACT_SELECTION_BINDING) COMPACT_ACCESS buffer Selection
{
    uvec4 selection[]; // x, y: bits of the first and the second kind; z, w: list index of each kind's first
};
layout(scalar, set = 0, binding = COMPACT_LIST_BINDING) COMPACT_ACCESS buffer List
{
#ifdef COMPACT_LISTS
    virga_list_gpu lists[COMPACT_LISTS];
#else
    virga_list_gpu list;
#endif
    uint listed[]; // slot numbers
};

#include "gpu/variants.glsl"

#define NOT_SELECTED 0u
#define FIRST_KIND 1u
#define SECOND_KIND 2u
#define GROUP_WORDS (COMPACT_GROUP / 32)
#endif
