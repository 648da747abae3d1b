/* drop.h - a falling drop as the step writes it. Later passes read it, and hosts may. */
#ifndef VIRGA_SHARED_DROP_H
#define VIRGA_SHARED_DROP_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_drop_gpu virga_drop_gpu;
#endif

/* The drop of one slot, 16 bytes. The size class of slot i is in virga_slot_gpu. Velocity, diameter and weight follow
 * from the class. */
struct virga_drop_gpu {
    float position[3]; /* m, relative to the origin of the step, at the end of the newest tick */
    uint id;           /* unique among live drops; constant while the drop falls */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_drop_gpu, 16);
#undef uint
#endif

#endif
