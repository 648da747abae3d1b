/* water/water_surface.c - records a step: particles become the surfels of a surface. */
#include "water/water_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <virga/shared/foam.h>

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

/* Particles with a lower density than this are near the surface. Water at rest has densities of 0.95 to 1.05 inside,
 * and about 0.7 in its outermost layer. */
#define FULL_DENSITY     0.85f
#define FULL_ABOVE_LEVEL 0.35f /* and at least so much more than the density of the surface */

/* ---- statistics */

static uint32_t saturated_difference(uint32_t a, uint32_t b)
{
    return a > b ? a - b : 0;
}

/* The surface has a hole where one of these is missing. */
static void log_dropped(const virga_water *water)
{
    const virga_log *log = &water->base.context->log;
    if (water->stats.blocks_dropped)
        virga_log_write(log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED,
                        "%u cells of the water's surface found no room; water_def.max_blocks is %u",
                        water->stats.blocks_dropped, water->def.max_blocks);
    if (water->stats.surfels_dropped)
        virga_log_write(log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED,
                        "%u surfels of the water found no room; water_def.max_surfels is %u",
                        water->stats.surfels_dropped, water->def.max_surfels);
}

void water_read_statistics(void *object, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data)
{
    virga_water *water = object;
    water_readback read;
    (void)parts;
    memcpy(&read, data, sizeof read);
    const uint32_t particles = water->step_particles[ring_slot];
    water->stats =
        (virga_water_stats){.frame_index = frame,
                            .particles = particles,
                            .invalid = saturated_difference(particles, read.grid.valid),
                            .in_grid = read.grid.sorted,
                            .surfels = read.state.surfels,
                            .surfels_dropped = saturated_difference(read.state.surfels_wanted, read.state.surfels),
                            .splashes = read.state.splashes,
                            .splashes_dropped = saturated_difference(read.state.splashes_wanted, read.state.splashes),
                            .droplets = read.state.droplets,
                            .droplets_dropped = saturated_difference(read.state.droplets_wanted, read.state.droplets),
                            .handed_nl = (uint64_t)read.state.handed_nl[1] << 32 | read.state.handed_nl[0],
                            .taken_back_nl = (uint64_t)read.state.taken_nl[1] << 32 | read.state.taken_nl[0],
                            .foam = read.state.foam,
                            .foam_dropped = saturated_difference(
                                read.state.foam_wanted, saturated_difference(read.state.foam, read.state.foam_first)),
                            .foam_spray = read.state.foam_kinds[VIRGA_FOAM_SPRAY],
                            .foam_surface = read.state.foam_kinds[VIRGA_FOAM_SURFACE],
                            .foam_bubbles = read.state.foam_kinds[VIRGA_FOAM_BUBBLE],
                            .blocks = read.state.blocks,
                            .blocks_dropped = saturated_difference(read.state.blocks_wanted, read.state.blocks)};
    log_dropped(water);
}

/* ---- a step */

/* How far the surface may be from the nearest particle of low density (m).
 *
 * In a half space of water, at a distance s beyond its boundary, the density is the integral of the kernel over the
 * part of its ball that is in the water. The kernel's integral over a plane at the distance z is
 * 315 / (256 h^9) (h^2 - z^2)^4. The boundary is half a spacing beyond the outermost particles. Particles may be closer
 * together than at rest, by a quarter of the density, and out of their order, by a fifth of the spacing. */
static double surface_reach(double level, double d, double h)
{
    const int steps = 256;
    double density = 0, z = h;
    for (int i = 0; i < 2 * steps && 1.25 * density < level; i++) {
        const double middle = z - 0.5 * h / steps;
        density += 315 / (256 * pow(h, 9)) * pow(h * h - middle * middle, 4) * h / steps;
        z -= h / steps;
    }
    const double reach = z + 0.5 * d + 0.2 * d;
    return reach < 0.6 * d ? 0.6 * d : reach;
}

/* Radius of the kernel whose ball at the density of the surface is largest, for a particle all alone (m).
 *
 * With the radius k, its density is level at the distance r for 315 v / (64 pi k^3) (1 - (r / k)^2)^3 = level, so
 * (r / k)^2 = 1 - c k with c = (64 pi level / (315 v))^(1/3): r is largest for k = 2 / (3 c). At the level 0.5 the ball
 * then has 0.75 of the particle's volume; no radius gives more. */
static double lonely_radius(double level, double volume, double h)
{
    const double k = 2 / (3 * cbrt(64 * PI * level / (315 * volume)));
    return k < h ? k : h;
}

/* 1 / sum of the weights 1 - (r / h)^3 of neighbours in water at rest: 4 pi times the integral of the weight r^2 is
 * 2/3 pi h^3, for one particle in d^3. */
static double crowd(double d, double h)
{
    return d * d * d / (2 * PI / 3 * h * h * h);
}

static double point_m(const virga_water_settings *settings)
{
    return (double)settings->kernel_spacings * (double)settings->spacing_m / VIRGA_WATER_SIDE;
}

double water_surfel_m(const virga_water_settings *settings)
{
    return (double)VIRGA_WATER_SURFEL_STEPS * point_m(settings);
}

static void fill_step(const virga_water *water, uint32_t particles, virga_water_step_gpu *out)
{
    const virga_water_settings *settings = &water->settings;
    const double d = (double)settings->spacing_m, h = (double)settings->kernel_spacings * d;
    /* Equation 2 with the particle's own volume in place of d^3: W'(r, h) = kernel (1 - (r / h)^2)^3. */
    const double volume = water_particle_m3(settings), kernel = 315 * volume / (64 * PI * h * h * h);
    *out = (virga_water_step_gpu){.cell_m = (float)h,
                                  .inv_cell_m = (float)(1 / h),
                                  .particles = particles,
                                  .max_cells = water->def.max_cells,
                                  .max_blocks = water->def.max_blocks,
                                  .max_surfels = water->def.max_surfels,
                                  .kernel = (float)kernel,
                                  .kernel_gradient = (float)(-6 * kernel / (h * h)),
                                  .inv_h2 = (float)(1 / (h * h)),
                                  .level = settings->level,
                                  .full = fmaxf(FULL_DENSITY, settings->level + FULL_ABOVE_LEVEL),
                                  .reach = (float)(surface_reach((double)settings->level, d, h) / h),
                                  .point_m = (float)point_m(settings),
                                  .surfel_m = (float)water_surfel_m(settings),
                                  .smoothing = settings->smoothing,
                                  .stretch2 = settings->stretch * settings->stretch,
                                  .volume = (float)volume,
                                  .lonely_m = (float)lonely_radius((double)settings->level, volume, h),
                                  .crowd = (float)crowd(d, h)};
}

/* Dispatches with a workgroup for each entry of a list whose length an earlier pass wrote into the state. */
static void over(const virga_water *water, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t groups)
{
    virga_dispatch_indirect_and_barrier(water->base.context, cmd, pipeline, water->state->buffer, groups);
}

static void over_cells(const virga_water *water, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t groups)
{
    virga_dispatch_indirect_and_barrier(water->base.context, cmd, pipeline, water->grid.state->buffer, groups);
}

static void record_densities(virga_water *water, VkCommandBuffer cmd)
{
    if (water->settings.fading == VIRGA_WATER_FADING_COVERAGE) {
        over_cells(water, cmd, water->cover, offsetof(virga_particle_grid_gpu, fading_groups));
        over_cells(water, cmd, water->relative, offsetof(virga_particle_grid_gpu, fading_groups));
    }
    over_cells(water, cmd, water->density[water->settings.kernel], offsetof(virga_particle_grid_gpu, sorted_groups));
}

static void record_blocks(virga_water *water, VkCommandBuffer cmd)
{
    over_cells(water, cmd, water->block_mark, offsetof(virga_particle_grid_gpu, cell_groups));
    virga_dispatch_and_barrier(water->base.context, cmd, water->block_scan, 1);
    over_cells(water, cmd, water->block_compact, offsetof(virga_particle_grid_gpu, word_groups));
}

static void record_kernels(virga_water *water, VkCommandBuffer cmd)
{
    over_cells(water, cmd, water->kernel[water->settings.kernel], offsetof(virga_particle_grid_gpu, sorted_groups));
}

static void record_fields(virga_water *water, VkCommandBuffer cmd)
{
    over(water, cmd, water->field[water->settings.kernel], offsetof(virga_water_state_gpu, block_groups));
}

static void record_surfels(virga_water *water, VkCommandBuffer cmd)
{
    over(water, cmd, water->surfel_count, offsetof(virga_water_state_gpu, block_lane_groups));
    virga_dispatch_and_barrier(water->base.context, cmd, water->surfel_scan, 1);
    over(water, cmd, water->edge_write, offsetof(virga_water_state_gpu, block_lane_groups));
    over(water, cmd, water->surfel_write[water->settings.kernel], offsetof(virga_water_state_gpu, surfel_groups));
}

/* A layout with its set for this step. */
typedef struct step_set {
    const virga_bindings *layout;
    VkDescriptorSet set;
    uint32_t offset; /* of the block of the step */
} step_set;

static void run(virga_water *water, VkCommandBuffer cmd, const char *name, const step_set *use,
                void (*record)(virga_water *, VkCommandBuffer))
{
    virga_context *context = water->base.context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, name);
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, use->layout, use->set, 1, &use->offset);
    record(water, cmd);
    virga_pass_end(context, cmd, scope);
}

static virga_result check_step(const virga_water *water, VkCommandBuffer cmd, const virga_water_step_info *info)
{
    if (!water)
        return VIRGA_ERROR_INVALID;
    const virga_context *context = water->base.context;
    const virga_result result = virga_effect_check_one_step(&water->base, "virga_water_step", cmd, info);
    if (result)
        return result;
    if (particles_check(context, info->particles, info->offset, info->count) ||
        virga_settings_check_positions(&context->log, "step_info.origin_m", info->origin_m, 3) ||
        virga_settings_check_positions(&context->log, "step_info.time_s", &info->time_s, 1) ||
        (info->handed && virga_host_list_check(context, "step_info.handed", info->handed, info->handed_offset,
                                               info->handed_size, sizeof(virga_handed_droplets_gpu))))
        return VIRGA_ERROR_INVALID;
    if (info->bodies && (particles_check(context, info->bodies, info->bodies_offset, info->count)))
        return VIRGA_ERROR_INVALID;
    return virga_effect_ready(&water->base);
}

static VkDescriptorSet write_set(virga_water *water, const virga_bindings *layout, const virga_water_step_info *info,
                                 uint32_t particles)
{
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&water->base, layout, bound);
    bound[WATER_BIND_PARTICLES] = particles_bound(info->particles, info->offset, particles, water->surfels);
    if (layout == water->spray.bindings)
        bound[WATER_BIND_HANDED] =
            info->handed
                ? (virga_bound){.buffer = info->handed,
                                .offset = info->handed_offset,
                                .range = virga_host_list_range(water->base.context, info->handed_size, VK_WHOLE_SIZE)}
                : (virga_bound){.buffer = water->surfels->buffer}; /* neither read nor written */
    if (layout == water->foam.bindings)
        bound[WATER_BIND_BODIES] =
            particles_bound(info->bodies, info->bodies_offset, info->bodies ? particles : 0, water->surfels);
    return virga_bindings_write(water->base.context, (virga_bindings *)layout, 0, bound);
}

virga_result virga_water_step(virga_water *water, VkCommandBuffer cmd, const virga_water_step_info *info)
{
    const virga_result result = check_step(water, cmd, info);
    if (result)
        return result;
    virga_context *context = water->base.context;
    const uint32_t particles = info->count < water->def.max_particles ? info->count : water->def.max_particles;
    virga_water_step_gpu step;
    virga_effect_forget_views(&water->base, 0);
    memcpy(water->origin_m, info->origin_m, sizeof water->origin_m);
    water->step_particles[context->ring_slot] = particles;
    fill_step(water, particles, &step);
    water_spray_fill(water, info, &step);
    water_foam_fill(water, info, &step);
    const uint32_t offset = virga_ring_push(context, &water->step_ring, &step, sizeof step);
    const VkDescriptorSet grid_set = write_set(water, water->grid.bindings, info, particles);
    const step_set kernels = {water->kernel_bindings, write_set(water, water->kernel_bindings, info, particles),
                              offset};
    const step_set surface = {water->bindings, write_set(water, water->bindings, info, particles), offset};
    const step_set spray = {water->spray.bindings, write_set(water, water->spray.bindings, info, particles), offset};
    const step_set foam = {water->foam.bindings, write_set(water, water->foam.bindings, info, particles), offset};
    virga_effect_begin_step(&water->base, cmd);
    virga_effect_first_contents(&water->base, cmd);
    virga_effect_reads(&water->base, cmd, info->handed);
    virga_effect_reads(&water->base, cmd, info->bodies);
    virga_effect_reads(&water->base, cmd, particles ? info->particles : VK_NULL_HANDLE);
    water_spray_clear(water, cmd);
    if (!info->sub_frame)
        water_foam_clear(water, cmd);
    context->vk.CmdFillBuffer(cmd, water->densities->buffer, 0, VK_WHOLE_SIZE, 0);
    context->vk.CmdFillBuffer(cmd, water->cell_marks->buffer, 0, VK_WHOLE_SIZE, 0);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "water.grid");
    particle_grid_record(context, cmd, &water->grid, grid_set, offset, particles);
    virga_pass_end(context, cmd, scope);
    run(water, cmd, "water.density", &kernels, record_densities);
    if (water_has_spray(water))
        run(water, cmd, "water.spray", &spray, water_spray_record);
    run(water, cmd, "water.blocks", &surface, record_blocks);
    run(water, cmd, "water.kernels", &kernels, record_kernels);
    run(water, cmd, "water.field", &surface, record_fields);
    run(water, cmd, "water.surfels", &surface, record_surfels);
    if (water_has_spray(water))
        run(water, cmd, "water.spray_surfels", &spray, water_spray_record_surfels);
    if (water_has_foam(water) && !info->sub_frame)
        run(water, cmd, "water.foam", &foam, water_foam_record);
    virga_effect_copy_statistics(&water->base, cmd, 0, water->grid.state, 0, offsetof(water_readback, grid),
                                 sizeof(virga_particle_grid_gpu));
    virga_effect_copy_statistics(&water->base, cmd, 0, water->state, 0, offsetof(water_readback, state),
                                 sizeof(virga_water_state_gpu));
    const virga_result uploaded = virga_recording_result(context);
    if (uploaded || particles == info->count)
        return uploaded;
    virga_log_write(&context->log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED,
                    "step_info.count: %u particles, and water_def.max_particles is %u: the others are left out",
                    info->count, particles);
    return VIRGA_DEGRADED;
}
