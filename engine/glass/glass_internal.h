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

#include "glass/glass.h"
#include "glass/glass_picture.h"
#include "gpu/context.h"
#include "gpu/effect.h"

#include <virga/glass.h>
#include <virga/shared/glass_gpu.h>

#define GLASS_MAX_ARRIVALS 8192 /* of the rate, in a tick: beyond it each stands for several */
#define GLASS_MAX_IMPACTS  8192 /* of the host's list, in a step */

/* Side of a cell of the particles' grid, at the least. */
static inline float glass_min_grid_m(const virga_glass_def *def)
{
    return def->cell_m > 0.003f ? def->cell_m : 0.003f;
}

/* What is read back of one frame. */
typedef struct glass_readback {
    virga_glass_state_gpu state;          /* of its step */
    uint32_t balls, ball_entries_dropped; /* of its prepare, as in virga_glass_work_gpu */
} glass_readback;

enum { GLASS_PART_STEP, GLASS_PART_PREPARE }; /* of the statistics */

struct virga_glass {
    virga_effect base; /* first */
    virga_glass_def def;
    uint32_t columns, rows; /* cells */
    virga_glass_settings settings;
    uint64_t ticks; /* run since creation */
    uint32_t last_tick;
    double host_deg[VIRGA_GLASS_MAX_WIPERS]; /* (host) at the end of the newest step */
    bool host_known;

    /* State of the pane. */
    virga_buffer *state, *drops, *picks, *list, *claims, *occupants, *film, *passed, *seeds, *ranks, *grid, *moved,
        *active, *film_blocks;
    /* What the pane is like: cells (affinity, bump, mask) and the grid of its shape. */
    virga_buffer *surface, *nodes;
    virga_buffer *surface_upload, *nodes_upload; /* wait for the next step; NULL: none do */
    virga_ring tick_ring;
    uint32_t tick_offset; /* of the newest tick */
    virga_bindings *bindings;
    virga_pipeline *live_mark, *live_scan, *live_compact, *begin_tick, *active_scan, *active_compact, *choose_cell,
        *enter_cell, *capture_mark, *capture, *wipe_film, *split_drops, *empty_bins, *particle_grid, *push_particles,
        *to_drops_claim, *to_drops, *spawn_claim, *spawn_scan, *spawn, *end_tick, *dry_film, *film_compact, *measure;
    float normals[VIRGA_GLASS_NODES * VIRGA_GLASS_NODES][3]; /* of the nodes, for what lands */
    float farthest_m;                                        /* of the nodes from the pane's origin */
    bool masked;                                             /* there may be cells without glass */
    float outline[9][3];         /* 3 x 3 points of the shape, row by row, for how large it is on a picture */
    virga_glass_tick_gpu blades; /* of the tick that is recorded */
    bool particles_ever;         /* there may be particles */
    VkDescriptorSet step_set;
    VkBuffer impacts; /* of the step that is recorded */
    VkDeviceSize impacts_offset;
    virga_glass_stats stats;

    struct glass_picture picture;
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

/* ---- glass.c */

/* Whole cells over a length; the last may stick out by a part. */
uint32_t glass_cells_along(float length_m, float cell_m);
/* Blocks of VIRGA_GLASS_FILM_BLOCK x VIRGA_GLASS_FILM_BLOCK cells. */
uint32_t glass_film_blocks(const virga_glass_def *def);
VkDescriptorSet glass_write_set(virga_glass *glass);

/* The pane as its passes know it. */
virga_glass_pane_gpu glass_describe_pane(const virga_glass *glass);

/* ---- glass_step.c */
virga_result glass_axes_check(const virga_log *log, const char *name, const float axes[9]); /* all zero: none */
void glass_read_statistics(void *glass, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);
void glass_fill_sizes(const double *diameters, const double *fluxes, uint32_t count, double stands_for,
                      float sizes_m[VIRGA_GLASS_SIZES]);

#endif
