/* splash/splash_internal.h - the object behind virga_splash, and what its files do for each other. Internal.
 *
 *   splash.c         create, destroy, settings, what others read
 *   splash_table.c   which splash on which material
 *   splash_step.c    ticks
 *   splash_draw.c    prepare, attach, draw
 */
#ifndef VIRGA_SPLASH_INTERNAL_H
#define VIRGA_SPLASH_INTERNAL_H

#include "gpu/context.h"
#include "gpu/effect.h"
#include "splash/splash.h"

#include <virga/shared/splash_gpu.h>
#include <virga/shared/view_gpu.h>
#include <virga/splash.h>

/* ---- splash_table.c */
void splash_default_rows(virga_splash_rule rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES]);
virga_result splash_check_rows(const virga_log *log,
                               virga_splash_rule rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES], bool *changed);
void splash_fill_rules(const virga_splash *splash, virga_splash_rules_gpu *rules);

/* ---- the object */

#define SPLASH_MAX_VIEWS VIRGA_SPLASH_MAX_VIEWS

enum { SPLASH_STEP_SET = SPLASH_MAX_VIEWS, SPLASH_SETS = SPLASH_STEP_SET + 2 };

#define SPLASH_STYLES (VIRGA_SPLASH_FORM_FILM + 1) /* forms of passes that know of the style alone */

/* What is read back of one frame. */
typedef struct splash_readback {
    virga_splash_state_gpu state;       /* of its step */
    virga_splash_prepared_gpu prepared; /* of its prepare */
} splash_readback;

enum { SPLASH_PART_STEP, SPLASH_PART_PREPARE }; /* of the statistics */

/* A view's block in its ring. */
typedef struct splash_view_block {
    virga_view_gpu view;
    virga_splash_look_gpu look;
} splash_view_block;

/* A target's pipelines: each without and, behind it, with the scene's depth to read. */
enum {
    SPLASH_DRAW_LINES = 0, /* where the context has them */
    SPLASH_DRAW_THIN = 2,
    SPLASH_DRAW_PUFFS = 4,
    SPLASH_DRAW_WIDE = 6,
    SPLASH_DRAW_SHEETS = 8,
    SPLASH_DRAW_PILES = 10,  /* (paper) */
    SPLASH_DRAW_CROWNS = 12, /* (paper) */
    SPLASH_DRAW_ROWS = 7
};

/* A sprite, and behind all of them its motion. */
#define SPLASH_SPRITE_BYTES (sizeof(virga_sprite_gpu) + 16)

struct virga_splash {
    virga_effect base; /* first */
    virga_splash_def def;
    virga_splash_settings settings;
    double anchor_m[3];
    bool anchored;
    uint64_t ticks; /* run since creation */
    uint32_t last_tick;

    virga_buffer *droplet_buffers[2], *droplets; /* the last: that of the two which is current */
    virga_buffer *state, *splashes, *marks, *spawn_offsets, *returned_droplets, *picks, *lists, *sprites,
        *prepared_buffer, *index_buffer;
    virga_ring tick_ring, rules_ring, view_ring;
    uint32_t tick_offset, rules_offset, view_offset; /* of the newest blocks */
    virga_image_2d *blank_depth, *blank_color;       /* for what a view has not */
    virga_bindings *bindings;
    virga_pipeline *spawn_scan, *spawn, *fly, *fall_scan, *fall_compact, *rebase, *indices;
    virga_pipeline *view_scan, *view_compact;
    virga_pipeline *few_mark[SPLASH_STYLES], *droplet_mark[SPLASH_STYLES], *splash_mark[SPLASH_STYLES];
    virga_pipeline *sprite_write[VIRGA_SPLASH_FORMS];

    VkDescriptorSet step_sets[2]; /* by which buffer of droplets is current */
    VkBuffer spawns;
    VkDeviceSize spawns_offset, spawns_range;
    bool prepared_depth;
    virga_splash_style prepared_style;
    float prepared_line_px; /* width of lines */
    virga_splash_stats stats;
};

/* Places for what one view sees. */
static inline uint32_t splash_max_sprites(const virga_splash_def *def)
{
    return def->max_droplets;
}

static inline uint32_t splash_max_crowns(const virga_splash_def *def)
{
    /* As pyramids they share the indices of sprites. */
    const uint32_t max = def->max_droplets / VIRGA_CROWN_PYRAMIDS;
    return def->max_splashes < max ? def->max_splashes : max;
}

/* ---- splash.c */

/* `current` is the buffer of droplets; `view` NULL where nothing is drawn with the set. */
VkDescriptorSet splash_write_set(virga_splash *splash, uint32_t index, uint32_t current, const virga_view *view);
uint32_t splash_current(const virga_splash *splash);
void splash_bind(virga_splash *splash, VkCommandBuffer cmd, VkPipelineBindPoint point, VkDescriptorSet set);

/* Writes the rules of this frame, once. */
void splash_push_rules(virga_splash *splash);

/* ---- splash_step.c */
void splash_read_statistics(void *splash, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);

/* ---- splash_draw.c */
extern const virga_effect_draw splash_draws[SPLASH_DRAW_ROWS];

#endif
