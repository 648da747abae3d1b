/* compact.h - the list that ordered compaction makes, see shaders/gpu/compact_buffers.glsl. Internal to Virga. */
#ifndef VIRGA_SHARED_COMPACT_H
#define VIRGA_SHARED_COMPACT_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_list_gpu virga_list_gpu;
#endif

/* Head of the list of picked slots; their numbers follow. */
struct virga_list_gpu {
    uint group_count[3]; /* of the dispatch that works through the list */
    uint count;
    uint second_kind; /* how many of them, at the front, are of the second kind */
    uint first;       /* free for the pass: where in its output the list's entries go */
    uint word_count;  /* of picks that it is made from */
    uint pad;
};

#ifndef VIRGA_GLSL
#define VIRGA_PICK_BYTES(slots) ((slots) / 32 * 16) /* of the buffer of picks; slots are whole workgroups */

VIRGA_ASSERT_SIZE(virga_list_gpu, 32);
#undef uint
#endif

#endif
