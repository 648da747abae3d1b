/* view_gpu.h - a view and its lights, for the draw passes of all effects. Internal to Virga. */
#ifndef VIRGA_SHARED_VIEW_GPU_H
#define VIRGA_SHARED_VIEW_GPU_H

#include "light_limits.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_light_gpu virga_light_gpu;
typedef struct virga_view_gpu virga_view_gpu;
#endif

/* How the values of the host's picture are read, see virga_view.color_encoding. */
#define VIRGA_COLOR_LINEAR 1u
#define VIRGA_COLOR_SRGB   2u

struct virga_light_gpu {
    float position[3]; /* m, relative to the camera */
    float inv_range;   /* 1/m, 1 / range */
    float intensity[3];
    float cos_outer; /* cosine of the outer angle of the cone */
    float direction[3];
    float inv_cos_width; /* 1 / (cosine of the inner angle - cos_outer) */
};

/* Times (s) are relative to the time of the state that is drawn. (look): from the settings of the effect. */
struct virga_view_gpu {
    float clip_from_rel[16];      /* positions relative to the camera at shutter close -> clip space */
    float open_clip_from_rel[16]; /* the same positions -> clip space of the camera at shutter open */
    /* Camera axes in the world, scaled so that right x ndc.x + up x ndc.y + ahead is the ray of a pixel at
     * view depth 1. */
    float right[3];
    float time_close_s; /* s, shutter close: the end of the interval */
    float up[3];
    float time_open_s; /* s, shutter open: the start of the interval */
    float ahead[3];
    float depth_a;          /* view depth = depth_b / (depth_a + depth buffer value) */
    float origin_offset[3]; /* m, origin of positions minus camera: added to positions */
    float depth_b;
    float viewport[4];
    float light_gain;   /* (look) factor of the light from lights */
    float min_width_px; /* (look) px; narrower things are drawn with this width and less coverage */
    float soft_m;       /* (look) m, range of depth over which things fade where they meet geometry */
    float near_fade_m;  /* (look) m, things nearer to the camera fade out */
    float pixel_angle;  /* tangent of the angle of a pixel at the centre of the picture */
    float far_depth;    /* depth buffer value of the background */
    uint depth_given;
    uint color_given; /* VIRGA_COLOR_...; 0: not given */
    uint light_count;
    float sh[27];          /* environment light: spherical harmonics, coefficient-major RGB */
    float phase_moment[3]; /* first three Legendre moments of the phase function */
    float phase[64];       /* phase function (1/sr) by angle, 64 bins over [0; pi] */
    virga_light_gpu lights[VIRGA_MAX_LIGHTS];
    float previous_clip_from_rel[16]; /* the same positions -> clip space of the previous frame's camera */
    float frame_interval_s;           /* s, from the previous frame to shutter close */
    float motion_scale[2];            /* scale of motion vectors */
    float motion_coverage;            /* what covers less keeps the motion vector that is already there */
    float reactive_gain;              /* reactive mask: 1 - (1 - coverage)^reactive_gain */
    uint motion_given;
    float lens_px;        /* blur at a distance d: lens_px |inv_focus - 1 / d| pixels */
    float inv_focus;      /* 1/m, 1 / focus distance */
    uint multiview_index; /* view of the pass, see virga_view.multiview_index */
    float jitter[2];      /* NDC, by which the projections of this view shift the picture */
};

#define VIRGA_VIEW_SH_WORD 61u /* offset of `sh` in 32-bit words */

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_light_gpu, 48);
VIRGA_ASSERT_OFFSET(virga_view_gpu, sh, 4 * VIRGA_VIEW_SH_WORD);
VIRGA_ASSERT_OFFSET(virga_view_gpu, lights, 620);
#undef uint
#endif

#endif
