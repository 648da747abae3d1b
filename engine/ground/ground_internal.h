/* ground/ground_internal.h - the object behind virga_ground, and what its files do for each other. Internal.
 *
 *   ground.c          create, destroy, settings, what others read
 *   materials.c       what materials do with water
 *   ground_window.c   which tiles are in the window, kept or forgotten
 *   ring_table.c      waves on shallow water
 *   ground_rings.c    the map of rings on puddles
 *   ground_step.c     ticks: passes in their order
 */
#ifndef VIRGA_GROUND_INTERNAL_H
#define VIRGA_GROUND_INTERNAL_H

#include "gpu/context.h"
#include "gpu/mesh_map.h"

#include <virga/ground.h>
#include <virga/shared/ground_gpu.h>

/* ---- materials.c */
void ground_default_materials(virga_ground_material materials[VIRGA_GROUND_MATERIALS]);
virga_result ground_check_settings(const virga_log *log, virga_ground_settings *settings);
void ground_fill_soils(const virga_ground_settings *settings, double cell_m,
                       virga_soil_gpu soils[VIRGA_GROUND_MATERIALS]);

/* ---- ground_window.c: the bookkeeping, on the host */

typedef struct ground_kept {
    int32_t tile[2];
    uint64_t since; /* move in which it left the window; 0: free */
    bool wanted;    /* by the move at hand */
} ground_kept;

/* What a move of the window does, by slots of tiles: in the window's buffers, and among the kept. */
typedef struct ground_move {
    uint32_t leaving[VIRGA_GROUND_MAX_TILES], leaving_to[VIRGA_GROUND_MAX_TILES];
    uint32_t entering[VIRGA_GROUND_MAX_TILES];
    uint32_t entering_from[VIRGA_GROUND_MAX_TILES]; /* among the kept; GROUND_NEW: never seen, or forgotten */
    uint32_t forgotten[VIRGA_GROUND_MAX_TILES];
    uint32_t leaving_count, entering_count, forgotten_count;
} ground_move;

#define GROUND_NEW UINT32_MAX

typedef struct ground_window {
    uint32_t tiles; /* along a side */
    int32_t low[2];
    bool placed;
    uint64_t moves;
    ground_kept *kept;
    uint32_t kept_capacity, kept_count;
} ground_window;

/* Low corner that a window around a place should have. It stays where it is while the place is within a tile and a
 * half of its middle. */
void ground_window_wanted(const ground_window *window, const double camera_m[3], double tile_m, int32_t low[2]);

/* One more than the highest place among the kept that is in use. */
uint32_t ground_window_kept_end(const ground_window *window);

/* Moves the window and tells what that takes. */
void ground_window_move(ground_window *window, const int32_t low[2], ground_move *move);

/* ---- ground_rings.c */
typedef struct ground_ripples {
    virga_resource resource; /* first */
    virga_image_2d *map, *waves;
    virga_buffer *upload; /* of the waves; NULL once recorded */
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    virga_pipeline *pipeline;
} ground_ripples;

virga_result ground_ripples_create(virga_context *context, uint32_t texels, double texel_m, VkPipelineLayout layout,
                                   virga_pipeline_group *group, ground_ripples **ripples);
void ground_ripples_retire(virga_context *context, ground_ripples **ripples);
void ground_ripples_upload(virga_context *context, VkCommandBuffer cmd, ground_ripples *ripples);

/* Draws all living rings; ground's set must be bound for graphics. Leaves the map in GENERAL. */
void ground_ripples_draw(virga_context *context, VkCommandBuffer cmd, const ground_ripples *ripples);

/* ---- the object */

/* Where a tick's water comes from: rain's impacts, or what splashes gave back. */
enum { GROUND_DROPS, GROUND_RETURNS, GROUND_SOURCES };

/* What the statistics ring reads back for one frame. */
typedef struct ground_readback {
    virga_ground_count_gpu counts[VIRGA_GROUND_COUNTS];
} ground_readback;

typedef struct ground_lists {
    uint32_t entering[VIRGA_GROUND_MAX_TILES], forgotten[VIRGA_GROUND_MAX_TILES];
} ground_lists;

struct virga_ground {
    virga_context *context;
    virga_ground_def def;
    virga_ground_settings settings;
    ground_window window;
    ground_move move;
    double base_m;
    bool started, survey_all;
    uint64_t ticks; /* run since creation */

    virga_buffer *floors, *cells, *arrivals, *spots, *kept_cells, *kept_spots, *counts, *landings, *rings, *stirs,
        *swings, *spawns, *no_rules;
    virga_buffer *tick_ring, *list_ring, *readback_ring;
    virga_image_2d *wet_map, *spot_map, *blank_materials;
    virga_mesh_map *survey;
    ground_ripples *ripples;
    double ripple_low_m[2]; /* in the world */
    uint32_t last_tick;
    virga_bindings *bindings;
    virga_pipeline_group needed; /* for all of it */
    virga_pipeline *adopt, *forget, *spawn_find, *spawn_scan, *land, *share, *soak, *flow, *measure, *measure_kept,
        *map, *ring;
    VkBufferCopy copies[VIRGA_GROUND_MAX_TILES]; /* room to describe a move in */

    uint64_t ring_frame;
    uint32_t ring_ticks, tick_offset, list_offset;
    VkDescriptorSet sets[GROUND_SOURCES]; /* of this frame, by where water comes from */
    virga_ground_step_info info;          /* of this frame's step; its meshes are the host's */
    uint32_t tick_in_step;
    uint64_t frame_of_slot[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* whose counts the ring holds; 0: none */
    virga_ground_stats stats;
};

/* Bytes of a tick's and of a frame's lists' block in their rings. */
uint32_t ground_tick_bytes(void);
uint32_t ground_list_bytes(void);

/* ---- ground.c */

/* Nanolitres that make a micrometre of depth on a cell. */
uint32_t ground_nl_per_um(const virga_ground *ground);
void ground_write_sets(virga_ground *ground);

/* ---- ground_step.c */

/* Takes in what completed frames have left in the ring, oldest first. */
void ground_take_statistics(virga_ground *ground);

#endif
