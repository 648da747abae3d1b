/* rain_gpu.h - what rain's passes share with the C that feeds them. Internal to Virga. */
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
#endif

/* A slot: its position in the lattice of its class, and which drops it stands for. Never changes. */
struct virga_slot_gpu {
    uint lattice[3]; /* fraction of the box's side, in units of 2^-32 */
    uint class_rank; /* low 16 bits: class; high 16: where among the slots of its class, for thinning [0; 65535] */
};

/* How far a class's lattice has moved since the start of time, less the camera's position: 64-bit fixed point in units
 * of the widest box's side x 2^-32. All classes together fit the smallest uniform buffer that Vulkan allows. */
struct virga_travel_gpu {
    uint low[4]; /* x, y, z; the fourth is not used */
    uint high[4];
};

/* A size class at a tick. */
struct virga_class_gpu {
    float velocity[3]; /* m/s */
    float diameter_m;
    float terminal_m_s; /* in still air */
    float drag;         /* factor of the implicit step that led to velocity: (before + drag wind - g t) / (1 + drag) */
    uint slant;         /* which slant's maps its drops use */
};

/* How many drops a slot of a class stands for in a box. */
struct virga_weight_gpu {
    float drops;     /* times presence() of the threshold */
    float threshold; /* slots of a rank below it are there, softly; above 1: all */
};

/* All that a tick's passes need besides maps, classes and weights. */
struct virga_tick_gpu {
    float side_m; /* of the widest box */
    uint levels;
    float levels_per_group; /* 1 / the workgroups to a box */
    uint groups;            /* workgroups in all */
    uint seed;
    uint tick;
    float tick_s;
    uint tick_in_step;
    uint max_impacts;
    uint maps; /* occlusion maps in use; 0: none */
    uint slants;
    uint cascades;
    float origin[3]; /* of positions, in the world */
    uint default_material;
    float wind_min[3];   /* of the 3D wind, relative to origin */
    uint sway;           /* 1: drops are integrated in a 3D wind */
    float wind_scale[3]; /* 1 / its size */
    uint wind_given;     /* 0: no texture at present, drops calm down */
    float wind_mean[3];  /* uniform wind of this tick, gust included */
    uint host_depth;     /* 1: maps come from the host, without normals and materials */
    float gravity;
    float map_texels;   /* along a map's side */
    float map_top_m;    /* height of depth 0, relative to the origin */
    float map_height_m; /* between depth 0 and depth 1 */
};

/* An occlusion map. The line that a drop of slant s falls along is the texel of
 * (x + s.x (y - y0), z + s.y (y - y0)), so a texel's depth is where that line first meets something. All maps have one
 * size, top and height, see virga_tick_gpu. */
struct virga_map_gpu {
    float texels_per_m;
    float slant[2];  /* texels a metre of fall */
    float origin[2]; /* where the step's origin is, in texels */
};

#define VIRGA_RAIN_BENT 65 /* one more than the phase function has bins */

/* What rain's settings say of a view, beside virga_view_gpu. */
struct virga_rain_look_gpu {
    float streak_gain;           /* multiplies coverage */
    float oscillation;           /* amplitude of shape oscillation, 1: physical */
    float streak_min_m;          /* smaller drops are haze */
    float sky_m;                 /* of haze before the sky */
    float glow;                  /* multiplies the light of lamps in haze */
    float bent[VIRGA_RAIN_BENT]; /* integral of the drops' phase function from 0 to i pi / (VIRGA_RAIN_BENT - 1) */
    float haze_inner_m;          /* radius of the innermost box; each next one is twice as wide */
    float haze_per_m[VIRGA_RAIN_MAX_LEVELS + 1]; /* extinction of what is not drawn one by one, by box; all beyond */
    /* a ray, as long as to a view depth of 1 m, is hazed from the depth 1 / (begin.xyz ray + begin.w) on; not at all
     * where that is no depth */
    float begin[4];
    float parts; /* views that are averaged, each with its part of the shutter */
    uint max_streaks;
    uint lines;  /* 1: the thinnest streaks are lines */
    uint motion; /* 1: motions are written behind the streaks, a vec4 each: of head and tail (px) */
};

/* A pane that drops are caught on, at the end of a step. */
struct virga_rain_pane_gpu {
    float corner[3]; /* relative to the origin of the step */
    float width_m;
    float along_u[3]; /* unit length */
    float height_m;
    float along_v[3];
    float step_s;      /* length of the step */
    float velocity[3]; /* m/s */
    uint first_tick;
    uint ticks;
    uint groups; /* workgroups of slots that may reach it */
};

/* A streak ready to be drawn, 64 bytes. Pairs are two half floats, the first in the low bits. */
struct virga_streak_gpu {
    float head[2];     /* where it is at the shutter's end (or where it met something), normalised device x, y */
    float tail[2];     /* where it was at its start */
    float depth[2];    /* head, tail: depth in the buffer's terms */
    float distance[2]; /* head, tail: view depth (m) */
    uint width_alpha;  /* drawn width (px); coverage at the middle line */
    /* length of the drop itself along the streak (px); relative amplitude of the wave in its light */
    uint body_wave;
    uint oscillations; /* oscillations along the streak; where in a turn it is at the tail */
    uint order;        /* see shaders/rain/draw/order.glsl: bucket x VIRGA_RAIN_GROUP + rank there */
    uint light[3];     /* radiance at the middle line (rgb), then at the edge (rgb) */
    uint id;           /* of the drop */
};

/* What 3D wind has done to a slot's drop beyond the uniform wind, 40 bytes. */
struct virga_sway_gpu {
    uint offset_low[3]; /* 64-bit fixed point in units of its own box's side x 2^-32 */
    uint offset_high[3];
    float velocity[3]; /* m/s, beyond its class's */
    uint pad;
};

/* Arguments of an indexed indirect draw, as Vulkan lays them out. */
struct virga_draw_gpu {
    uint index_count;
    uint instance_count;
    uint first_index;
    int vertex_offset;
    uint first_instance;
};

/* What a prepare found: draws of wide streaks, which show what is in a drop, of thin ones and of those of these that
 * are lines; and counts, also of streaks that turned out to cover nothing. */
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
VIRGA_ASSERT_SIZE(virga_rain_look_gpu, 368);
VIRGA_ASSERT_SIZE(virga_rain_pane_gpu, 72);
VIRGA_ASSERT_SIZE(virga_streak_gpu, 64);
VIRGA_ASSERT_SIZE(virga_sway_gpu, 40);
VIRGA_ASSERT_SIZE(virga_draw_gpu, 20);
VIRGA_ASSERT_SIZE(virga_prepared_gpu, 68);
#undef uint
#endif

#endif
