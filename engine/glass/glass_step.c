/* glass/glass_step.c - records a step. In each tick drops land, run, are wiped by blades, and dry. */
#include "glass/glass_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <virga/shared/random.h>

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

#define ROUNDS    VIRGA_GLASS_ROUNDS
#define DRY_SHARE 16u /* each tick dries the film of 1 / DRY_SHARE of the rows */

#define TAIL_SHARE     0.12f /* max share of a running drop's water that a drop in its tail gets */
#define HOLD_BACK      1.27  /* times the min radius of running drops: no glass holds larger drops, however uneven */
#define FILM_M_S       0.1   /* the speed that settings.film_um is for */
#define MIN_CROWD      12    /* neighbours of a particle in two rings, close together */
#define DRAG_OF_SPHERE 0.9   /* drag coefficient of a cap in a flow along the glass, without half the density */

/* ---- statistics */

static uint64_t count_of(virga_glass_count_gpu count)
{
    return (uint64_t)count.high << 32 | count.low;
}

static void read_state(virga_glass_stats *stats, uint64_t frame, const virga_glass_state_gpu *state)
{
    stats->frame_index = frame;
    stats->landed_nl = count_of(state->counts[VIRGA_GLASS_LANDED]);
    stats->run_off_nl = count_of(state->counts[VIRGA_GLASS_RUN_OFF]);
    stats->wiped_nl = count_of(state->counts[VIRGA_GLASS_WIPED]);
    stats->touched_nl = count_of(state->counts[VIRGA_GLASS_TOUCHED]);
    stats->joined_nl = count_of(state->counts[VIRGA_GLASS_JOINED]);
    stats->evaporated_nl = count_of(state->counts[VIRGA_GLASS_EVAPORATED]);
    stats->condensed_pl = count_of(state->counts[VIRGA_GLASS_CONDENSED]);
    stats->fog_dried_pl = count_of(state->counts[VIRGA_GLASS_FOG_DRIED]);
    stats->fog_given_nl = count_of(state->counts[VIRGA_GLASS_FOG_GIVEN]);
    /* Nothing else happens to fog, so this is exact, and no pass has to sum all cells. */
    stats->fog_pl = stats->condensed_pl - stats->fog_dried_pl - 1000 * stats->fog_given_nl;
    stats->arrived = count_of(state->counts[VIRGA_GLASS_ARRIVED]);
    stats->merged = count_of(state->counts[VIRGA_GLASS_MERGED]);
    stats->to_particles = count_of(state->counts[VIRGA_GLASS_TO_PARTS]);
    stats->to_drops = count_of(state->counts[VIRGA_GLASS_TO_DROPS]);
    stats->drops_without_slot = count_of(state->counts[VIRGA_GLASS_WITHOUT_SLOT]);
    stats->drops_nl = count_of(state->measured[0]);
    stats->particles_nl = count_of(state->measured[1]);
    stats->film_nl = count_of(state->measured[2]);
    stats->drops = state->drops;
    stats->particles = state->particles;
    stats->particles_waiting = state->particles_waiting;
}

static void read_views(virga_glass_stats *stats, uint32_t views, const glass_readback *read)
{
    stats->views = views;
    for (uint32_t i = 0; i < VIRGA_MAX_VIEWS; i++)
        stats->view_balls[i] = i < views ? read->prepared[i].balls : 0;
    stats->balls = read->prepared[views - 1].balls;
    stats->ball_entries_dropped = read->prepared[views - 1].ball_entries_dropped;
}

/* A frame may have a prepare without a step, or a step without a prepare: `parts` has a bit for each. */
void glass_read_statistics(void *object, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data)
{
    virga_glass_stats *stats = &((virga_glass *)object)->stats;
    glass_readback read;
    memcpy(&read, data, sizeof read);
    if (parts & 1u << GLASS_PART_STEP)
        read_state(stats, frame, &read.state);
    if (parts & 1u << GLASS_PART_PREPARE)
        read_views(stats, ((virga_glass *)object)->base.readback_views[ring_slot], &read);
}

void glass_lost(void *object, uint64_t frame, uint32_t did)
{
    virga_glass *glass = object;
    (void)frame;
    if (did & (GLASS_DID_UNWRITTEN | GLASS_DID_TEXTURES))
        glass_picture_forget(glass);
}

/* ---- from the world to the pane's frame */

static void to_pane(const virga_glass_step_info *info, const double world[3], double out[3])
{
    const float *m = info->world_from_pane;
    bool none = true;
    for (int i = 0; i < 9; i++)
        none = none && m[i] == 0;
    for (int i = 0; i < 3; i++)
        out[i] = none ? world[i]
                      : (double)m[3 * i] * world[0] + (double)m[3 * i + 1] * world[1] + (double)m[3 * i + 2] * world[2];
}

virga_result glass_axes_check(const virga_log *log, const char *name, const float axes[9])
{
    bool none = true;
    for (int i = 0; i < 9; i++)
        none = none && axes[i] == 0;
    return none ? VIRGA_OK : virga_settings_check_rotation(log, name, axes, 3);
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void store(const double from[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (float)from[i];
}

/* ---- drops that land
 *
 * A drop of diameter D falls at its terminal speed v(D) and is carried by the wind. Its velocity relative to the pane
 * is V(D) = wind - v(D) up - pane. N(D) dD |V . n| drops hit a square metre per second. */

#define SIZES 128

static void landing_of(virga_glass *glass, const virga_glass_step_info *info, virga_glass_tick_gpu *tick,
                       double *per_tick)
{
    *per_tick = 0;
    if (!(info->rate_mm_h > 0))
        return;
    static const virga_sizes marshall_palmer = {.kind = VIRGA_SIZES_MARSHALL_PALMER};
    const double step = (VIRGA_DROP_MAX_M - VIRGA_DROP_MIN_M) / SIZES, air = (double)info->air_density;
    double diameters[SIZES], density[SIZES], fluxes[SIZES], mean[3] = {0, 0, 0}, ways[SIZES][3];
    for (int i = 0; i < SIZES; i++)
        diameters[i] = VIRGA_DROP_MIN_M + (i + 0.5) * step;
    if (virga_sizes_densities(info->sizes ? info->sizes : &marshall_palmer, (double)info->rate_mm_h, air, SIZES,
                              diameters, density))
        return;
    for (int i = 0; i < SIZES; i++) {
        const double world[3] = {(double)info->wind_m_s[0] - (double)info->velocity_m_s[0],
                                 (double)info->wind_m_s[1] - (double)info->velocity_m_s[1] -
                                     virga_drop_terminal_speed(diameters[i], air),
                                 (double)info->wind_m_s[2] - (double)info->velocity_m_s[2]};
        to_pane(info, world, ways[i]);
        for (int axis = 0; axis < 3; axis++)
            mean[axis] += density[i] * step * ways[i][axis];
    }
    const double length = sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
    if (!(length > 0))
        return;
    /* Find the node that faces the rain best. Other positions get less rain, by the cosine. */
    double facing = 0, normal[3] = {0, 0, 0};
    for (int i = 0; i < VIRGA_GLASS_NODES * VIRGA_GLASS_NODES; i++) {
        const float *n = glass->normals[i];
        const double cosine = -(mean[0] * (double)n[0] + mean[1] * (double)n[1] + mean[2] * (double)n[2]) / length;
        if (cosine > facing) {
            facing = cosine;
            for (int axis = 0; axis < 3; axis++)
                normal[axis] = (double)n[axis];
        }
    }
    double all = 0;
    for (int i = 0; i < SIZES; i++) {
        const double towards = -(ways[i][0] * normal[0] + ways[i][1] * normal[1] + ways[i][2] * normal[2]);
        fluxes[i] = density[i] * step * fmax(towards, 0);
        all += fluxes[i];
    }
    if (!(all > 0))
        return;
    for (int axis = 0; axis < 3; axis++)
        tick->fall[axis] = (float)(mean[axis] / length);
    tick->fall_cosine = (float)facing;
    *per_tick = all * (double)glass->def.width_m * (double)glass->def.height_m * glass->def.tick_s;
    const double stands_for = fmax(*per_tick / (GLASS_MAX_ARRIVALS - 1), 1);
    *per_tick /= stands_for;
    glass_fill_sizes(diameters, fluxes, SIZES, stands_for, tick->sizes_m);
}

/* Splits the drops into classes of equal number. A class has the diameter of the mean volume of its drops. */
void glass_fill_sizes(const double *diameters, const double *fluxes, uint32_t count, double stands_for,
                      float sizes_m[VIRGA_GLASS_SIZES])
{
    double all = 0, water[VIRGA_GLASS_SIZES] = {0}, passed = 0;
    for (uint32_t i = 0; i < count; i++)
        all += fluxes[i];
    const double share = all / VIRGA_GLASS_SIZES;
    for (uint32_t i = 0; i < count; i++) {
        double left = fluxes[i];
        while (left > 1e-12 * all) {
            const uint32_t class_index = (uint32_t)fmin(passed / share, VIRGA_GLASS_SIZES - 1);
            const double room = class_index == VIRGA_GLASS_SIZES - 1 ? left : (class_index + 1) * share - passed;
            const double part = fmax(fmin(left, room), 1e-12 * all);
            water[class_index] += part * diameters[i] * diameters[i] * diameters[i];
            passed += part;
            left -= part;
        }
    }
    for (uint32_t i = 0; i < VIRGA_GLASS_SIZES; i++)
        sizes_m[i] = (float)cbrt(stands_for * water[i] / share);
}

/* ---- the uniforms of a tick */

static void fill_holding(const virga_glass *glass, virga_glass_tick_gpu *out)
{
    const virga_glass_settings *s = &glass->settings;
    const double angle = glass_rest_deg(s) * PI / 180, cap = glass_cap_volume(glass_rest_deg(s));
    out->drop_nl_of_m3 = (float)(cap * 1e12);
    out->hold = (float)glass_hold(s);
    out->drag = (float)glass_drag(s);
    out->kinetic_hold = s->kinetic_hold;
    /* The cross-section of a cap is a circle segment: a^2 (t - sin t cos t) / sin^2 t. */
    const double section = (angle - sin(angle) * cos(angle)) / (sin(angle) * sin(angle));
    out->air_drag = (float)(0.5 * VIRGA_AIR_DENSITY * DRAG_OF_SPHERE * section);
    out->air_share = s->air_share;
    out->affinity_sigma = s->affinity;
    out->meander = s->meander;
    out->path_ease = s->path_ease;
    out->path_dry_s = s->path_dry_s;
    /* Bases meet as wide as they are seen. Radii of a tick are those of drops that move. */
    out->merge_distance = s->merge_distance * (float)cbrt(cap / glass_cap_volume(glass_seen_deg(s)));
    out->tail_spacing_m = s->tail_spacing_m;
    out->tail_share = TAIL_SHARE;
    out->tail_max_radius_m = s->tail_max_radius_mm * 1e-3f;
    /* The largest tail drop disappears in tail_lifetime_s while the shape of its base stays the same. The rate is
     * volume / base area / time. */
    out->shrink_nl_s = (float)(cap / PI * (double)s->tail_max_radius_mm * 1e-3 * 1e12 / (double)s->tail_lifetime_s * 3);
    out->trail_m = (float)((double)s->film_um * 1e-6 * pow(FILM_M_S, -2.0 / 3));
    out->left_from_m_s = (float)glass_film_from(s);
    out->evaporation_m_s = s->evaporation_mm_h * 1e-3f / 3600;
    out->mist_nl = (float)(PI / 6 * pow((double)s->mist_max_mm * 1e-3, 3) * 1e12);
    out->cells_per_tick = ROUNDS;
}

/* The min radius of drops that run on this pane in its current pose and motion. The adhesion grows with the radius, the
 * weight along the pane with its cube. The threshold of section 4.6 must not be smaller than this radius. Otherwise a
 * drop that holds particles back may never start to run. */
static double running_radius(const virga_glass *glass, const virga_glass_tick_gpu *tick)
{
    const float *n = glass->normals[VIRGA_GLASS_NODES * VIRGA_GLASS_NODES / 2];
    double across = 0, along = 0;
    for (int axis = 0; axis < 3; axis++)
        across += (double)tick->force[axis] * (double)n[axis];
    for (int axis = 0; axis < 3; axis++) {
        const double part = (double)tick->force[axis] - across * (double)n[axis];
        along += part * part;
    }
    const double weight = VIRGA_WATER_DENSITY * sqrt(along) * glass_cap_volume(glass_rest_deg(&glass->settings));
    return weight > 0 ? sqrt((double)tick->hold / weight) : INFINITY;
}

void glass_fill_grid(const virga_glass *glass, virga_glass_tick_gpu *out)
{
    const float particle_m = (float)((double)glass->settings.particle_radius_mm * 1e-3);
    const float min = glass_min_grid_m(&glass->def);
    out->grid_m = 2.5f * particle_m > min ? 2.5f * particle_m : min;
    out->grid_columns = (uint32_t)ceil((double)glass->def.width_m / (double)out->grid_m - 1e-4);
    out->grid_rows = (uint32_t)ceil((double)glass->def.height_m / (double)out->grid_m - 1e-4);
    out->grid_columns += !out->grid_columns;
    out->grid_rows += !out->grid_rows;
}

/* Water in front of a blade is one body, a ridge, and a ridge is at most as thick as a puddle:
 * e = 2 sqrt(sigma / (rho g)) sin(angle / 2), with the contact angle (de Gennes, Brochard-Wyart and Quere, Capillarity
 * and Wetting Phenomena, 2004, section 2.2). Particles of radius r have 2 pi r^3 / 3 of water each, so so thick a ridge
 * has 3 e / (2 pi r^3) of them per area, and 6 e / r in a circle with a radius of 2 r: these overlap the one in its
 * middle. With more of them the particles are denser than water can be before a blade. Never fewer than two rings of
 * close neighbours: those are only being pushed apart. */
static uint32_t crowd_of(const virga_glass *glass, double particle_m)
{
    const double angle = glass_rest_deg(&glass->settings) * PI / 180;
    const double thick = 2 * sqrt(VIRGA_SURFACE_TENSION / (VIRGA_WATER_DENSITY * VIRGA_GRAVITY)) * sin(angle / 2);
    return (uint32_t)fmax(6 * thick / particle_m, MIN_CROWD);
}

static void fill_particles(const virga_glass *glass, virga_glass_tick_gpu *out)
{
    const virga_glass_settings *s = &glass->settings;
    const double cap = glass_cap_volume(glass_rest_deg(s));
    const double particle = (double)s->particle_radius_mm * 1e-3;
    const double hold_back = fmax((double)s->hold_back_mm * 1e-3, HOLD_BACK * running_radius(glass, out));
    out->particle_m = (float)particle;
    /* The volume of a hemisphere on every kind of glass: water in front of a blade is higher than a drop at rest. */
    out->particle_nl = (uint32_t)fmax(2 * PI / 3 * particle * particle * particle * 1e12, 1);
    out->penalty = s->penalty;
    out->crowd = crowd_of(glass, particle);
    out->band_m = (float)((double)s->particle_band * 2 * particle);
    out->hold_back_nl = (uint32_t)fmin(cap * hold_back * hold_back * hold_back * 1e12, 4e9);
    out->hold_back_cells = s->hold_back_cells;
    glass_fill_grid(glass, out);
}

/* Air that meets the outside of the pane at its middle spreads along it. Returns the speed at the middle of an edge. */
static double fill_air(const virga_glass *glass, const double air[3], virga_glass_tick_gpu *out)
{
    const float *n = glass->normals[VIRGA_GLASS_NODES * VIRGA_GLASS_NODES / 2];
    double meets = 0;
    for (int axis = 0; axis < 3; axis++)
        meets -= air[axis] * (double)n[axis];
    const double at_edge = fmax(meets, 0) * (double)glass->settings.air_outward;
    store(air, out->air);
    out->air_outward[0] = (float)(at_edge / (0.5 * (double)glass->def.width_m));
    out->air_outward[1] = (float)(at_edge / (0.5 * (double)glass->def.height_m));
    return at_edge;
}

static void fill_motion(const virga_glass *glass, const virga_glass_step_info *info, virga_glass_tick_gpu *out)
{
    const double gravity[3] = {-(double)info->acceleration_m_s2[0], -VIRGA_GRAVITY - (double)info->acceleration_m_s2[1],
                               -(double)info->acceleration_m_s2[2]};
    const double turn[3] = {(double)info->angular_velocity_rad_s[0], (double)info->angular_velocity_rad_s[1],
                            (double)info->angular_velocity_rad_s[2]};
    double air[3], local[3];
    for (int i = 0; i < 3; i++)
        air[i] = (double)info->wind_m_s[i] - (double)info->velocity_m_s[i];
    to_pane(info, gravity, local);
    store(local, out->force);
    to_pane(info, turn, local);
    store(local, out->spin);
    to_pane(info, air, local);
    const double at_corner = sqrt(2) * fill_air(glass, local, out);
    /* The max acceleration anywhere on the pane. The centrifugal part grows with the distance from the axis. */
    const double spin = length_of(turn);
    out->max_acceleration = (float)(1.01 * (length_of(gravity) + spin * spin * (double)glass->farthest_m));
    out->max_air_m_s = (float)(1.01 * (length_of(air) + at_corner) * (double)glass->settings.air_share);
    out->pane = glass_describe_pane(glass);
}

static void push_tick(virga_glass *glass, const virga_glass_step_info *info, const virga_glass_tick_gpu *common,
                      double arrivals, uint32_t i)
{
    virga_glass_tick_gpu *out = &glass->blades;
    *out = *common;
    out->tick = info->first_tick + i;
    out->tick_in_step = i;
    out->tick_s = (float)glass->def.tick_s;
    out->arrivals = (uint32_t)(arrivals + (double)virga_unit(virga_hash3(glass->def.seed, out->tick, 0x61727269u)));
    const uint32_t share = (glass->rows + DRY_SHARE - 1) / DRY_SHARE, turn = out->tick % DRY_SHARE;
    out->rolling_row = turn * share;
    out->rolling_rows = out->rolling_row >= glass->rows          ? 0
                        : out->rolling_row + share > glass->rows ? glass->rows - out->rolling_row
                                                                 : share;
    out->rolling_s = (float)(DRY_SHARE * glass->def.tick_s);
    glass_fill_sites(glass, out);
    glass_fill_fog(glass, out);
    glass_fill_blades(glass, (out->tick - 1.0) * glass->def.tick_s, out->tick * glass->def.tick_s,
                      (double)i / info->ticks, (i + 1.0) / info->ticks, out);
    glass->tick_offset = virga_ring_push(glass->base.context, &glass->tick_ring, out, sizeof *out);
}

/* ---- passes */

static void bind(virga_glass *glass, VkCommandBuffer cmd)
{
    virga_bind(glass->base.context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, glass->bindings, glass->step_set, 1,
               &glass->tick_offset);
}

/* Dispatches over the list of slots in use, or over all seeds. An earlier pass wrote the group count at `groups`. */
static void over(virga_glass *glass, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t groups)
{
    virga_dispatch_indirect_and_barrier(glass->base.context, cmd, pipeline, glass->state->buffer, groups);
}

static void push(virga_glass *glass, VkCommandBuffer cmd, const uint32_t *constants, uint32_t count)
{
    glass->base.context->vk.CmdPushConstants(cmd, glass->bindings->layout, VIRGA_ALL_STAGES, 0,
                                             count * sizeof *constants, constants);
}

#define LIVE_LIST offsetof(virga_glass_state_gpu, live_list_groups)
#define ALIVE     offsetof(virga_glass_state_gpu, alive_groups)
#define SEEDS     offsetof(virga_glass_state_gpu, seed_groups)
#define ACTIVE    offsetof(virga_glass_state_gpu, active_groups)
#define PARTICLES offsetof(virga_glass_state_gpu, particle_groups)

static uint32_t groups_of(uint64_t invocations)
{
    return (uint32_t)((invocations + VIRGA_GLASS_GROUP - 1) / VIRGA_GLASS_GROUP);
}

/* Up to so many slots, a GPU moves the drops in one workgroup. With more, its loop over them would take longer than the
 * waits between rounds that it saves: an estimate from the latency of loads, not measured. */
#define MAX_ONE_WORKGROUP_DROPS (16 * VIRGA_GLASS_GROUP)

static void record_rounds(virga_glass *glass, VkCommandBuffer cmd)
{
    if (!glass->base.context->for_software && glass->def.max_drops <= MAX_ONE_WORKGROUP_DROPS) {
        virga_dispatch_and_barrier(glass->base.context, cmd, glass->move_drops, 1);
        return;
    }
    for (uint32_t i = 0; i <= ROUNDS; i++) {
        const uint32_t round[2] = {i, ROUNDS};
        push(glass, cmd, round, 2);
        const size_t groups_of_round = offsetof(virga_glass_state_gpu, round_groups) + i * 3 * sizeof(uint32_t);
        over(glass, cmd, glass->choose_cell, i < ROUNDS ? groups_of_round : ACTIVE);
        if (i < ROUNDS)
            over(glass, cmd, glass->enter_cell, groups_of_round);
    }
}

/* The list of what a pass over `groups` marked. On a GPU the pass that writes it adds up, too: it writes sizes of
 * dispatches, also for an empty list, so it is as long as the longest list. */
static void record_list(virga_glass *glass, VkCommandBuffer cmd, const virga_pipeline *scan,
                        const virga_pipeline *compact, size_t groups)
{
    if (glass->base.context->for_software) {
        virga_dispatch_and_barrier(glass->base.context, cmd, scan, 1);
        over(glass, cmd, compact, groups);
    } else
        virga_dispatch_and_barrier(glass->base.context, cmd, compact, groups_of(glass->def.max_drops));
}

/* The mesh model: section 4.1. */
static void record_motion(virga_glass *glass, VkCommandBuffer cmd)
{
    const virga_pass_scope scope = virga_pass_begin(glass->base.context, cmd, "glass.motion");
    over(glass, cmd, glass->live_mark, LIVE_LIST);
    record_list(glass, cmd, glass->live_scan, glass->live_compact, LIVE_LIST);
    over(glass, cmd, glass->begin_tick, ALIVE);
    record_list(glass, cmd, glass->active_scan, glass->active_compact, ALIVE);
    record_rounds(glass, cmd);
    /* On a GPU several invocations share a slot, and those of all live slots are enough. */
    over(glass, cmd, glass->capture_mark, glass->base.context->for_software ? ACTIVE : ALIVE);
    over(glass, cmd, glass->capture, ALIVE);
    virga_pass_end(glass->base.context, cmd, scope);
}

/* Bounds, in cells, of the area that a blade sweeps in a tick. */
static bool blade_bounds(const virga_glass *glass, const virga_glass_blade_gpu *blade, uint32_t box[4])
{
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    for (int i = 0; i < 8; i++) {
        const float *middle = i & 4 ? blade->middle : blade->before_middle;
        const float *along = i & 4 ? blade->along : blade->before_along;
        const double y = (double)(i & 1 ? blade->half_length_m : -blade->half_length_m);
        const double x = (double)(i & 2 ? blade->half_width_m : -blade->half_width_m);
        const double corner[2] = {(double)middle[0] + y * (double)along[0] - x * (double)along[1],
                                  (double)middle[1] + y * (double)along[1] + x * (double)along[0]};
        for (int axis = 0; axis < 2; axis++) {
            low[axis] = fmin(low[axis], corner[axis]);
            high[axis] = fmax(high[axis], corner[axis]);
        }
    }
    /* The tip of the blade moves on an arc. In one tick the arc extends beyond the bounds of the two poses by a
     * negligible distance. */
    const uint32_t size[2] = {glass->columns, glass->rows};
    for (int axis = 0; axis < 2; axis++) {
        const double first = fmax(floor(low[axis] / (double)glass->def.cell_m) - 1, 0);
        const double last = fmin(floor(high[axis] / (double)glass->def.cell_m) + 1, size[axis] - 1.0);
        if (last < first)
            return false;
        box[axis] = (uint32_t)first;
        box[2 + axis] = (uint32_t)(last - first) + 1;
    }
    return true;
}

/* Blades and particles: sections 4.2 to 4.6. */
static void record_wipers(virga_glass *glass, VkCommandBuffer cmd)
{
    if (!glass->particles_ever)
        return;
    virga_pass_scope scope = virga_pass_begin(glass->base.context, cmd, "glass.wipe");
    for (uint32_t i = 0; i < glass->blades.blade_count; i++) {
        uint32_t constants[5] = {i};
        if (glass->blades.blades[i].side == 0 || !blade_bounds(glass, &glass->blades.blades[i], constants + 1))
            continue;
        push(glass, cmd, constants, 5);
        const uint32_t groups[2] = {(constants[3] + 15) / 16, (constants[4] + 15) / 16};
        virga_dispatch_2d(glass->base.context, cmd, glass->wipe_film, groups[0], groups[1]);
        virga_compute_barrier(glass->base.context, cmd);
        if (glass->blades.fog_side == VIRGA_GLASS_FOG_OUTSIDE) {
            virga_dispatch_2d(glass->base.context, cmd, glass->fog_wipe, groups[0], groups[1]);
            virga_compute_barrier(glass->base.context, cmd);
        }
        virga_dispatch_2d(glass->base.context, cmd, glass->lay_film, groups[0], groups[1]);
        virga_indirect_barrier(glass->base.context, cmd);
    }
    over(glass, cmd, glass->split_drops, ACTIVE);
    virga_dispatch_and_barrier(glass->base.context, cmd, glass->empty_bins,
                               groups_of((uint64_t)glass->blades.blade_count * VIRGA_GLASS_BINS));
    virga_pass_end(glass->base.context, cmd, scope);
    scope = virga_pass_begin(glass->base.context, cmd, "glass.particles");
    over(glass, cmd, glass->particle_grid, PARTICLES);
    over(glass, cmd, glass->particle_starts, PARTICLES);
    over(glass, cmd, glass->particle_sort, PARTICLES);
    for (uint32_t i = 0; i < VIRGA_GLASS_RELAX_ROUNDS; i++) {
        push(glass, cmd, &i, 1);
        over(glass, cmd, glass->push_particles, PARTICLES);
    }
    over(glass, cmd, glass->merge_particles, PARTICLES);
    over(glass, cmd, glass->to_drops_claim, PARTICLES);
    over(glass, cmd, glass->to_drops, PARTICLES);
    virga_pass_end(glass->base.context, cmd, scope);
}

static void record_spawns(virga_glass *glass, VkCommandBuffer cmd)
{
    virga_context *context = glass->base.context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "glass.spawn");
    glass_record_break(glass, cmd);
    glass_record_fog_grow(glass, cmd);
    over(glass, cmd, glass->spawn_claim, SEEDS);
    virga_dispatch_and_barrier(context, cmd, glass->spawn_scan, 1);
    over(glass, cmd, glass->spawn, SEEDS);
    /* What follows has nothing to do with each other. */
    virga_dispatch_indirect(context, cmd, glass->end_tick, glass->state->buffer,
                            offsetof(virga_glass_state_gpu, settle_groups));
    if (glass->blades.rolling_rows)
        virga_dispatch(context, cmd, glass->dry_film, groups_of((uint64_t)glass->blades.rolling_rows * glass->columns));
    virga_indirect_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
}

/* Workgroups of the pass that measures, over all blocks of cells, all slots, and the bins of the blades. */
static uint32_t measure_groups(const virga_glass *glass)
{
    const uint32_t blocks = virga_groups_of(glass_film_blocks(&glass->def), VIRGA_GLASS_BLOCKS_PER_GROUP);
    const uint32_t drops = glass->def.max_drops, bins = VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS;
    const uint32_t slots = groups_of(drops > bins ? drops : bins);
    return blocks > slots ? blocks : slots;
}

/* Sums the water, whose counters the last tick has cleared. On a GPU workgroups that have nothing to sum take less time
 * than a pass that finds out which have. */
static void record_measure(virga_glass *glass, VkCommandBuffer cmd)
{
    virga_context *context = glass->base.context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "glass.measure");
    if (context->for_software) {
        virga_dispatch_and_barrier(context, cmd, glass->film_compact, groups_of(glass_film_blocks(&glass->def)));
        over(glass, cmd, glass->measure, offsetof(virga_glass_state_gpu, measure_groups));
    } else
        virga_dispatch_and_barrier(context, cmd, glass->measure, measure_groups(glass));
    virga_pass_end(context, cmd, scope);
}

/* ---- a step */

static void upload_shape(virga_glass *glass, VkCommandBuffer cmd)
{
    virga_context *context = glass->base.context;
    if (!glass->surface_upload)
        return;
    const VkBufferCopy cells = {0, 0, glass->surface->size}, nodes = {0, 0, glass->nodes->size};
    context->vk.CmdCopyBuffer(cmd, glass->surface_upload->buffer, glass->surface->buffer, 1, &cells);
    context->vk.CmdCopyBuffer(cmd, glass->nodes_upload->buffer, glass->nodes->buffer, 1, &nodes);
    virga_wait(context, cmd, VIRGA_COPIES, VIRGA_PASSES | VIRGA_VERTICES);
    virga_effect_uploaded(&glass->base, &glass->surface_upload);
    glass->shape_count++;
    virga_effect_uploaded(&glass->base, &glass->nodes_upload);
}

bool glass_first_contents(virga_glass *glass, VkCommandBuffer cmd)
{
    if (!virga_effect_first_contents(&glass->base, cmd))
        return false;
    glass_picture_forget(glass); /* the images may have lost their contents */
    upload_shape(glass, cmd);
    return true;
}

static virga_result check_step(const virga_glass *glass, VkCommandBuffer cmd, const virga_glass_step_info *info)
{
    if (!glass)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &glass->base.context->log;
    const virga_result result = virga_effect_check_one_step(&glass->base, "virga_glass_step", cmd, info);
    if (result)
        return result;
    const virga_tick_range ticks = {info->first_tick, info->ticks, glass->def.max_ticks_per_step};
    if (virga_effect_check_ticks(&glass->base, &ticks, glass->ticks ? &glass->last_tick : NULL) ||
        glass_axes_check(log, "step_info.world_from_pane", info->world_from_pane) ||
        virga_settings_check_finite(log, "step_info.velocity_m_s", info->velocity_m_s, 3) ||
        virga_settings_check_finite(log, "step_info.acceleration_m_s2", info->acceleration_m_s2, 3) ||
        virga_settings_check_finite(log, "step_info.angular_velocity_rad_s", info->angular_velocity_rad_s, 3) ||
        virga_settings_check_finite(log, "step_info.wind_m_s", info->wind_m_s, 3) ||
        virga_host_buffer_check(glass->base.context, "step_info.impacts", info->impacts))
        return VIRGA_ERROR_INVALID;
    if (!(info->rate_mm_h >= 0 && info->rate_mm_h <= 200))
        return virga_wrong_argument(log, "step_info.rate_mm_h: expected 0 to 200, got %g", (double)info->rate_mm_h);
    if (!(info->air_density >= 0 && info->air_density <= 100))
        return virga_wrong_argument(log, "step_info.air_density: expected 0 to 100, got %g", (double)info->air_density);
    if (glass_check_water(glass, info))
        return VIRGA_ERROR_INVALID;
    if (info->sizes && info->sizes->kind != VIRGA_SIZES_MARSHALL_PALMER && info->sizes->kind != VIRGA_SIZES_BEST &&
        virga_sizes_densities(info->sizes, 1, (double)info->air_density, 0, NULL, NULL))
        return virga_wrong_argument(log, "step_info.sizes: expected Marshall-Palmer, Best, or a table of 2 to 256 "
                                         "rising diameters with numbers >= 0");
    return virga_effect_ready(&glass->base);
}

/* Clamps the motion of the pane and of the air to the valid ranges. Returns whether a value changed. */
static bool clamp_motion(const virga_log *log, virga_glass_step_info *info)
{
    bool changed = false;
    virga_clamp_vector(log, "step_info.velocity_m_s", info->velocity_m_s, VIRGA_MAX_SPEED_M_S, &changed);
    virga_clamp_vector(log, "step_info.acceleration_m_s2", info->acceleration_m_s2, VIRGA_MAX_ACCELERATION_M_S2,
                       &changed);
    virga_clamp_vector(log, "step_info.angular_velocity_rad_s", info->angular_velocity_rad_s,
                       VIRGA_MAX_ANGULAR_SPEED_RAD_S, &changed);
    virga_clamp_vector(log, "step_info.wind_m_s", info->wind_m_s, VIRGA_MAX_SPEED_M_S, &changed);
    return changed;
}

static void record_ticks(virga_glass *glass, VkCommandBuffer cmd, const virga_glass_step_info *info)
{
    virga_glass_tick_gpu common = {.impacts = info->impacts ? GLASS_MAX_IMPACTS : 0};
    double arrivals;
    fill_motion(glass, info, &common);
    fill_holding(glass, &common);
    fill_particles(glass, &common);
    glass_fill_water(glass, info, &common);
    landing_of(glass, info, &common, &arrivals);
    glass->particles_ever = glass->particles_ever || glass->settings.wiper_count;
    for (uint32_t i = 0; i < info->ticks; i++) {
        push_tick(glass, info, &common, arrivals, i);
        if (!i)
            glass_record_flood(glass, cmd);
        bind(glass, cmd);
        glass_record_fog_begin(glass, cmd);
        record_motion(glass, cmd);
        record_wipers(glass, cmd);
        record_spawns(glass, cmd);
        glass_record_fog_take(glass, cmd);
    }
    glass_record_recede(glass, cmd);
    glass->ticks += info->ticks;
    glass->last_tick = info->first_tick + info->ticks - 1;
    for (uint32_t i = 0; i < VIRGA_GLASS_MAX_WIPERS; i++)
        glass->host_deg[i] = (double)glass->settings.wipers[i].host_deg;
    glass->host_known = true;
    record_measure(glass, cmd);
}

virga_result virga_glass_step(virga_glass *glass, VkCommandBuffer cmd, const virga_glass_step_info *given)
{
    const virga_result result = check_step(glass, cmd, given);
    if (result)
        return result;
    virga_context *context = glass->base.context;
    virga_glass_step_info checked = *given;
    const virga_glass_step_info *info = &checked;
    const bool changed = clamp_motion(&context->log, &checked);
    virga_effect_begin_step(&glass->base, cmd);
    glass_write_sets(glass, info);
    if (!glass_first_contents(glass, cmd))
        upload_shape(glass, cmd);
    virga_effect_reads(&glass->base, cmd, info->impacts);
    virga_effect_reads(&glass->base, cmd, info->water_count ? info->water : VK_NULL_HANDLE);
    if (info->ticks)
        record_ticks(glass, cmd, info);
    virga_effect_copy_statistics(&glass->base, cmd, GLASS_PART_STEP, glass->state, 0, offsetof(glass_readback, state),
                                 sizeof(virga_glass_state_gpu));
    const virga_result uploaded = virga_recording_result(context);
    return uploaded ? uploaded : changed ? VIRGA_DEGRADED : VIRGA_OK;
}
