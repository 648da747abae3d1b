/* glass/glass_internal.h - defines the struct of virga_glass and the functions its files share. Internal.
 *
 *   glass.c          create, destroy, settings, statistics
 *   glass_kinds.c    contact angles and adhesion of each kind of surface
 *   glass_shape.c    the shape of a pane, its mask and its bump map
 *   glass_wipers.c   the pose of each wiper blade at a time
 *   glass_step.c     ticks
 *   glass_picture.c  resources and descriptor sets of the height map and the draws
 *   glass_draw.c     prepare, attach, draw
 *   glass_textures.c drops as textures, in the way of Sato et al.
 *   glass_fog.c      condensation
 *   glass_water.c    simulated water that stands against a pane and recedes
 *   glass_temporal.c motion of a pane since the previous frame
 */
#ifndef VIRGA_GLASS_INTERNAL_H
#define VIRGA_GLASS_INTERNAL_H

#include "glass/glass.h"
#include "glass/glass_picture.h"
#include "gpu/context.h"
#include "gpu/effect.h"
#include "gpu/state.h"

#include <virga/glass.h>
#include <virga/shared/glass_gpu.h>

#define GLASS_MAX_ARRIVALS 8192 /* drops from the rain rate in a tick; above it, each drop represents several */
#define GLASS_MAX_IMPACTS  8192 /* impacts from the host's list in a step */

/* Min side of a cell of the particle grid. */
static inline float glass_min_grid_m(const virga_glass_def *def)
{
    return def->cell_m > 0.003f ? def->cell_m : 0.003f;
}

/* The data that is read back for one frame. */
typedef struct glass_readback {
    virga_glass_state_gpu state; /* written by the step */
    struct {
        uint32_t balls, ball_entries_dropped; /* as in virga_glass_work_gpu */
    } prepared[VIRGA_MAX_VIEWS];              /* written by the prepares */
} glass_readback;

enum { GLASS_PART_STEP, GLASS_PART_PREPARE }; /* parts of the statistics */

/* In the journal: all tiles were marked as not written; textures were made. */
enum { GLASS_DID_UNWRITTEN = VIRGA_DID_OWN, GLASS_DID_TEXTURES = 2 * VIRGA_DID_OWN };

struct virga_glass {
    virga_effect base; /* first */
    virga_glass_def def;
    uint32_t columns, rows; /* cells */
    virga_glass_settings settings;
    uint64_t ticks; /* since creation */
    uint32_t last_tick;
    double host_deg[VIRGA_GLASS_MAX_WIPERS]; /* (host) wiper angles at the end of the newest step */
    bool host_known;

    /* State of the pane. */
    virga_buffer *state, *drops, *selection, *list, *claims, *occupants, *film, *passed, *seeds, *ranks, *grid, *moved,
        *active, *film_blocks;
    /* The surface of the pane: cells (affinity, bump, mask) and the nodes of its shape. */
    virga_buffer *surface, *nodes;
    virga_buffer *surface_upload, *nodes_upload; /* copied by the next step; NULL: done */
    virga_ring tick_ring;
    uint32_t tick_offset; /* of the newest tick */
    virga_bindings *bindings;
    virga_pipeline *live_mark, *live_scan, *live_compact, *begin_tick, *active_scan, *active_compact, *choose_cell,
        *enter_cell, *move_drops, *capture_mark, *capture, *wipe_film, *lay_film, *split_drops, *empty_bins,
        *particle_grid, *particle_starts, *particle_sort, *push_particles, *merge_particles, *to_drops_claim, *to_drops,
        *spawn_claim, *spawn_scan, *spawn, *end_tick, *dry_film, *film_compact, *measure, *flood, *recede, *break_film,
        *fog_begin, *fog_grow, *fog_wipe, *fog_claim, *fog_take;
    float normals[VIRGA_GLASS_NODES * VIRGA_GLASS_NODES][3]; /* of the nodes, to compute which drops land */
    float farthest_m;                                        /* max distance of a node from the pane's origin */
    bool masked;                                             /* some cells may have no glass */
    uint32_t shape_count;                                    /* changes with the surface, and with its upload */
    float low_m[3], high_m[3];                               /* corners of a box around the shape */
    bool flat;
    uint32_t fog_since;                    /* the tick in which condensation was switched on; 0: it is off */
    bool fog_begun;                        /* it was on once */
    double heat_k[VIRGA_GLASS_HEAT_WAVES]; /* waves of the heater's field at the end of the newest tick */
    /* The same at the last turn of each block of cells, by turn. */
    double heat_before_k[VIRGA_GLASS_FOG_TURNS * VIRGA_GLASS_HEAT_WAVES];
    virga_glass_breath breaths[VIRGA_GLASS_MAX_BREATHS]; /* those that have not ended */
    uint32_t breath_count;
    uint32_t flooded_until;              /* the tick up to which simulated water may stand there, or its film break */
    float outline[9][3];                 /* 3 x 3 points of the shape, row by row, to estimate its size on the image */
    virga_glass_tick_gpu blades;         /* of the tick being recorded */
    bool particles_ever;                 /* particles may exist */
    VkDescriptorSet step_set, water_set; /* with the host's impacts, or with particles of water in their place */
    virga_glass_stats stats;

    struct glass_picture picture;
};

/* ---- glass_kinds.c */

/* Volume (m^3) of a spherical cap with a base radius of 1 m and this contact angle:
 * pi (2 - 3 cos + cos^3) / (3 sin^3). */
double glass_cap_volume(double angle_deg);
/* The contact angle of a drop that moves or just stays: the mean of the advancing and the receding angle. */
double glass_rest_deg(const virga_glass_settings *settings);
/* That of a drop on the picture: a drop whose rim uneven glass holds is flatter. */
double glass_seen_deg(const virga_glass_settings *settings);
/* See virga_glass_tick_gpu. */
double glass_hold(const virga_glass_settings *settings);
double glass_drag(const virga_glass_settings *settings);
/* Speed (m/s) below which water that recedes leaves no film. */
double glass_film_from(const virga_glass_settings *settings);

/* ---- glass_shape.c */
virga_result glass_shape_init(virga_glass *glass);

/* ---- glass_wipers.c */
virga_result glass_check_wiper(const virga_log *log, virga_glass_wiper *wiper, bool *changed);
void glass_fill_blades(virga_glass *glass, double from_s, double to_s, double share_from, double share_to,
                       virga_glass_tick_gpu *tick);

/* ---- glass_water.c */

/* The most sites whose film may break in one tick. 0: the pane takes no water. */
uint32_t glass_max_sites(const virga_glass_def *def);
virga_result glass_check_water(const virga_glass *glass, const virga_glass_step_info *info);
/* What all ticks of a step have in common. */
void glass_fill_water(virga_glass *glass, const virga_glass_step_info *info, virga_glass_tick_gpu *tick);
/* The sites that have their turn in a tick. */
void glass_fill_sites(const virga_glass *glass, virga_glass_tick_gpu *tick);
/* Before the first tick of a step, in each, and after the last. */
void glass_record_flood(virga_glass *glass, VkCommandBuffer cmd);
void glass_record_break(virga_glass *glass, VkCommandBuffer cmd);
void glass_record_recede(virga_glass *glass, VkCommandBuffer cmd);

/* ---- glass_fog.c */

/* Sites of fog in a tick. 0: the pane cannot fog. */
uint32_t glass_fog_sites(const virga_glass_def *def);
virga_result glass_check_condensation(const virga_glass *glass, const virga_glass_settings *settings);
/* What a tick needs to know, and the heater's change in it. */
void glass_fill_fog(virga_glass *glass, virga_glass_tick_gpu *tick);
/* At the start of a tick; before its seeds are spawned; where a blade's push constants are bound; at its end. */
void glass_record_fog_begin(virga_glass *glass, VkCommandBuffer cmd);
void glass_record_fog_grow(virga_glass *glass, VkCommandBuffer cmd);
void glass_record_fog_take(virga_glass *glass, VkCommandBuffer cmd);
struct virga_state_check;
void glass_check_fog_state(const virga_glass *glass, struct virga_state_check *check);

/* ---- glass_cells.c */

/* Number of cells that cover a length. The last cell may extend beyond it. */
uint32_t glass_cells_along(float length_m, float cell_m);
/* Number of blocks of VIRGA_GLASS_FILM_BLOCK x VIRGA_GLASS_FILM_BLOCK cells. */
uint32_t glass_film_blocks(const virga_glass_def *def);

/* ---- glass.c */

/* Writes glass->step_set, and glass->water_set if there are particles of water. */
void glass_write_sets(virga_glass *glass, const virga_glass_step_info *info);

/* The description of the pane that its passes read. */
virga_glass_pane_gpu glass_describe_pane(const virga_glass *glass);

/* ---- glass_step.c */
/* True if it recorded. A prepare calls it too: its step may be in a lost frame. */
bool glass_first_contents(virga_glass *glass, VkCommandBuffer cmd);
virga_result glass_axes_check(const virga_log *log, const char *name, const float axes[9]); /* all zero: none */
/* The grid of particles: its cells, and their side. */
void glass_fill_grid(const virga_glass *glass, virga_glass_tick_gpu *tick);
void glass_lost(void *glass, uint64_t frame, uint32_t did);
void glass_read_statistics(void *glass, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);
void glass_fill_sizes(const double *diameters, const double *fluxes, uint32_t count, double stands_for,
                      float sizes_m[VIRGA_GLASS_SIZES]);

/* ---- glass_state.c */

struct virga_state_check;
void glass_check_state(const void *glass, struct virga_state_check *check);

#endif
