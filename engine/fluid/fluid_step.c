/* fluid/fluid_step.c - records a step of the fluid.
 *
 * All substeps that a step may have are recorded; the device decides how many it needs, and the dispatches of the
 * others have no workgroups. The same is true for the iterations of the solver. */
#include "fluid/fluid_internal.h"

#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <math.h>
#include <string.h>

/* ---- statistics */

void fluid_read_statistics(void *object, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data)
{
    virga_fluid *fluid = object;
    fluid_readback read;
    float speed2;
    (void)parts;
    memcpy(&read, data, sizeof read);
    memcpy(&speed2, &read.state.max_speed2, sizeof speed2);
    fluid->stats = (virga_fluid_stats){.frame_index = frame,
                                       .particles = fluid->step_particles[ring_slot],
                                       .moved = read.state.moved,
                                       .substeps = read.state.substeps,
                                       .iterations = read.state.iterations,
                                       .solver_error = read.state.solver_error,
                                       .max_speed_m_s = sqrtf(speed2)};
    if (fluid->def.max_exchanged) {
        fluid->stats.particles = read.exchange.particles;
        fluid->stats.free = read.exchange.free_slots;
        fluid->stats.waiting = read.exchange.waiting;
        fluid->stats.particle_nl = read.exchange.particle_nl;
        fluid->stats.taken_nl = (uint64_t)read.exchange.taken_nl[1] << 32 | read.exchange.taken_nl[0];
        fluid->stats.sprayed_nl = (uint64_t)read.exchange.sprayed_nl[1] << 32 | read.exchange.sprayed_nl[0];
        fluid->stats.rest_nl = (int64_t)((uint64_t)read.exchange.rest_nl[1] << 32 | read.exchange.rest_nl[0]);
        fluid->stats.given_nl = (uint64_t)read.exchange.given_nl[1] << 32 | read.exchange.given_nl[0];
    }
    fluid_read_bodies(fluid, frame, read.bodies);
}

/* ---- particles that are added */

/* Blocks of a lost frame are added again, in their slots. Its step is not made up for: the water then stood still for a
 * frame. Particles of a host's buffer are gone; the buffer may be, too. */
void fluid_lost(void *object, uint64_t frame, uint32_t did)
{
    virga_fluid *fluid = object;
    (void)did;
    fluid_bodies_lost(fluid, frame);
    fluid->empties |= fluid->emptied_frame == frame;
    for (uint32_t slot = 0; slot < VIRGA_MAX_FRAMES_IN_FLIGHT; slot++) {
        const uint32_t room = FLUID_MAX_BLOCKS - fluid->block_count;
        if (fluid->sent[slot].frame != frame)
            continue;
        if (fluid->sent[slot].count > room)
            virga_log_write(&fluid->base.context->log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED,
                            "fluid: %u blocks of a lost frame are gone", fluid->sent[slot].count - room);
        for (uint32_t i = 0; i < fluid->sent[slot].count && i < room; i++)
            fluid->blocks[fluid->block_count++] = fluid->sent[slot].blocks[i];
        fluid->sent[slot].frame = 0;
    }
}

/* What was on its way when the state was loaded is not of this state. */
void fluid_state_loaded(void *object)
{
    virga_fluid *fluid = object;
    for (uint32_t slot = 0; slot < VIRGA_MAX_FRAMES_IN_FLIGHT; slot++)
        fluid->sent[slot].frame = 0;
    fluid->emptied_frame = 0;
    for (uint32_t i = 0; i < fluid->body_count; i++)
        fluid->seen[i] = (fluid_seen){.sent_frame = fluid->base.context->frame_index};
}

/* Remembers the blocks of this frame until the device has executed it. */
static void remember_blocks(virga_fluid *fluid)
{
    const uint32_t slot = fluid->base.context->ring_slot;
    fluid->sent[slot].frame = fluid->block_count ? fluid->base.context->frame_index : 0;
    fluid->sent[slot].count = fluid->block_count;
    memcpy(fluid->sent[slot].blocks, fluid->blocks, sizeof fluid->blocks);
}

static void add(virga_fluid *fluid, VkCommandBuffer cmd, VkDescriptorSet set, const virga_fluid_add_gpu *block)
{
    virga_context *context = fluid->base.context;
    const uint32_t offset = virga_ring_push(context, &fluid->add_ring, block, sizeof *block);
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, fluid->add_bindings, set, 1, &offset);
    virga_dispatch_and_barrier(context, cmd, fluid->add, virga_groups_of(block->count, VIRGA_FLUID_LANES));
}

static void add_all(virga_fluid *fluid, VkCommandBuffer cmd, const virga_fluid_step_info *info)
{
    virga_context *context = fluid->base.context;
    if (!fluid->block_count && !info->count)
        return;
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&fluid->base, fluid->add_bindings, bound);
    bound[FLUID_BIND_ADDED] = particles_bound(info->particles, info->offset, info->count, fluid->lists);
    const VkDescriptorSet set = virga_bindings_write(context, fluid->add_bindings, 0, bound);
    remember_blocks(fluid);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "fluid.add");
    for (uint32_t i = 0; i < fluid->block_count; i++)
        add(fluid, cmd, set, &fluid->blocks[i]);
    fluid->block_count = 0;
    if (info->count) {
        const virga_fluid_add_gpu block = {
            .first_slot = fluid->particles, .count = info->count, .first_id = fluid->particles};
        add(fluid, cmd, set, &block);
        fluid->particles += info->count;
    }
    virga_pass_end(context, cmd, scope);
}

/* ---- a substep */

/* What a substep is recorded with. */
typedef struct recording {
    virga_fluid *fluid;
    virga_context *context;
    VkCommandBuffer cmd;
    VkDescriptorSet set, grid_set;
    uint32_t offsets[2]; /* of the blocks: the step's, and that of the bodies' shapes */
} recording;

static void bind(const recording *r, const virga_bindings *bindings, VkDescriptorSet set)
{
    virga_bind(r->context, r->cmd, VK_PIPELINE_BIND_POINT_COMPUTE, bindings, set,
               bindings == r->fluid->bindings ? 2 : 1, r->offsets);
}

/* Dispatches with arguments of the state. */
static void run(const recording *r, const virga_pipeline *pass, size_t groups)
{
    virga_dispatch_indirect_and_barrier(r->context, r->cmd, pass, r->fluid->state->buffer, groups);
}

#define SLOTS offsetof(virga_fluid_state_gpu, slot_groups)
#define FLUID offsetof(virga_fluid_state_gpu, fluid_groups)
#define LOOP  offsetof(virga_fluid_state_gpu, loop_groups)

/* A pass over bodies. */
static void run_bodies(const recording *r, const virga_pipeline *pass, size_t groups)
{
    if (r->fluid->body_count)
        run(r, pass, groups);
}

#define BODIES      offsetof(virga_fluid_state_gpu, body_groups)
#define LOOP_BODIES offsetof(virga_fluid_state_gpu, loop_body_groups)

static void sort(const recording *r)
{
    const virga_fluid *fluid = r->fluid;
    const virga_pass_scope scope = virga_pass_begin(r->context, r->cmd, "fluid.sort");
    virga_wait(r->context, r->cmd, VIRGA_PASSES, VIRGA_COPIES);
    r->context->vk.CmdFillBuffer(r->cmd, fluid->grid.cell_starts->buffer, 0, VK_WHOLE_SIZE, 0);
    r->context->vk.CmdFillBuffer(r->cmd, fluid->grid.kept->buffer, 0, VK_WHOLE_SIZE, 0);
    virga_wait(r->context, r->cmd, VIRGA_COPIES, VIRGA_PASSES);
    bind(r, fluid->bindings, r->set);
    virga_dispatch_and_barrier(r->context, r->cmd, fluid->begin, 1);
    bind(r, fluid->grid.bindings, r->grid_set);
    run(r, fluid->count, SLOTS);
    particle_grid_sort(r->context, r->cmd, &fluid->grid, fluid->state->buffer, SLOTS);
    bind(r, fluid->bindings, r->set);
    virga_dispatch_indirect_and_barrier(r->context, r->cmd, fluid->copy, fluid->grid.state->buffer,
                                        offsetof(virga_particle_grid_gpu, sorted_groups));
    virga_pass_end(r->context, r->cmd, scope);
}

static void solve(const recording *r)
{
    const virga_fluid *fluid = r->fluid;
    const virga_pass_scope scope = virga_pass_begin(r->context, r->cmd, "fluid.solve");
    for (uint32_t i = 0; i < fluid->def.max_iterations; i++) {
        run(r, fluid->push, LOOP);
        run_bodies(r, fluid->body_push, LOOP_BODIES);
        run(r, fluid->correct, LOOP);
    }
    virga_pass_end(r->context, r->cmd, scope);
}

static void run_named(const recording *r, const char *name, const virga_pipeline *pass)
{
    const virga_pass_scope scope = virga_pass_begin(r->context, r->cmd, name);
    run(r, pass, FLUID);
    virga_pass_end(r->context, r->cmd, scope);
}

static void substep(const recording *r)
{
    const virga_fluid *fluid = r->fluid;
    sort(r);
    run_named(r, "fluid.neighbours", fluid->neighbours);
    run_bodies(r, fluid->body_contacts, BODIES);
    solve(r);
    run_bodies(r, fluid->body_move, BODIES);
    run_named(r, "fluid.advance", fluid->advance);
    run_bodies(r, fluid->body_hit, BODIES);
}

/* ---- a step */

static virga_result check_step(const virga_fluid *fluid, VkCommandBuffer cmd, const virga_fluid_step_info *info)
{
    if (!fluid)
        return VIRGA_ERROR_INVALID;
    const virga_context *context = fluid->base.context;
    const virga_log *log = &context->log;
    const virga_result result = virga_effect_check_one_step(&fluid->base, "virga_fluid_step", cmd, info);
    if (result)
        return result;
    if (!(info->dt_s >= 0 && info->dt_s <= 1))
        return virga_wrong_argument(log, "step_info.dt_s: expected 0 to 1, got %g", (double)info->dt_s);
    if (fluid_check_region(fluid, info))
        return VIRGA_ERROR_INVALID;
    if (particles_check(context, info->particles, info->offset, info->count))
        return VIRGA_ERROR_INVALID;
    if (info->count > fluid->def.max_particles - fluid->particles)
        return virga_wrong_argument(log, "step_info.count: %u particles, and there is room for %u more", info->count,
                                    fluid->def.max_particles - fluid->particles);
    return virga_effect_ready(&fluid->base);
}

static void fill_step(virga_fluid *fluid, const virga_fluid_step_info *info, virga_fluid_step_gpu *out)
{
    const virga_fluid_settings *settings = &fluid->settings;
    const float d = settings->spacing_m;
    *out = (virga_fluid_step_gpu){.cell_m = 2 * d,
                                  .inv_cell_m = 1 / (2 * d),
                                  .particles = fluid->particles,
                                  .max_cells = fluid->def.max_cells,
                                  .spacing_m = d,
                                  .inv_spacing_m = 1 / d,
                                  .viscosity_m2_s = settings->viscosity_m2_s,
                                  .dt_s = info->dt_s,
                                  .cfl = settings->cfl,
                                  .max_substeps = fluid->def.max_substeps,
                                  .solver_error = settings->solver_error,
                                  .stride = fluid->def.max_particles,
                                  .bodies = fluid->body_count,
                                  .max_contacts = fluid->def.max_contacts};
    memcpy(out->low_m, settings->low_m, sizeof out->low_m);
    memcpy(out->high_m, settings->high_m, sizeof out->high_m);
    memcpy(out->gravity_m_s2, settings->gravity_m_s2, sizeof out->gravity_m_s2);
    fluid_grid_box(settings, out->first_cell, out->dims);
    fluid_fill_exchange(fluid, info, out);
}

/* The part of the state that belongs to a step. */
static void begin_state(const virga_fluid *fluid, VkCommandBuffer cmd, float dt_s)
{
    virga_context *context = fluid->base.context;
    const virga_fluid_state_gpu begin = {.time_left_s = dt_s};
    context->vk.CmdUpdateBuffer(cmd, fluid->state->buffer, 0, offsetof(virga_fluid_state_gpu, max_speed2), &begin);
    virga_wait(context, cmd, VIRGA_COPIES, VIRGA_PASSES);
}

/* Substeps, then what is beside each particle. */
static void run_substeps(virga_fluid *fluid, VkCommandBuffer cmd, const virga_fluid_shapes_gpu *shapes,
                         uint32_t substeps)
{
    virga_context *context = fluid->base.context;
    virga_bound bound[VIRGA_MAX_BINDINGS];
    recording r = {fluid, context, cmd};
    r.offsets[0] = fluid->step_offset;
    r.offsets[1] = virga_ring_push(context, &fluid->shape_ring, shapes, sizeof *shapes);
    virga_effect_bound(&fluid->base, fluid->bindings, bound);
    r.set = virga_bindings_write(context, fluid->bindings, 0, bound);
    virga_effect_bound(&fluid->base, fluid->grid.bindings, bound);
    bound[PARTICLE_GRID_BIND_PARTICLES] = (virga_bound){.buffer = fluid->slots->buffer};
    r.grid_set = virga_bindings_write(context, fluid->grid.bindings, 0, bound);
    for (uint32_t i = 0; i < substeps; i++)
        substep(&r);
    bind(&r, fluid->bindings, r.set);
    if (fluid->body_count)
        virga_dispatch_and_barrier(context, cmd, fluid->body_near,
                                   virga_groups_of(fluid->particles, VIRGA_FLUID_LANES));
}

virga_result virga_fluid_step(virga_fluid *fluid, VkCommandBuffer cmd, const virga_fluid_step_info *info)
{
    const virga_result result = check_step(fluid, cmd, info);
    if (result)
        return result;
    virga_context *context = fluid->base.context;
    virga_effect_begin_step(&fluid->base, cmd);
    virga_effect_first_contents(&fluid->base, cmd);
    virga_effect_reads(&fluid->base, cmd, info->count ? info->particles : VK_NULL_HANDLE);
    virga_effect_reads(&fluid->base, cmd, info->leavers);
    begin_state(fluid, cmd, info->dt_s);
    add_all(fluid, cmd, info);
    virga_fluid_step_gpu step;
    virga_fluid_shapes_gpu shapes;
    fill_step(fluid, info, &step);
    fluid_send_bodies(fluid, cmd, info->dt_s, &step, &shapes);
    fluid->step_offset = virga_ring_push(context, &fluid->step_ring, &step, sizeof step);
    fluid_exchange_in(fluid, cmd, info);
    fluid->step_particles[context->ring_slot] = fluid->particles;
    if (fluid->body_count || (fluid->particles && info->dt_s > 0))
        run_substeps(fluid, cmd, &shapes, info->dt_s > 0 ? fluid->def.max_substeps : 0);
    fluid_exchange_out(fluid, cmd);
    virga_effect_copy_statistics(&fluid->base, cmd, 0, fluid->body_states, 0, offsetof(fluid_readback, bodies),
                                 sizeof(virga_fluid_body_gpu) * VIRGA_FLUID_MAX_BODIES);
    virga_effect_copy_statistics(&fluid->base, cmd, 0, fluid->exchange, 0, offsetof(fluid_readback, exchange),
                                 sizeof(virga_exchange_gpu));
    virga_effect_copy_statistics(&fluid->base, cmd, 0, fluid->state, 0, offsetof(fluid_readback, state),
                                 sizeof(virga_fluid_state_gpu));
    return virga_recording_result(context);
}
