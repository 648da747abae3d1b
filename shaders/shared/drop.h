/* drop.h - a falling drop as the step leaves it, for the passes that follow and for hosts that read drops. */
#ifndef VIRGA_SHARED_DROP_H
#define VIRGA_SHARED_DROP_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_drop_gpu virga_drop_gpu;
#endif

/* One slot's drop, 16 bytes. The size class of slot i is in the slot itself (virga_slot_gpu); velocity, diameter and
 * weight follow from it. */
struct virga_drop_gpu {
    float position[3]; /* m, relative to the origin of the step, at the end of its newest tick */
    uint id;           /* unique among the drops alive; keeps while the drop falls */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_drop_gpu, 16);
#undef uint
#endif

#endif
