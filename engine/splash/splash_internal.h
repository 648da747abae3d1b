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
#include "gpu/view.h"

#include <virga/shared/splash_gpu.h>
#include <virga/splash.h>

/* ---- splash_table.c */
void splash_default_rows(virga_splash_row rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES]);
virga_result splash_check_rows(const virga_log *log, virga_splash_row rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES],
                               bool *changed);
void splash_fill_rules(const virga_splash *splash, virga_splash_rules_gpu *rules);

/* ---- the object */

#define SPLASH_MAX_VIEWS   4
#define SPLASH_MAX_TARGETS 8

enum { SPLASH_STEP_SET = SPLASH_MAX_VIEWS, SPLASH_SETS };

/* What the statistics ring reads back for one frame. */
typedef struct splash_readback {
    virga_splash_state_gpu state;
} splash_readback;

struct virga_splash {
    virga_context *context;
    virga_splash_def def;
    virga_splash_settings settings;
    double anchor_m[3];
    bool anchored, started;
    uint64_t ticks; /* run since creation */
    uint32_t last_tick;

    virga_buffer *state, *splashes, *droplets, *marks, *places, *returns;
    virga_buffer *tick_ring, *rules_ring, *readback_ring;
    virga_bindings *bindings;
    virga_pipeline *spawn_scan, *spawn, *step, *fall_scan, *fall, *rebase;

    uint64_t ring_frame, rules_frame; /* that the cursors below belong to */
    uint32_t ring_ticks, tick_offset, rules_offset, view_offset;
    VkDescriptorSet step_set;
    VkBuffer spawns;
    VkDeviceSize spawns_offset;
    uint64_t frame_of_slot[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* whose state the ring holds; 0: none */
    virga_splash_stats stats;
};

/* Bytes of a tick's numbers, and of the rules, in their rings. */
uint32_t splash_tick_bytes(void);
uint32_t splash_rules_bytes(void);

/* ---- splash.c */
VkDescriptorSet splash_write_set(virga_splash *splash, uint32_t index);
void splash_bind(virga_splash *splash, VkCommandBuffer cmd, VkPipelineBindPoint point, VkDescriptorSet set);

/* Writes the rules of this frame, once. */
void splash_push_rules(virga_splash *splash);

/* ---- splash_step.c */

/* Takes in what completed frames have left in the ring, oldest first. */
void splash_take_statistics(virga_splash *splash);

#endif
