/* splash/splash_internal.h - defines the struct of virga_splash and the functions its files share. Internal.
 *
 *   splash.c              create, destroy, settings, queries
 *   splash_table.c        the splash rule of each material and state
 *   splash_descriptors.c  the bindings of all passes
 *   splash_tick.c         the block that a tick's passes read
 *   splash_step.c         ticks
 *   splash_spray.c        droplets that water hands over
 *   splash_drips.c        drops that fall from edges
 *   splash_state.c        checks a saved state
 *   splash_draw.c         prepare, attach, draw
 */
#ifndef VIRGA_SPLASH_INTERNAL_H
#define VIRGA_SPLASH_INTERNAL_H

#include "gpu/context.h"
#include "gpu/effect.h"
#include "gpu/state.h"
#include "splash/splash.h"

#include <virga/shared/drip_gpu.h>
#include <virga/shared/splash_gpu.h>
#include <virga/shared/view_gpu.h>
#include <virga/splash.h>

/* ---- splash_table.c */
void splash_default_rows(virga_splash_rule rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES]);
virga_result splash_check_rows(const virga_log *log,
                               virga_splash_rule rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES], bool *changed);

/* Writes the rules of this frame. Later calls in the same frame do nothing. */
void splash_push_rules(virga_splash *splash);

/* ---- the object */

#define SPLASH_MAX_VIEWS VIRGA_SPLASH_MAX_VIEWS

enum { SPLASH_STEP_SET = SPLASH_MAX_VIEWS, SPLASH_SETS = SPLASH_STEP_SET + 2 };

enum {
    SPLASH_BINDINGS = 23,
    SPLASH_RECALL_BINDINGS = 4,
    SPLASH_HITS_BINDINGS = 2,
    SPLASH_DRIP_BINDINGS = 5,
};

enum { SPLASH_LAYOUT, SPLASH_LAYOUT_RECALL, SPLASH_LAYOUT_HITS, SPLASH_LAYOUT_DRIP };

#define SPLASH_STYLES (VIRGA_SPLASH_FORM_FILM + 1) /* forms of the passes that depend only on the style */

/* The data that is read back for one frame. */
typedef struct splash_readback {
    virga_splash_state_gpu state;                        /* written by the step */
    virga_splash_prepared_gpu prepared[VIRGA_MAX_VIEWS]; /* written by the prepares */
} splash_readback;

enum { SPLASH_PART_STEP, SPLASH_PART_PREPARE }; /* parts of the statistics */

/* The uniform block of a view, in its ring. */
typedef struct splash_view_block {
    virga_view_gpu view;
    virga_splash_look_gpu look;
} splash_view_block;

/* Index of each pipeline of a target. The pipeline at an index does not read the scene's depth, the next one does. */
enum {
    SPLASH_DRAW_LINES = 0, /* if the context draws lines */
    SPLASH_DRAW_THIN = 2,
    SPLASH_DRAW_PUFFS = 4,
    SPLASH_DRAW_WIDE = 6,
    SPLASH_DRAW_SHEETS = 8,
    SPLASH_DRAW_PILES = 10,  /* (paper) */
    SPLASH_DRAW_CROWNS = 12, /* (paper) */
    SPLASH_DRAW_ROWS = 7
};

/* What draws need of a view besides virga_effect_view. */
typedef struct splash_prepared {
    uint32_t tick_offset, rules_offset;
    bool depth;
    virga_splash_style style;
    float line_px; /* line width */
} splash_prepared;

/* A sprite and its motion. The buffer holds all sprites first, then the motion of all. */
#define SPLASH_SPRITE_BYTES (sizeof(virga_sprite_gpu) + 16)

struct virga_splash {
    virga_effect base; /* first */
    virga_splash_def def;
    virga_splash_settings settings;
    double anchor_m[3];
    bool anchored;
    /* As it was before the newest step, for a lost frame. */
    struct {
        uint64_t frame;
        uint32_t current;
        double anchor_m[3];
        bool anchored;
    } before;
    uint64_t ticks; /* since creation */
    uint32_t last_tick;

    virga_buffer *droplet_buffers[2];
    uint32_t current; /* index of the one with the newest droplets */
    virga_buffer *state, *splashes, *marks, *spawn_offsets, *returned_droplets, *selection, *index_buffer;
    virga_buffer *handed; /* NULL without def.max_handed */
    /* The host's copy of sites; NULL without def.max_drips, as are the buffers. */
    struct {
        virga_drip_site_gpu *sites;
        uint32_t count;
        double origin_m[3];
        bool sent; /* to the device */
        uint64_t sent_frame;
    } drips;
    virga_buffer *drip_sites, *drip_waters;
    virga_ring drip_ring;
    VIRGA_PER_VIEW(virga_buffer, lists);
    VIRGA_PER_VIEW(virga_buffer, sprites);
    VIRGA_PER_VIEW(virga_buffer, prepared_buffer);
    virga_ring tick_ring, rules_ring, view_ring;
    uint32_t tick_offset, rules_offset, view_offset; /* of the newest blocks */
    virga_image_2d *blank_depth, *blank_color;       /* bound where a view has none */
    virga_bindings *bindings, *recall_bindings, *hits_bindings, *drip_bindings;
    virga_pipeline *spawn_scan, *spawn, *fly, *fall_scan, *fall_compact, *rebase, *alive, *indices, *recall, *adopt,
        *adopt_end, *drip, *give_hits;
    virga_pipeline *view_scan, *view_compact;
    virga_pipeline *few_mark[SPLASH_STYLES], *droplet_mark[SPLASH_STYLES], *splash_mark[SPLASH_STYLES];
    virga_pipeline *sprite_write[VIRGA_SPLASH_FORMS];

    VkDescriptorSet step_sets[2]; /* by index of the current droplet buffer */
    VkBuffer spawns;
    VkDeviceSize spawns_offset, spawns_range;
    const virga_splash_step_info *info;        /* of the step that is being recorded; NULL at other times */
    splash_prepared prepared[VIRGA_MAX_VIEWS]; /* by index of the view */
    uint64_t hits_frame;                       /* in which hits were given last */
    uint32_t hits_given;                       /* panes that got theirs in that frame, a bit for each */
    virga_splash_stats stats;
};

/* The buffer with the newest droplets. */
static inline virga_buffer *splash_droplets(const virga_splash *splash)
{
    return splash->droplet_buffers[splash->current];
}

/* Max number of sprites in one view. */
static inline uint32_t splash_max_sprites(const virga_splash_def *def)
{
    return def->max_droplets;
}

static inline uint32_t splash_max_crowns(const virga_splash_def *def)
{
    /* Crowns drawn as pyramids share the index buffer with the sprites. */
    const uint32_t max = def->max_droplets / VIRGA_CROWN_PYRAMIDS;
    return def->max_splashes < max ? def->max_splashes : max;
}

/* ---- splash_descriptors.c */
extern const virga_binding_kind splash_bindings[SPLASH_BINDINGS], splash_recall_bindings[SPLASH_RECALL_BINDINGS],
    splash_hits_bindings[SPLASH_HITS_BINDINGS], splash_drip_bindings[SPLASH_DRIP_BINDINGS];

/* `current`: index of the current droplet buffer. `view`: NULL if the set is not used for drawing. */
VkDescriptorSet splash_write_set(virga_splash *splash, uint32_t index, uint32_t current, const virga_view *view);
VkDescriptorSet splash_write_hits_set(virga_splash *splash, uint32_t index, VkBuffer hits, VkDeviceSize offset,
                                      VkDeviceSize size);
VkDescriptorSet splash_write_drip_set(virga_splash *splash);
VkDescriptorSet splash_write_recall_set(virga_splash *splash, const virga_splash_step_info *info);
/* Binds a set for passes, with the newest tick, view and rules. */
void splash_bind(virga_splash *splash, VkCommandBuffer cmd, VkDescriptorSet set);
/* Binds the selected view for draws. */
void splash_bind_view(virga_splash *splash, VkCommandBuffer cmd);

/* ---- splash_spray.c */
virga_result splash_spray_check(const virga_splash *splash, const virga_splash_step_info *info);

/* After the ticks: spray whose particle fell back ends, and new spray is taken. */
void splash_spray_record(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info);

/* ---- splash_drips.c */
virga_result splash_drips_init(virga_splash *splash);
void splash_drips_destroy(virga_splash *splash);
/* After the ticks, with their block pushed: drops fall into the list that is handed over. */
void splash_drips_record(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info);

/* Blocks of sites in the ring. */
static inline uint32_t splash_drip_blocks(const virga_splash_def *def)
{
    return (def->max_drips + VIRGA_DRIP_SITES_PER_BLOCK - 1) / VIRGA_DRIP_SITES_PER_BLOCK;
}

/* ---- splash_step.c */
/* With the set of a step or a view. A prepare calls it too: its step may be in a lost frame. */
void splash_first_contents(virga_splash *splash, VkCommandBuffer cmd, VkDescriptorSet set);

void splash_push_tick(virga_splash *splash, const virga_splash_step_info *info, uint32_t tick_in_step,
                      const double shift[3]);
void splash_lost(void *splash, uint64_t frame, uint32_t did);
void splash_state_loaded(void *splash);
void splash_read_statistics(void *splash, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);

/* ---- splash_draw.c */
extern const virga_effect_draw splash_draws[SPLASH_DRAW_ROWS];
virga_result splash_prepare(virga_splash *splash, VkCommandBuffer cmd, const virga_view *view, double time_s,
                            virga_prepared *prepared);
virga_result splash_draw(virga_splash *splash, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared,
                         const char *call);

/* ---- splash_state.c */

struct virga_state_check;
void splash_check_state(const void *splash, struct virga_state_check *check);

#endif
