/* rain_gpu.h - what rain's passes share with the C code that feeds them. Internal to Virga. */
#ifndef VIRGA_SHARED_RAIN_GPU_H
#define VIRGA_SHARED_RAIN_GPU_H

#include "rain_limits.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_slot_gpu virga_slot_gpu;
typedef struct virga_class_gpu virga_class_gpu;
typedef struct virga_weight_gpu virga_weight_gpu;
typedef struct virga_travel_gpu virga_travel_gpu;
typedef struct virga_tick_gpu virga_tick_gpu;
typedef struct virga_map_gpu virga_map_gpu;
typedef struct virga_rain_look_gpu virga_rain_look_gpu;
typedef struct virga_streak_gpu virga_streak_gpu;
typedef struct virga_rain_pane_gpu virga_rain_pane_gpu;
typedef struct virga_sway_gpu virga_sway_gpu;
typedef struct virga_draw_gpu virga_draw_gpu;
typedef struct virga_prepared_gpu virga_prepared_gpu;
typedef struct virga_rain_total_gpu virga_rain_total_gpu;
#endif

/* A slot: its position in the lattice of its size class, and its rank. Constant. */
struct virga_slot_gpu {
    uint lattice[3]; /* position as a fraction of the box's side, in units of 2^-32 */
    /* low 16 bits: size class; high 16 bits: rank [0; 65535] among the slots of its class, for thinning */
    uint class_rank;
};

/* Distance that a class's lattice has moved since the start of time, minus the camera's position: 64-bit fixed point in
 * units of the largest box's side x 2^-32. All classes together fit the smallest uniform buffer size that Vulkan
 * guarantees. */
struct virga_travel_gpu {
    uint low[4]; /* x, y, z; the fourth is unused */
    uint high[4];
};

/* A size class at a tick. */
struct virga_class_gpu {
    float velocity[3];  /* m/s */
    float diameter_m;   /* m */
    float terminal_m_s; /* m/s, terminal velocity in still air */
    float drag;         /* coefficient of the implicit step for velocity: (before + drag wind - g t) / (1 + drag) */
    uint slant;         /* index of the slant whose occlusion maps its drops use */
};

/* Number of drops that a slot of a class represents in a box. */
struct virga_weight_gpu {
    float drops;     /* multiplied by presence() of the threshold */
    float threshold; /* slots with a lower rank are present, with a soft transition; > 1: all slots */
};

/* Parameters of all passes of a tick, besides maps, classes and weights. */
struct virga_tick_gpu {
    float side_m;           /* m, side of the largest box */
    uint levels;            /* number of nested boxes */
    float levels_per_group; /* 1 / workgroups per box */
    uint groups;            /* total number of workgroups */
    uint seed;
    uint tick;
    float tick_s; /* s, length of a tick */
    uint tick_in_step;
    uint max_impacts;
    uint maps; /* number of occlusion maps in use; 0: none */
    uint slants;
    uint cascades;
    float origin[3]; /* m, origin of positions, in the world */
    uint default_material;
    float wind_min[3];   /* m, low corner of the 3D wind, relative to origin */
    uint sway;           /* 1: drops are integrated in a 3D wind */
    float wind_scale[3]; /* 1/m, 1 / size of the 3D wind */
    uint wind_given;     /* 0: no wind texture at present; the drops' extra motion decays */
    float wind_mean[3];  /* m/s, uniform wind of this tick, gust included */
    uint host_depth;     /* 1: occlusion maps come from the host, without normals and materials */
    float gravity;       /* m/s^2 */
    float map_texels;    /* along the side of an occlusion map */
    float map_top_m;     /* m, height of depth 0, relative to the origin */
    float map_height_m;  /* m, from depth 0 to depth 1 */
};

/* An occlusion map. A drop with slant s falls along a line. The line through (x, y, z) has the texel of
 * (x + s.x (y - y0), z + s.y (y - y0)). The texel's depth is the first intersection of the line with a surface. All
 * maps have the same size, top and height, see virga_tick_gpu. */
struct virga_map_gpu {
    float texels_per_m;
    float slant[2];  /* texels per metre of fall */
    float origin[2]; /* position of the step's origin, in texels */
};

#define VIRGA_RAIN_BENT 65 /* one more than the bins of the phase function */

/* Rain's settings for a view, in addition to virga_view_gpu. */
struct virga_rain_look_gpu {
    float streak_gain;           /* factor of the coverage */
    float oscillation;           /* amplitude of shape oscillation; 1: physical */
    float streak_min_m;          /* m, diameter; smaller drops are drawn as haze */
    float group_m;               /* m, diameter: a streak of many drops covers no more than this drop */
    float group_m_s;             /* m/s, its terminal speed */
    float sky_m;                 /* m, thickness of the haze in front of the sky */
    float glow;                  /* factor of the light of lamps in haze */
    float bent[VIRGA_RAIN_BENT]; /* integral of the drops' phase function from 0 to i pi / (VIRGA_RAIN_BENT - 1) */
    float haze_inner_m;          /* m, radius of the innermost box; each next box is twice as large */
    /* 1/m, light that hits drops which are not drawn as streaks, by box; the last entry is for everything beyond */
    float haze_per_m[VIRGA_RAIN_MAX_LEVELS + 1];
    /* Haze along a ray starts at the view depth begin.xyz . ray + begin.w, where the ray is scaled to a view depth of
     * 1 m. If that is not a valid depth, the ray has no haze. */
    float begin[4];
    float parts; /* number of averaged views, each with its part of the shutter interval */
    uint max_streaks;
    uint lines;  /* 1: the thinnest streaks are drawn as lines */
    uint motion; /* 1: motion vectors are written after the streaks, one vec4 each: of head and tail (px) */
};

/* A pane that catches drops, at the end of a step. */
struct virga_rain_pane_gpu {
    float corner[3];  /* m, relative to the origin of the step */
    float width_m;    /* m */
    float along_u[3]; /* unit length */
    float height_m;   /* m */
    float along_v[3];
    float step_s;      /* s, length of the step */
    float velocity[3]; /* m/s */
    uint first_tick;
    uint ticks;
    uint groups; /* workgroups of the slots that may reach it */
};

/* A streak, ready to be drawn, 64 bytes. Pairs are two half floats, the first in the low bits. */
struct virga_streak_gpu {
    float head[2];     /* NDC x, y of the drop at the end of the shutter interval, or where it hit something */
    float tail[2];     /* NDC x, y of the drop at the start of the shutter interval */
    float depth[2];    /* head, tail: depth buffer value */
    float distance[2]; /* head, tail: view depth (m) */
    uint width_alpha;  /* drawn width (px); coverage at the centre line */
    /* length of the drop itself along the streak (px); relative amplitude of the brightness oscillation */
    uint body_wave;
    uint oscillations; /* oscillations along the streak; phase at the tail, in periods */
    uint order;        /* bucket x VIRGA_RAIN_GROUP + rank in it, see shaders/rain/draw/order.glsl */
    uint light[3];     /* radiance at the centre line (rgb), then at the edge (rgb) */
    uint id;           /* of the drop */
};

/* Displacement of a slot's drop by the 3D wind, relative to the uniform wind, 40 bytes. */
struct virga_sway_gpu {
    uint offset_low[3]; /* 64-bit fixed point in units of its box's side x 2^-32 */
    uint offset_high[3];
    float velocity[3]; /* m/s, minus the velocity of its class */
    uint pad;
};

/* Arguments of an indexed indirect draw, in Vulkan's layout. */
struct virga_draw_gpu {
    uint index_count;
    uint instance_count;
    uint first_index;
    int vertex_offset;
    uint first_instance;
};

/* Result of a prepare: draws of wide quads (the drop refracts what is behind it), of lines and of thin quads; then
 * counts, which include streaks with zero coverage. */
/* Water of all impacts since creation, without those of the newest step. */
struct virga_rain_total_gpu {
    uint nl_low; /* 64-bit */
    uint nl_high;
};

struct virga_prepared_gpu {
    virga_draw_gpu wide_quads;
    virga_draw_gpu lines;
    virga_draw_gpu thin_quads;
    uint streaks;
    uint dropped;
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_slot_gpu, 16);
VIRGA_ASSERT_SIZE(virga_travel_gpu, 32);
VIRGA_ASSERT_SIZE(virga_class_gpu, 28);
VIRGA_ASSERT_SIZE(virga_weight_gpu, 8);
VIRGA_ASSERT_SIZE(virga_tick_gpu, 128);
VIRGA_ASSERT_OFFSET(virga_tick_gpu, wind_min, 64);
VIRGA_ASSERT_SIZE(virga_map_gpu, 20);
VIRGA_ASSERT_SIZE(virga_rain_look_gpu, 376);
VIRGA_ASSERT_SIZE(virga_rain_pane_gpu, 72);
VIRGA_ASSERT_SIZE(virga_streak_gpu, 64);
VIRGA_ASSERT_SIZE(virga_sway_gpu, 40);
VIRGA_ASSERT_SIZE(virga_draw_gpu, 20);
VIRGA_ASSERT_SIZE(virga_prepared_gpu, 68);
VIRGA_ASSERT_SIZE(virga_rain_total_gpu, 8);
#undef uint
#endif

#endif
