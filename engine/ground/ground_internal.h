/* ground/ground_internal.h - the object behind virga_ground, and the functions that its files share. Internal.
 *
 *   ground.c          create, destroy, settings, maps and statistics
 *   materials.c       how materials absorb, hold and drain water
 *   ground_contacts.c wheels and feet
 *   ground_window.c   which tiles are in the window, in the cache, or evicted
 *   standing.c        water where drops are not simulated
 *   ground_far.c      the map of distant ground
 *   ring_table.c      waves on shallow water
 *   ground_rings.c    the map of rings on puddles
 *   stream_table.c    a picture of waves, of which those of running water are made
 *   ground_streams.c  waves of running water, in the same map
 *   ground_step.c     ticks: the passes in their order
 *   ground_state.c    checks a saved state
 *   ground_wet.c      the draw of wet ground over a host's picture */
#ifndef VIRGA_GROUND_INTERNAL_H
#define VIRGA_GROUND_INTERNAL_H

#include "gpu/context.h"
#include "gpu/effect.h"
#include "gpu/mesh_map.h"
#include "gpu/offscreen.h"
#include "gpu/state.h"
#include "ground/ground.h"

#include <virga/ground.h>
#include <virga/shared/ground_gpu.h>
#include <virga/shared/ground_wet_gpu.h>
#include <virga/shared/view_gpu.h>

/* ---- materials.c */
void ground_default_materials(virga_ground_material materials[VIRGA_GROUND_MATERIALS]);
virga_result ground_check_materials(const virga_log *log, virga_ground_material materials[VIRGA_GROUND_MATERIALS],
                                    bool *changed);
void ground_fill_soils(const virga_ground_settings *settings, double cell_m,
                       virga_soil_gpu soils[VIRGA_GROUND_MATERIALS]);

/* ---- standing.c */

/* A cell without simulated drops. */
typedef struct ground_standing {
    double held_nl, film_nl, level_um, spots; /* see virga_standing_gpu */
} ground_standing;

/* The rain on a cell in one tick, and the evaporation. */
typedef struct ground_weather {
    /* On a cell in the open: the rain, and the dark spots that its drops leave. */
    double rain_nl, spots;
    double evaporation_nl, tick_s;
    double nl_per_um;
} ground_weather;

/* One cell in the open for each material, then one under cover for each. */
enum { GROUND_STANDING = 2 * VIRGA_GROUND_MATERIALS };

void ground_standing_start(ground_standing cells[GROUND_STANDING], const virga_ground_settings *settings,
                           const virga_soil_gpu soils[VIRGA_GROUND_MATERIALS]);
void ground_standing_tick(ground_standing cells[GROUND_STANDING], const virga_soil_gpu soils[VIRGA_GROUND_MATERIALS],
                          const ground_weather *weather);
void ground_standing_fill(const ground_standing cells[GROUND_STANDING],
                          const virga_soil_gpu soils[VIRGA_GROUND_MATERIALS], virga_standing_gpu out[GROUND_STANDING]);

/* ---- ground_window.c: which tiles are where, on the host */

typedef struct ground_cached_tile {
    int32_t tile[2];
    uint64_t since; /* number of the move in which the tile left the window; 0: free */
    bool wanted;    /* needed by the current move */
} ground_cached_tile;

/* The result of one move of the window, as tile slots in the window's buffers and in the cache. */
typedef struct ground_move {
    uint32_t leaving[VIRGA_GROUND_MAX_TILES], leaving_to[VIRGA_GROUND_MAX_TILES];
    uint32_t entering[VIRGA_GROUND_MAX_TILES];
    /* Slots in the cache; GROUND_NEW: the tile was never in the window, or was evicted. */
    uint32_t entering_from[VIRGA_GROUND_MAX_TILES];
    uint32_t forgotten[VIRGA_GROUND_MAX_TILES];
    uint32_t leaving_count, entering_count, forgotten_count;
} ground_move;

#define GROUND_NEW UINT32_MAX

typedef struct ground_window {
    uint32_t tiles; /* tiles along one side */
    int32_t low[2];
    bool is_placed;
    uint64_t moves;
    ground_cached_tile *cache;
    uint32_t cache_capacity, cached_count;
    /* As it was before the newest move, see ground_window_undo. */
    int32_t low_before[2];
    bool was_placed;
    ground_cached_tile *cache_before;
    uint32_t cached_count_before;
} ground_window;

/* Low corner of the window for a camera position. It does not change while the camera is within one and a half tiles of
 * the middle of the window. */
void ground_window_wanted(const ground_window *window, const double camera_m[3], double tile_m, int32_t low[2]);

/* One more than the highest slot of the cache that is in use. */
uint32_t ground_window_cache_end(const ground_window *window);

/* Moves the window and fills `move` with the tiles that enter, leave and are evicted. */
void ground_window_move(ground_window *window, const int32_t low[2], ground_move *move);

/* Takes the newest move back. */
void ground_window_undo(ground_window *window);

/* Forgets all tiles: the next move enters all of them as new ones. */
void ground_window_forget(ground_window *window);

/* ---- ground_rings.c */
typedef struct ground_ripples {
    virga_offscreen *map;
    virga_image_2d *waves;
    virga_buffer *upload; /* waves to upload; NULL once they are */
    virga_pipeline *pipeline;
} ground_ripples;

virga_result ground_ripples_create(virga_context *context, uint32_t texels, struct virga_layout *layout,
                                   virga_pipeline_group *group, ground_ripples *ripples);
/* The table of waves. */
virga_result ground_ripples_fill(virga_context *context, double texel_m, ground_ripples *ripples);
VkDeviceSize ground_ripples_bytes(uint32_t texels);
void ground_ripples_retire(virga_context *context, ground_ripples *ripples);
void ground_ripples_upload(virga_context *context, VkCommandBuffer cmd, ground_ripples *ripples);

/* Draws all active rings and running water. The ground's set must be bound for graphics. Leaves the map in GENERAL. */
void ground_ripples_draw(const virga_ground *ground, VkCommandBuffer cmd);

/* ---- ground_streams.c */
typedef struct ground_streams {
    virga_image_2d *tile;
    virga_buffer *upload; /* of the tile; NULL once it is */
    virga_pipeline *draw;
} ground_streams;

/* Where the head of running water is in the buffer of rings: a stage sees no more buffers than there are. */
#define GROUND_STREAMS_OFFSET (sizeof(virga_rings_gpu) + (VIRGA_MAX_RINGS + VIRGA_MAX_WAKES) * sizeof(virga_ring_gpu))

/* Blocks of cells along the side of the area around the ripple map. */
uint32_t ground_streams_blocks(const virga_ground_def *def);
VkDeviceSize ground_streams_bytes(void);
virga_result ground_streams_create(virga_context *context, const virga_offscreen *map, struct virga_layout *layout,
                                   virga_pipeline_group *group, ground_streams *streams);
/* The tile of waves. */
virga_result ground_streams_fill_tile(virga_context *context, ground_streams *streams);
void ground_streams_retire(virga_context *context, ground_streams *streams);
void ground_streams_upload(virga_context *context, VkCommandBuffer cmd, ground_streams *streams);
void ground_streams_fill(const virga_ground *ground, virga_ground_tick_gpu *out);
/* Finds running water, after the ticks of a step. The ground's set must be bound. */
void ground_streams_step(virga_ground *ground, VkCommandBuffer cmd);
/* Draws its waves, in the draw of rings. */
void ground_streams_draw(const virga_ground *ground, VkCommandBuffer cmd);

/* ---- ground_far.c */

#define GROUND_NO_MATERIAL 0xffu /* a cell without ground: see virga_floor_gpu.material */

#define GROUND_HEIGHT_MAP_TOP_M   256.0 /* above base_m */
#define GROUND_HEIGHT_MAP_DEPTH_M 512.0

typedef struct ground_far {
    virga_buffer *floors;
    /* The map, and below it one more row: level open ground of each material. */
    virga_image_2d *map;
    virga_mesh_map *height_map; /* layer 0: only ground meshes; layer 1: all meshes */
    virga_pipeline *floor_pass, *draw;
    int32_t low[2]; /* in far cells */
    bool is_placed, drawn;
    uint64_t drawn_at;                    /* in ticks */
    virga_ground_tick_gpu tick, drawn_by; /* the newest tick, and the one by which the map was drawn */
    bool can_repeat;                      /* `drawn_by` is known */
    bool is_uncertain;                    /* the device may not have executed the map's first transition */
} ground_far;

/* Moves the distant map with the camera. Returns true if its height map must be drawn again. */
bool ground_far_follow(virga_ground *ground, const double camera_m[3]);
void ground_far_draw_heights(virga_ground *ground, VkCommandBuffer cmd, const virga_ground_step_info *info);

/* Whether an update of the distant map is due. */
bool ground_far_is_due(const virga_ground *ground);
/* Draws the map by the tick that is bound. `due`: it is an update, else the same again. */
void ground_far_draw(virga_ground *ground, VkCommandBuffer cmd, bool due);
void ground_far_fill(const virga_ground *ground, virga_ground_tick_gpu *out);
void ground_far_maps(const virga_ground *ground, virga_ground_maps *maps);

/* ---- ground_wet.c */

typedef struct ground_wet_block {
    virga_view_gpu view;
    virga_ground_wet_gpu wet;
} ground_wet_block;

enum { GROUND_WET_BINDINGS = 7 };

extern const virga_binding_kind ground_wet_bindings[GROUND_WET_BINDINGS];
extern const virga_effect_draw ground_draws[1];

/* ---- the object */

/* The sources of a tick's water: impacts of the rain, or droplets that splashes return. And wheels and feet, which
 * throw droplets into a list. */
enum { GROUND_DROPS, GROUND_RETURNS, GROUND_CONTACTS, GROUND_SOURCES };

/* The statistics that are read back for one frame. */
typedef struct ground_readback {
    virga_ground_count_gpu counts[VIRGA_GROUND_COUNTS];
} ground_readback;

/* What a step did, in the journal. */
enum {
    GROUND_DID_MOVE = VIRGA_DID_OWN,
    GROUND_DID_HEIGHTS = VIRGA_DID_OWN << 1,
    GROUND_DID_FAR_HEIGHTS = VIRGA_DID_OWN << 2,
    GROUND_DID_FAR_MAP = VIRGA_DID_OWN << 3,
    GROUND_DID_BLOCKS = VIRGA_DID_OWN << 4,
};

typedef struct ground_lists {
    uint32_t entering[VIRGA_GROUND_MAX_TILES], forgotten[VIRGA_GROUND_MAX_TILES];
} ground_lists;

struct virga_ground {
    virga_effect base; /* first */
    virga_ground_def def;
    virga_ground_settings settings;
    ground_window window;
    ground_move move;
    double base_m;
    bool has_base;
    uint64_t move_frame; /* of the newest move of the window */
    bool redraw_heights;
    bool list_blocks;   /* the list of blocks is not that of the floors */
    bool listed_blocks; /* this step has listed them */
    uint64_t ticks;     /* ticks run since creation */
    uint64_t wakes_end; /* tick after which no wake is left; wheels and feet move it on */

    virga_buffer *floors, *cells, *arrivals, *spots, *cached_cells, *cached_spots, *counts, *landings, *rings, *stirs,
        *swings, *spawns, *no_rules;
    virga_ring tick_ring, list_ring;
    uint32_t tick_offset, list_offset; /* of the newest blocks */
    virga_image_2d *wet_map, *spot_map, *blank_materials;
    virga_mesh_map *height_map;
    ground_ripples ripples;
    ground_streams streams;
    ground_far far;
    ground_standing standing[GROUND_STANDING];
    double ripple_low_m[2]; /* in world coordinates */
    uint32_t last_tick;
    virga_bindings *bindings;
    virga_pipeline *tile_load, *tile_discard, *block_mark, *block_list;
    virga_pipeline *touch, *contact, *contact_soak, *receive, *receive_soak, *take, *spawn_mark, *spawn_scan, *land,
        *share, *soak, *flow, *measure, *measure_cached, *map, *ring, *stream, *stream_list;
    VkBufferCopy copies[VIRGA_GROUND_MAX_TILES]; /* copy regions of one move */

    VkDescriptorSet sets[GROUND_SOURCES]; /* of this frame, one for each source of water */
    virga_ground_step_info info;          /* of this frame's step; the host owns its meshes */
    uint32_t tick_in_step;
    virga_ground_stats stats;
    virga_ring wet_ring;
    virga_bindings *wet_bindings;
};

/* ---- ground.c */

/* Nanolitres on a cell for one micrometre of depth. */
uint32_t ground_nl_per_um(const virga_ground *ground);
void ground_write_sets(virga_ground *ground);

/* ---- ground_step.c */

void ground_lost(void *ground, uint64_t frame, uint32_t did);
void ground_state_loaded(void *ground);
void ground_read_statistics(void *ground, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);

/* ---- ground_contacts.c */

virga_result ground_contacts_check(const virga_ground *ground, const virga_ground_step_info *info);
void ground_contacts_fill(const virga_ground *ground, virga_ground_tick_gpu *out);
/* Wakes may begin now, or are in a state that was loaded. */
void ground_wakes_live(virga_ground *ground);
/* The passes of the newest tick. The set of GROUND_CONTACTS must be bound. */
void ground_contacts_record(virga_ground *ground, VkCommandBuffer cmd);

/* ---- ground_state.c */

struct virga_state_check;
void ground_check_state(const void *ground, struct virga_state_check *check);

#endif
