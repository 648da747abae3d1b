/* glass/glass_internal.h - the object behind virga_glass, and what its files do for each other. Internal.
 *
 *   glass.c          create, destroy, settings, statistics
 *   glass_kinds.c    what holds drops on which surface
 *   glass_shape.c    panes flat and bent, masks, bumps: what the cells know
 *   glass_wipers.c   where blades are at a time
 *   glass_step.c     ticks
 *   glass_picture.c  what the height map and the draws need
 *   glass_draw.c     prepare, attach, draw
 *   glass_temporal.c where a pane was in the previous frame's picture
 */
#ifndef VIRGA_GLASS_INTERNAL_H
#define VIRGA_GLASS_INTERNAL_H

#include "gpu/bindings.h"
#include "gpu/context.h"
#include "gpu/pipelines.h"
#include "gpu/resources.h"

#include <virga/glass.h>
#include <virga/shared/glass_gpu.h>

#define GLASS_MOST_ARRIVALS 8192 /* of the rate, in a tick: beyond it each stands for several */
#define GLASS_MOST_IMPACTS  8192 /* of the host's list, in a step */

/* Side of a cell of the particles' grid, at the least. */
static inline float glass_least_grid_m(const virga_glass_def *def)
{
    return def->cell_m > 0.003f ? def->cell_m : 0.003f;
}

/* What the statistics ring reads back for one frame. */
typedef struct glass_readback {
    virga_glass_state_gpu state;
    uint32_t balls, balls_cut; /* as in virga_glass_work_gpu */
} glass_readback;

struct virga_glass {
    virga_context *context;
    virga_glass_def def;
    uint32_t columns, rows; /* cells */
    virga_glass_settings settings;
    uint64_t ticks;      /* run since creation */
    bool told_not_drawn; /* since the last draw that had all it needs */
    uint32_t last_tick;
    bool started;
    double host_deg[VIRGA_GLASS_MAX_WIPERS]; /* (host) at the end of the newest step */
    bool host_known;

    /* State of the pane. */
    virga_buffer *state, *drops, *picks, *list, *claims, *occupants, *film, *passed, *seeds, *ranks, *grid, *moved,
        *awake, *film_blocks;
    /* What the pane is like: cells (affinity, bump, mask) and the grid of its shape. */
    virga_buffer *surface, *nodes;
    virga_buffer *surface_upload, *nodes_upload; /* wait for the next step; NULL: none do */
    virga_buffer *tick_ring, *readback_ring;
    virga_bindings *bindings;
    virga_pipeline_group needed; /* for all but gathers and draws, of which there are many and few in use */
    virga_pipeline *census_find, *census_scan, *census_list, *move, *awake_scan, *awake_list, *choose, *enter,
        *capture_find, *capture, *wipe, *touch, *gather, *relax_sort, *relax, *leave_find, *leave, *place_claim,
        *place_scan, *place, *settle, *dry, *film_list, *measure;
    float normals[VIRGA_GLASS_NODES * VIRGA_GLASS_NODES][3]; /* of the nodes, for what lands */
    float farthest_m;                                        /* of the nodes from the pane's origin */
    bool masked;                                             /* there may be cells without glass */
    float outline[9][3];                /* 3 x 3 points of the shape, row by row, for how large it is on a picture */
    const virga_glass_tick_gpu *blades; /* of the tick that is recorded */
    bool particles_ever;                /* there may be particles */
    VkDescriptorSet step_set;
    VkBuffer impacts; /* of the step that is recorded */
    VkDeviceSize impacts_offset;
    uint64_t ring_frame;
    uint32_t ring_ticks, tick_offset;
    uint64_t frame_of_slot[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* whose state the ring holds; 0: none */
    virga_glass_stats stats;

    struct glass_picture *picture;
};

/* ---- glass_kinds.c */

/* Water (m^3) of a cap on a base with a radius of 1 m, by its contact angle: pi (2 - 3 cos + cos^3) / (3 sin^3). */
double glass_cap_volume(double angle_deg);
/* Mean of the two angles: that of a drop at rest. */
double glass_rest_deg(const virga_glass_settings *settings);
/* See virga_glass_tick_gpu. */
double glass_hold(const virga_glass_settings *settings);
double glass_drag(const virga_glass_settings *settings);

/* ---- glass_shape.c */
virga_result glass_shape_init(virga_glass *glass);

/* ---- glass_wipers.c */
void glass_fill_blades(virga_glass *glass, double from_s, double to_s, double share_from, double share_to,
                       virga_glass_tick_gpu *tick);

/* ---- glass_draw.c */
virga_result glass_pose_check(const virga_log *log, const virga_glass_pose *pose);

/* ---- glass.c */

/* Whole cells over a length; the last may stick out by a part. */
uint32_t glass_cells_along(float length_m, float cell_m);
/* Blocks of VIRGA_GLASS_FILM_BLOCK x VIRGA_GLASS_FILM_BLOCK cells. */
uint32_t glass_film_blocks(const virga_glass *glass);
VkDescriptorSet glass_write_set(virga_glass *glass);

/* ---- glass_step.c */
uint32_t glass_tick_bytes(void);
virga_result glass_axes_check(const virga_log *log, const char *name, const float axes[9]); /* all zero: none */
void glass_take_statistics(virga_glass *glass);
void glass_fill_sizes(const double *diameters, const double *fluxes, uint32_t count, double stands_for,
                      float sizes_m[VIRGA_GLASS_SIZES]);

/* ---- glass_picture.c: a part of its own, that reads drops, list, film, passed and nodes. */
virga_result glass_picture_create(virga_glass *glass);

/* Pipelines that these settings need and that are not there yet, see virga_context_def.pipelines. */
virga_result glass_picture_need(virga_glass *glass, const virga_glass_settings *settings);
void glass_picture_destroy(virga_glass *glass);
VkDeviceSize glass_picture_estimate(const virga_glass_def *def);
/* Takes in what completed frames' prepares have counted: the newest. After the ring has been invalidated. */
void glass_picture_take_statistics(virga_glass *glass);

#endif
