/* compact.h - the list that ordered stream compaction writes, see shaders/gpu/compact_buffers.glsl. Internal to
 * Virga. */
#ifndef VIRGA_SHARED_COMPACT_H
#define VIRGA_SHARED_COMPACT_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_list_gpu virga_list_gpu;
#endif

/* Head of the list of selected slots. The slot numbers follow. */
struct virga_list_gpu {
    uint group_count[3]; /* workgroups of an indirect dispatch over the list */
    uint count;          /* slots in the list */
    uint second_kind;    /* slots of the second kind; they come first in the list */
    uint first;          /* free for the pass to use: index in its output of the list's first entry */
    uint word_count;     /* number of 32-bit words of the selection, one bit per slot */
    uint capacity;       /* room of the list, where no pass scans the selection */
    uint found;          /* selected slots, also those without room; only where no pass scans the selection */
    uint pad;
};

#ifndef VIRGA_GLSL
/* size of the buffer of the selection; `slots` is a multiple of the workgroup size */
#define VIRGA_SELECTION_BYTES(slots) ((slots) / 32 * 16)

VIRGA_ASSERT_SIZE(virga_list_gpu, 40);
#undef uint
#endif

#endif
