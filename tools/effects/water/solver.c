/* solver.c - water that is simulated: created from a scene, stepped with its frames, and read at any time within the
 * newest step. */
#include "water_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Open sides are no walls. */
void water_foam_walls(const scene_file *scene, virga_water_settings *settings)
{
    const scene_solver *from = &scene_water_of(scene)->solver;
    const bool open = from->exchange.max_particles && from->exchange.open_sides;
    if (!water_is_solved(scene))
        return;
    for (int axis = 0; axis < 3; axis++) {
        settings->foam_walls_low_m[axis] = open && axis != 1 ? -10000 : (float)from->walls.low_m[axis];
        settings->foam_walls_high_m[axis] = open ? 10000 : (float)from->walls.high_m[axis];
    }
}

/* ---- create and destroy */

static bool set_fluid(shot *s, const water_state *state, char *error, size_t error_size)
{
    const scene_solver *from = &scene_water_of(s->scene)->solver;
    virga_fluid_settings settings = virga_default_fluid_settings();
    settings.spacing_m = (float)from->spacing_m;
    settings.viscosity_m2_s = (float)from->viscosity_m2_s;
    settings.cfl = (float)from->cfl;
    settings.solver_error = (float)from->solver_error;
    if (from->exchange.max_particles) {
        settings.open_sides = from->exchange.open_sides;
        settings.rest_speed_m_s = (float)from->exchange.rest_speed_m_s;
        settings.film_speed_m_s = (float)from->exchange.film_speed_m_s;
        settings.rest_s = (float)from->exchange.rest_s;
        settings.rest_height_m = (float)from->exchange.rest_height_m;
    }
    for (int axis = 0; axis < 3; axis++) {
        settings.low_m[axis] = (float)from->walls.low_m[axis];
        settings.high_m[axis] = (float)from->walls.high_m[axis];
        settings.gravity_m_s2[axis] = (float)from->gravity_m_s2[axis];
    }
    return shot_ok(s, virga_fluid_set(state->solver.fluid, &settings), "setting water.solver", error, error_size);
}

static bool add_boxes(shot *s, const water_state *state, char *error, size_t error_size)
{
    const scene_solver *from = &scene_water_of(s->scene)->solver;
    for (uint32_t i = 0; i < from->box_count; i++) {
        virga_fluid_block block;
        for (int axis = 0; axis < 3; axis++) {
            block.low_m[axis] = (float)from->boxes[i].low_m[axis];
            block.high_m[axis] = (float)from->boxes[i].high_m[axis];
            block.velocity_m_s[axis] = (float)from->boxes[i].velocity_m_s[axis];
        }
        if (!shot_ok(s, virga_fluid_add(state->solver.fluid, &block), "adding water", error, error_size))
            return false;
    }
    return true;
}

static bool create_fluid(shot *s, water_state *state, char *error, size_t error_size)
{
    const scene_solver *from = &scene_water_of(s->scene)->solver;
    virga_fluid_def def = virga_default_fluid_def();
    def.max_particles = state->source.most < 64 ? 64 : state->source.most;
    def.max_exchanged = from->exchange.max_particles;
    def.max_cells = state->source.most_cells;
    def.max_substeps = from->max_substeps;
    def.max_iterations = from->max_iterations;
    water_size_bodies(s, state, &def);
    const virga_result result = virga_fluid_create(s->context, &def, &state->solver.fluid);
    if (!shot_ok(s, result, "creating the solver of water", error, error_size))
        return false;
    return result != VIRGA_DEGRADED ||
           host_fail(error, error_size, "water.solver: no room for its particles: %s", s->warning);
}

static bool create_copies(shot *s, water_state *state, char *error, size_t error_size)
{
    state->solver.bodies_at = (VkDeviceSize)state->max_particles * sizeof(virga_particle_gpu);
    const VkDeviceSize size = state->solver.bodies_at + VIRGA_FLUID_MAX_BODIES * sizeof(virga_fluid_body_gpu);
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    return host_buffer_create(&s->device, size, usage, HOST_BUFFER_READBACK, "particles before", &state->solver.before,
                              error, error_size) &&
           host_buffer_create(&s->device, size, usage, HOST_BUFFER_READBACK, "particles now", &state->solver.now, error,
                              error_size);
}

bool water_open_solver(shot *s, water_state *state, char *error, size_t error_size)
{
    return water_open_bodies(s, state, error, error_size) && water_add_occluders(s, state, error, error_size) &&
           create_fluid(s, state, error, error_size) && set_fluid(s, state, error, error_size) &&
           add_boxes(s, state, error, error_size) && water_add_bodies(s, state, error, error_size) &&
           create_copies(s, state, error, error_size);
}

void water_close_solver(shot *s, water_state *state)
{
    virga_fluid_destroy(&state->solver.fluid);
    water_close_bodies(s, state);
    host_buffer_destroy(&s->device, &state->solver.before);
    host_buffer_destroy(&s->device, &state->solver.now);
    host_buffer_destroy(&s->device, &state->solver.densities.buffer);
}

/* ---- time */

/* The newest state becomes the one before. */
static void copy_states(const water_solver *solver, VkCommandBuffer cmd)
{
    const VkPipelineStageFlags copying = VK_PIPELINE_STAGE_TRANSFER_BIT, passes = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    const VkAccessFlags written = VK_ACCESS_TRANSFER_WRITE_BIT;
    virga_fluid_buffer particles, bodies;
    uint32_t count;
    virga_fluid_particles(solver->fluid, &particles, &count);
    virga_fluid_bodies(solver->fluid, &bodies);
    const VkBufferCopy copy = {0, 0, solver->now.size};
    const VkBufferCopy newest = {particles.offset, 0, (VkDeviceSize)count * sizeof(virga_particle_gpu)};
    const VkBufferCopy newest_bodies = {bodies.offset, solver->bodies_at, bodies.size};
    host_memory_barrier(cmd, copying, written, copying, written | VK_ACCESS_TRANSFER_READ_BIT);
    vkCmdCopyBuffer(cmd, solver->now.buffer, solver->before.buffer, 1, &copy);
    host_memory_barrier(cmd, copying, written, copying, written);
    vkCmdCopyBuffer(cmd, particles.buffer, solver->now.buffer, 1, &newest);
    if (bodies.size)
        vkCmdCopyBuffer(cmd, bodies.buffer, solver->now.buffer, 1, &newest_bodies);
    host_memory_barrier(cmd, copying, written, VK_PIPELINE_STAGE_HOST_BIT | passes, VK_ACCESS_HOST_READ_BIT);
}

/* Where water of the ground becomes particles, and the spray that ends others. */
static void fill_exchange(const shot *s, const water_state *state, double time_s, virga_fluid_step_info *info)
{
    const scene_exchange *exchange = &scene_water_of(s->scene)->solver.exchange;
    virga_water_leavers leavers;
    if (!exchange->max_particles)
        return;
    water_body_region(state, time_s, exchange->margin_m, info->region_low_m, info->region_high_m);
    virga_water_leavers_get(state->water, &leavers);
    info->leavers = leavers.leavers;
    info->leavers_size = leavers.size;
}

/* Before the water's time begins it stands still. */
bool water_step_solver(shot *s, water_state *state, VkCommandBuffer cmd, double frame_s, double dt_s, char *error,
                       size_t error_size)
{
    water_solver *solver = &state->solver;
    const double moving_s = fmax(frame_s, 0) - fmax(frame_s - dt_s, 0);
    const double time_s = frame_s + scene_water_of(s->scene)->start_s;
    virga_fluid_step_info info = {.dt_s = (float)fmin(fmax(moving_s, 0), 1)};
    fill_exchange(s, state, time_s, &info);
    if (!water_note_bodies(s, state, frame_s, error, error_size))
        return false;
    if (!set_fluid(s, state, error, error_size) || !water_drive_bodies(s, state, time_s, error, error_size) ||
        !shot_ok(s, virga_fluid_step(solver->fluid, cmd, &info), "stepping the solver of water", error, error_size))
        return false;
    const bool is_first = !solver->count;
    virga_fluid_particles(solver->fluid, NULL, &solver->count);
    copy_states(solver, cmd);
    solver->before_s = is_first ? frame_s : solver->now_s;
    solver->now_s = frame_s;
    solver->step_frame = s->device.frame;
    solver->frame_s[s->device.frame % WATER_TIMES] = frame_s;
    return true;
}

/* ---- checkpoints */

bool water_save_solver(shot *s, const water_state *state, VkCommandBuffer cmd, const virga_state_range *to, char *error,
                       size_t error_size)
{
    return shot_ok(s, virga_fluid_save(state->solver.fluid, cmd, to), "saving the solver of water", error, error_size);
}

bool water_load_solver(shot *s, water_state *state, VkCommandBuffer cmd, const virga_state_source *from, double frame_s,
                       char *error, size_t error_size)
{
    water_solver *solver = &state->solver;
    if (!shot_ok(s, virga_fluid_load(solver->fluid, cmd, from), "loading the solver of water", error, error_size))
        return false;
    virga_fluid_particles(solver->fluid, NULL, &solver->count);
    copy_states(solver, cmd);
    solver->before_s = solver->now_s = frame_s;
    solver->step_frame = s->device.frame;
    solver->frame_s[s->device.frame % WATER_TIMES] = frame_s;
    return true;
}

/* ---- particles at a time */

/* As mix_curve in tools/io/particle_pair.c; `s` of the way from a to b. Where a slot has got another particle, that
 * moves evenly. */
static void mix(const virga_particle_gpu *a, const virga_particle_gpu *b, double h, double s, virga_particle_gpu *out)
{
    const bool same = a->id == b->id && a->share > 0;
    *out = *b;
    for (int axis = 0; axis < 3; axis++) {
        const double pa = (double)a->position[axis], pb = (double)b->position[axis];
        const double va = (double)a->velocity[axis], vb = (double)b->velocity[axis];
        const double up = s * s * (3 - 2 * s), rise = 6 * s * (1 - s) / h;
        out->position[axis] =
            (float)(same ? pa + up * (pb - pa) + s * (1 - s) * h * ((1 - s) * va - s * vb) : pb - (1 - s) * h * vb);
        if (same)
            out->velocity[axis] = (float)(rise * (pb - pa) + (1 - s) * (1 - 3 * s) * va + s * (3 * s - 2) * vb);
    }
}

static bool mix_all(shot *s, const water_solver *solver, double time_s, virga_particle_gpu *out, char *error,
                    size_t error_size)
{
    const virga_particle_gpu *before = solver->before.mapped, *now = solver->now.mapped;
    const double h = solver->now_s - solver->before_s, part = h > 0 ? fmax((time_s - solver->before_s) / h, 0) : 1;
    if (!water_wait_for_solver(s, solver, error, error_size))
        return false;
    if (part >= 1)
        memcpy(out, now, solver->count * sizeof *out);
    for (uint32_t i = 0; part < 1 && i < solver->count; i++)
        mix(&before[i], &now[i], h, part, &out[i]);
    return true;
}

/* The newest state is on the device; what was before is not. */
bool water_fill_solved(shot *s, water_state *state, double time_s, virga_water_step_info *info, char *error,
                       size_t error_size)
{
    const water_solver *solver = &state->solver;
    const scene_water *from = scene_water_of(s->scene);
    const bool newest = time_s >= solver->now_s;
    info->time_s = time_s;
    memcpy(info->origin_m, from->position_m, sizeof info->origin_m);
    info->count = solver->count;
    if (newest) {
        virga_fluid_buffer particles, bodies;
        virga_fluid_particles(solver->fluid, &particles, NULL);
        virga_fluid_bodies_near(solver->fluid, &bodies);
        info->particles = particles.buffer;
        info->offset = particles.offset;
        info->bodies = bodies.buffer;
        info->bodies_offset = bodies.offset;
    } else {
        info->particles = state->particles.buffer;
        info->offset = s->device.frame % HOST_FRAMES * state->max_particles * sizeof(virga_particle_gpu);
        if (!mix_all(s, solver, time_s, (void *)((char *)state->particles.mapped + info->offset), error, error_size))
            return false;
    }
    state->count = solver->count;
    state->given = solver->now.mapped;
    state->step_frame = s->device.frame;
    return true;
}

bool water_copy_solved(shot *s, water_state *state, virga_particle_gpu *particles, char *error, size_t error_size)
{
    return mix_all(s, &state->solver, state->time_s, particles, error, error_size);
}

/* ---- statistics */

bool water_read_solver(shot *s, water_state *state, VkCommandBuffer cmd, char *error, size_t error_size)
{
    virga_water_buffer densities;
    virga_water_densities(state->water, &densities);
    return shot_record_read(s, cmd, densities.buffer, densities.offset, densities.size, &state->solver.densities, error,
                            error_size);
}

/* Energy of the water (J), with the floor of the walls at no height. */
static void write_energy(const water_solver *solver, const scene_solver *from, jsonl *stats)
{
    const virga_particle_gpu *now = solver->now.mapped;
    const double mass_kg = 1000 * pow(from->spacing_m, 3);
    double kinetic = 0, potential = 0;
    for (uint32_t i = 0; i < solver->count; i++) {
        for (int axis = 0; axis < 3 && now[i].share > 0; axis++) {
            const double v = (double)now[i].velocity[axis];
            kinetic += 0.5 * v * v;
            potential -= from->gravity_m_s2[axis] * ((double)now[i].position[axis] - from->walls.low_m[axis]);
        }
    }
    jsonl_number(stats, "kinetic_j", mass_kg * kinetic);
    jsonl_number(stats, "potential_j", mass_kg * potential);
}

/* How much too dense the water is: the mean over its particles of what is above 1. So much of its volume is lost at
 * most; noise of the particles is in it. */
static void write_volume_error(shot *s, const water_solver *solver, jsonl *stats)
{
    const float *densities = solver->densities.buffer.mapped;
    const virga_particle_gpu *now = solver->now.mapped;
    double above = 0, count = 0;
    if (!densities)
        return;
    host_buffer_invalidate(&s->device, &solver->densities.buffer);
    for (uint32_t i = 0; i < solver->count; i++) {
        above += now[i].share > 0 ? fmax((double)densities[i] - 1, 0) : 0;
        count += now[i].share > 0;
    }
    jsonl_number(stats, "volume_error", above / fmax(count, 1));
}

/* What came from the ground and went there. */
static void write_exchange(const virga_fluid_stats *now, jsonl *stats)
{
    jsonl_begin_object(stats, "exchange");
    jsonl_uint64(stats, "free", now->free);
    jsonl_uint64(stats, "waiting", now->waiting);
    jsonl_number(stats, "particle_ul", now->particle_nl * 1e-3);
    jsonl_number(stats, "taken_ul", (double)now->taken_nl * 1e-3);
    jsonl_number(stats, "given_ul", (double)now->given_nl * 1e-3);
    jsonl_number(stats, "sprayed_ul", (double)now->sprayed_nl * 1e-3);
    jsonl_number(stats, "rest_ul", (double)now->rest_nl * 1e-3);
    jsonl_end(stats);
}

void water_write_solver_stats(shot *s, water_state *state, jsonl *stats)
{
    const water_solver *solver = &state->solver;
    char ignored[256];
    virga_fluid_stats now;
    virga_fluid_stats_get(solver->fluid, &now);
    if (!water_wait_for_solver(s, solver, ignored, sizeof ignored))
        return;
    jsonl_begin_object(stats, "solver");
    jsonl_uint64(stats, "particles", now.particles);
    jsonl_uint64(stats, "moved", now.moved);
    jsonl_uint64(stats, "substeps", now.substeps);
    jsonl_uint64(stats, "iterations", now.iterations);
    jsonl_number(stats, "solver_error", (double)now.solver_error);
    jsonl_number(stats, "max_speed_m_s", (double)now.max_speed_m_s);
    write_energy(solver, &scene_water_of(s->scene)->solver, stats);
    write_volume_error(s, solver, stats);
    if (scene_water_of(s->scene)->solver.exchange.max_particles)
        write_exchange(&now, stats);
    water_write_body_stats(state, stats);
    jsonl_end(stats);
}
