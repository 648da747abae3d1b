/* view_gpu.h - a view and its light, as the passes of every effect that draws read them. Internal to Virga. */
#ifndef VIRGA_SHARED_VIEW_GPU_H
#define VIRGA_SHARED_VIEW_GPU_H

#include "light_limits.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_light_gpu virga_light_gpu;
typedef struct virga_view_gpu virga_view_gpu;
#endif

struct virga_light_gpu {
    float position[3]; /* relative to the camera */
    float inv_range;
    float intensity[3];
    float cos_outer;
    float direction[3];
    float inv_cos_width;
};

/* Times are from the time of the state that is drawn. What the effect's own settings say is marked (look). */
struct virga_view_gpu {
    float clip_from_rel[16];      /* from positions relative to the camera at the shutter's end */
    float open_clip_from_rel[16]; /* from the same positions, to where the camera at the shutter's start saw them */
    float right[3];               /* camera axes in the world, scaled so that right x ndc.x + up x ndc.y + ahead is */
    float time_close_s;           /* the ray of a pixel with view depth 1; and the shutter's end */
    float up[3];
    float time_open_s;
    float ahead[3];
    float depth_a;          /* view depth = depth_b / (depth_a + depth in the buffer) */
    float origin_offset[3]; /* origin of positions minus camera: added to positions */
    float depth_b;
    float viewport[4];
    float light_gain;   /* (look) multiplies light from lights */
    float min_width_px; /* (look) what is narrower is drawn this wide with less coverage */
    float soft_m;       /* (look) depth over which geometry is faded into */
    float near_fade_m;  /* (look) what is nearer to the camera fades out */
    float pixel_angle;  /* tangent of a pixel's angle at the centre */
    float far_depth;    /* value of the depth buffer where there is nothing */
    uint depth_given;
    uint color_given;
    uint light_count;
    float sh[27]; /* environment, coefficient-major RGB */
    float phase_moment[3];
    float phase[64]; /* 1/sr by angle, 64 bins over [0; pi] */
    virga_light_gpu lights[VIRGA_MAX_LIGHTS];
    float previous_clip_from_rel[16]; /* from the same positions, to where the camera of the previous frame saw them */
    float frame_interval_s;           /* from then to the shutter's end */
    float motion_scale[2];
    float motion_coverage; /* what covers less leaves the motion vector that is there */
    float reactive_gain;
    uint motion_given;
    float lens_px; /* what is d away is blurred over lens_px |inv_focus - 1 / d| pixels */
    float inv_focus;
};

#define VIRGA_VIEW_SH_WORD 61u /* that `sh` begins with */

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_light_gpu, 48);
VIRGA_ASSERT_OFFSET(virga_view_gpu, sh, 4 * VIRGA_VIEW_SH_WORD);
VIRGA_ASSERT_OFFSET(virga_view_gpu, lights, 620);
#undef uint
#endif

#endif
