/* environment_gpu.h - what the passes of the environment share with C. Internal to Virga. */
#ifndef VIRGA_SHARED_ENVIRONMENT_GPU_H
#define VIRGA_SHARED_ENVIRONMENT_GPU_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_environment_gpu virga_environment_gpu;
typedef struct virga_environment_sum_gpu virga_environment_sum_gpu;
#endif

#define VIRGA_ENVIRONMENT_GROUP  128
#define VIRGA_ENVIRONMENT_GROUPS 1024 /* workgroups at most; each goes on to further texels */

struct virga_environment_gpu {
    uint kind;        /* virga_environment_kind */
    uint width;       /* texels that are read: of the image, of a face, or of the viewport */
    uint height;      /* texels */
    uint color_given; /* VIRGA_COLOR_..., see view_gpu.h */
    uint groups;      /* workgroups of the first pass */
    uint left;        /* (picture) px, the viewport's corner */
    uint top;
    float gain;
    float image_from_world[9]; /* three rows */
    float rest_sh[27];
    float right[3]; /* (picture) camera axes, as virga_view_gpu has them */
    float up[3];
    float ahead[3];
    float clip_from_rel[16];
};

/* Light times harmonics times solid angle, and the sum of solid angles. */
struct virga_environment_sum_gpu {
    float sh[27];
    float weight; /* sr */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_environment_gpu, 276);
VIRGA_ASSERT_SIZE(virga_environment_sum_gpu, 112);
#undef uint
#endif

#endif
