/* fluid/fluid_internal.h - defines the struct of virga_fluid and the functions its files share. Internal.
 *
 *   fluid.c       create, destroy, settings, blocks of water, queries
 *   fluid_body.c  bodies: what the host tells of them and asks
 *   body_mesh.c   the mass of a body, by its mesh
 *   body_map.c    what it means for particles near it, on a grid
 *   fluid_exchange.c  water that comes from the ground and goes back
 *   fluid_state.c  checks a saved state
 *   fluid_step.c  a step
 */
#ifndef VIRGA_FLUID_FLUID_INTERNAL_H
#define VIRGA_FLUID_FLUID_INTERNAL_H

#include "fluid/body_mesh.h"
#include "fluid/fluid.h"
#include "gpu/context.h"
#include "gpu/effect.h"
#include "gpu/state.h"
#include "particles/particle_grid.h"

#include <virga/shared/exchange.h>
#include <virga/shared/fluid_gpu.h>

#define FLUID_MAX_BLOCKS 16 /* between two steps */

/* The data that is read back for one frame. */
typedef struct fluid_readback {
    virga_fluid_state_gpu state;
    virga_fluid_body_gpu bodies[VIRGA_FLUID_MAX_BODIES];
    virga_exchange_gpu exchange;
} fluid_readback;

/* Where the host wants a body to be, at its center of mass. */
typedef struct fluid_pose {
    double center[3], rotation[4];
} fluid_pose;

/* A body, as the host knows it. It is part of the state, so it has no padding. */
typedef struct fluid_body {
    fluid_pose wanted; /* (driven) at the end of the next step */
    virga_fluid_shape_gpu shape;
    virga_fluid_body_gpu start; /* (free) what the device begins with; (driven) at the beginning of the next step */
    uint32_t is_driven;
    uint32_t is_sent; /* the device has it */
    uint32_t unused;
} fluid_body;

_Static_assert(sizeof(fluid_body) ==
                   sizeof(fluid_pose) + sizeof(virga_fluid_shape_gpu) + sizeof(virga_fluid_body_gpu) + 12,
               "no padding");

/* What was read back of it. */
typedef struct fluid_seen {
    uint64_t sent_frame; /* in which it was sent to the device, or loaded with a state; 0: not yet */
    virga_fluid_body_gpu newest;
    uint64_t newest_frame;
} fluid_seen;

enum { FLUID_LAYOUT_GRID, FLUID_LAYOUT_ADD, FLUID_LAYOUT_STEP, FLUID_LAYOUT_EXCHANGE };

/* Bindings that the step binds itself. */
enum { FLUID_BIND_ADDED = 3, FLUID_BIND_LEAVERS = 4 };

struct virga_fluid {
    virga_effect base; /* first */
    virga_fluid_def def;
    virga_fluid_settings settings;

    uint32_t particles; /* slots in use */
    virga_fluid_add_gpu blocks[FLUID_MAX_BLOCKS];
    uint32_t block_count; /* to be added in the next step */
    /* The blocks that steps in flight have added, for lost frames. */
    struct {
        uint64_t frame;
        uint32_t count;
        virga_fluid_add_gpu blocks[FLUID_MAX_BLOCKS];
    } sent[VIRGA_MAX_FRAMES_IN_FLIGHT];
    uint32_t step_particles[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* of the steps in flight, for statistics */

    fluid_body bodies[VIRGA_FLUID_MAX_BODIES];
    fluid_seen seen[VIRGA_FLUID_MAX_BODIES];
    uint32_t body_count;
    uint32_t (*map)[4]; /* nodes and points of all bodies */
    uint32_t map_nodes;
    virga_buffer *map_upload; /* until the device has them */

    particle_grid grid;
    virga_buffer *state, *slots, *slot_pressures, *moved, *walls, *solved, *lists, *gradients, *body_states, *touches,
        *maps, *exchange;
    virga_ring step_ring, add_ring, shape_ring;
    virga_bindings *add_bindings, *bindings, *exchange_bindings;
    virga_pipeline *add, *begin, *count, *copy, *neighbours, *push, *correct, *advance;
    virga_pipeline *exchange_spray, *exchange_in, *exchange_out;
    virga_pipeline *body_contacts, *body_push, *body_move, *body_hit, *body_near;
    virga_fluid_stats stats;

    uint32_t step_offset; /* of the block of the step */
    VkDescriptorSet exchange_set;
    float region_low_m[2], region_high_m[2]; /* of the newest step, in the box */
    bool empties;                            /* the next step removes the water of the ground, and the lists */
    uint64_t emptied_frame;                  /* in which that was recorded */
};

/* First cell and number of cells of the grid on each axis. */
void fluid_grid_box(const virga_fluid_settings *settings, int32_t first[3], uint32_t dims[3]);

/* ---- fluid_body.c */

/* Tells the device of the bodies: maps, the beginning of new ones, and of those that the host moves. Fills their part
 * of a step. */
void fluid_send_bodies(virga_fluid *fluid, VkCommandBuffer cmd, float dt_s, virga_fluid_step_gpu *step,
                       virga_fluid_shapes_gpu *shapes);
/* The device has not executed a frame. */
void fluid_bodies_lost(virga_fluid *fluid, uint64_t frame);
void fluid_read_bodies(virga_fluid *fluid, uint64_t frame, const virga_fluid_body_gpu *bodies);
void fluid_remove_bodies(virga_fluid *fluid);

/* ---- fluid_exchange.c */

/* Fits their number to that of all particles. */
void fluid_fit_exchanged(virga_fluid_def *def);
virga_result fluid_check_exchange(const virga_fluid *fluid, const virga_fluid_settings *settings);
virga_result fluid_check_region(const virga_fluid *fluid, const virga_fluid_step_info *info);
void fluid_fill_exchange(virga_fluid *fluid, const virga_fluid_step_info *info, virga_fluid_step_gpu *out);
/* Spray leaves and water of the ground comes in before the substeps; water goes to the ground after them. */
void fluid_exchange_in(virga_fluid *fluid, VkCommandBuffer cmd, const virga_fluid_step_info *info);
void fluid_exchange_out(virga_fluid *fluid, VkCommandBuffer cmd);

/* ---- fluid_state.c */

struct virga_state_check;
void fluid_check_state(const void *fluid, struct virga_state_check *check);

/* ---- fluid_step.c */
void fluid_lost(void *fluid, uint64_t frame, uint32_t did);
void fluid_state_loaded(void *fluid);
void fluid_read_statistics(void *fluid, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);

#endif
