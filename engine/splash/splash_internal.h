/* splash/splash_internal.h - the object behind virga_splash, and what its files do for each other. Internal.
 *
 *   splash.c         create, destroy, settings, what others read
 *   splash_table.c   which splash on which material
 *   splash_step.c    ticks
 *   splash_draw.c    prepare, attach, draw
 */
#ifndef VIRGA_SPLASH_INTERNAL_H
#define VIRGA_SPLASH_INTERNAL_H

#include "gpu/bindings.h"
#include "gpu/context.h"
#include "gpu/pipelines.h"
#include "gpu/resources.h"

#include <virga/shared/splash_gpu.h>
#include <virga/splash.h>

/* ---- splash_table.c */
void splash_default_rows(virga_splash_row rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES]);
virga_result splash_check_rows(const virga_log *log, virga_splash_row rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES],
                               bool *changed);
void splash_fill_rules(const virga_splash *splash, virga_splash_rules_gpu *rules);

/* ---- the object */

#define SPLASH_MAX_VIEWS   VIRGA_SPLASH_MAX_VIEWS
#define SPLASH_MAX_TARGETS 8

enum { SPLASH_STEP_SET = SPLASH_MAX_VIEWS, SPLASH_SETS = SPLASH_STEP_SET + 2 };

#define SPLASH_STYLES (VIRGA_SPLASH_FORM_FILM + 1) /* forms of passes that know of the style alone */

/* What the statistics ring reads back for one frame. */
typedef struct splash_readback {
    virga_splash_state_gpu state;
    virga_splash_prepared_gpu prepared;
} splash_readback;

enum {
    SPLASH_DRAW_LINES, /* where the context has them */
    SPLASH_DRAW_THIN,
    SPLASH_DRAW_PUFFS,
    SPLASH_DRAW_WIDE,
    SPLASH_DRAW_SHEETS,
    SPLASH_DRAW_PILES,  /* (paper) */
    SPLASH_DRAW_CROWNS, /* (paper) */
    SPLASH_DRAWS
};

typedef struct splash_target {
    uint64_t serial;                         /* of the virga_target; 0: free */
    virga_pipeline *draws[SPLASH_DRAWS][2];  /* without and with the scene's depth to read */
    bool motion;                             /* it has motion vectors */
} splash_target;

/* A sprite, and behind all of them its motion. */
#define SPLASH_SPRITE_BYTES (sizeof(virga_sprite_gpu) + 16)

struct virga_splash {
    virga_context *context;
    virga_splash_def def;
    virga_splash_settings settings;
    double anchor_m[3];
    bool anchored, started;
    uint64_t ticks; /* run since creation */
    uint32_t last_tick;

    virga_buffer *droplet_buffers[2], *droplets; /* the last: that of the two which is current */
    virga_buffer *state, *splashes, *marks, *places, *returns, *picks, *lists, *sprites, *prepared_buffer,
        *index_buffer;
    virga_buffer *tick_ring, *rules_ring, *view_ring, *readback_ring;
    virga_image_2d *blank_depth, *blank_color; /* for what a view has not */
    virga_bindings *bindings;
    virga_pipeline_group needed; /* for all but the draws */
    virga_pipeline *spawn_scan, *spawn, *step, *fall_scan, *fall, *rebase, *indices;
    virga_pipeline *view_scan, *view_list;
    virga_pipeline *few_find[SPLASH_STYLES], *droplet_find[SPLASH_STYLES], *splash_find[SPLASH_STYLES];
    virga_pipeline *sprite_write[VIRGA_SPLASH_FORMS];
    splash_target targets[SPLASH_MAX_TARGETS];

    uint64_t ring_frame, rules_frame, view_frame; /* that the cursors below belong to */
    uint32_t ring_ticks, ring_views, tick_offset, rules_offset, view_offset;
    VkDescriptorSet step_sets[2]; /* by which buffer of droplets is current */
    VkBuffer spawns;
    VkDeviceSize spawns_offset, spawns_range;
    bool prepared, prepared_depth;
    bool told_not_drawn; /* since the last draw that had all it needs */
    virga_splash_style prepared_style;
    VkDescriptorSet prepared_set;
    float prepared_viewport[4];
    float prepared_line_px; /* width of lines */
    uint64_t prepared_of_slot[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* whose prepare the ring holds; 0: none */
    uint64_t frame_of_slot[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* whose state the ring holds; 0: none */
    virga_splash_stats stats;
};

/* Bytes of a tick's numbers, and of the rules, in their rings. */
uint32_t splash_tick_bytes(void);
uint32_t splash_rules_bytes(void);
uint32_t splash_view_bytes(void);

/* Places for what one view sees. */
static inline uint32_t splash_max_sprites(const virga_splash_def *def)
{
    return def->max_droplets;
}

static inline uint32_t splash_max_crowns(const virga_splash_def *def)
{
    /* As pyramids they share the indices of sprites. */
    const uint32_t most = def->max_droplets / VIRGA_CROWN_PYRAMIDS;
    return def->max_splashes < most ? def->max_splashes : most;
}

/* ---- splash.c */
/* `current` is the buffer of droplets; `view` NULL where nothing is drawn with the set. */
VkDescriptorSet splash_write_set(virga_splash *splash, uint32_t index, uint32_t current, const virga_view *view);
uint32_t splash_current(const virga_splash *splash);
void splash_bind(virga_splash *splash, VkCommandBuffer cmd, VkPipelineBindPoint point, VkDescriptorSet set);

/* Writes the rules of this frame, once. */
void splash_push_rules(virga_splash *splash);

/* ---- splash_step.c */

/* Takes in what completed frames have left in the ring, oldest first. */
void splash_take_statistics(virga_splash *splash);

/* What the newest prepare found, for the statistics. */
void splash_record_prepared(virga_splash *splash, VkCommandBuffer cmd);

/* ---- splash_draw.c */
void splash_targets_destroy(virga_splash *splash);

#endif
