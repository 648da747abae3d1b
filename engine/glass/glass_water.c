/* glass/glass_water.c - simulated water that strikes a pane: what is under it joins it, and where it recedes it leaves
 * a film that breaks into drops. */
#include "glass/glass_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <virga/shared/particle.h>

#include <math.h>
#include <string.h>

#define VISCOSITY    1.002e-3 /* Pa s, of water at 20 C */
#define SITE_M       0.004    /* side of the smallest site, or a cell where that is larger */
#define TURNS        16u      /* ticks in which all sites have their turn, unless there are too many */
#define MAX_SITES    10240u   /* in a tick; at least one row of the largest sites */
#define RECEDE_S     0.06     /* between particles there are gaps that close again */
#define SEARCH_STEPS 6u       /* on a bent pane */

/* ---- sites */

typedef struct site_rows {
    uint32_t cells;   /* along a side of a site */
    uint32_t columns; /* of sites, a multiple of VIRGA_GLASS_SITE_SPAN, like the rows of a tick */
    uint32_t rows;    /* of sites in a tick */
    uint32_t turns;
} site_rows;

static site_rows rows_of(const virga_glass_def *def)
{
    const uint32_t span = VIRGA_GLASS_SITE_SPAN;
    const uint32_t cells = (uint32_t)fmax(floor(SITE_M / (double)def->cell_m + 0.5), 1), large = cells * span;
    const uint32_t columns = (glass_cells_along(def->width_m, def->cell_m) + large - 1) / large;
    const uint32_t rows = (glass_cells_along(def->height_m, def->cell_m) + large - 1) / large;
    const uint32_t fair = (rows + TURNS - 1) / TURNS, room = MAX_SITES / (columns * span * span);
    const uint32_t at_once = fair < room ? fair : room ? room : 1;
    return (site_rows){cells, columns * span, at_once * span, (rows + at_once - 1) / at_once};
}

uint32_t glass_max_sites(const virga_glass_def *def)
{
    const site_rows rows = rows_of(def);
    return def->water ? rows.columns * rows.rows : 0;
}

void glass_fill_sites(const virga_glass *glass, virga_glass_tick_gpu *tick)
{
    const site_rows rows = rows_of(&glass->def);
    if (!tick->flooded)
        return;
    tick->sites = glass_max_sites(&glass->def);
    tick->site_columns = rows.columns;
    tick->first_site_row = tick->tick % rows.turns * rows.rows;
    tick->site_cells = rows.cells;
}

/* ---- the film that water leaves */

/* Landau and Levich 1942, Derjaguin 1943: a plate that is drawn out of a liquid, or a liquid that recedes from it at
 * the speed U, has a film of 0.94 l Ca^(2/3). l is the capillary length, Ca = mu U / sigma. */
static double film_at_1_m_s(void)
{
    const double length = sqrt(VIRGA_SURFACE_TENSION / (VIRGA_WATER_DENSITY * VIRGA_GRAVITY));
    return 0.94 * length * pow(VISCOSITY / VIRGA_SURFACE_TENSION, 2.0 / 3);
}

/* ---- a step */

virga_result glass_check_water(const virga_glass *glass, const virga_glass_step_info *info)
{
    const virga_context *context = glass->base.context;
    const virga_log *log = &context->log;
    if (virga_host_buffer_check(context, "step_info.water", info->water) ||
        virga_settings_check_positions(log, "step_info.water_origin_m", info->water_origin_m, 3) ||
        virga_settings_check_positions(log, "step_info.position_m", info->position_m, 3))
        return VIRGA_ERROR_INVALID;
    if (!info->water)
        return VIRGA_OK;
    if (!glass->def.water)
        return virga_wrong_argument(log, "step_info.water: expected NULL for a pane without glass_def.water");
    if (info->water_offset % context->properties.limits.minStorageBufferOffsetAlignment ||
        !(info->water_spacing_m >= 0 && info->water_spacing_m <= 10) ||
        info->water_count > context->properties.limits.maxStorageBufferRange / sizeof(virga_particle_gpu))
        return virga_wrong_argument(log, "step_info.water: expected an aligned offset, a spacing of 0 to 10 m, "
                                         "and particles that fit into a storage buffer");
    return VIRGA_OK;
}

static void fill_pose(const virga_glass *glass, const virga_glass_step_info *info, virga_glass_tick_gpu *tick)
{
    bool none = true;
    for (int i = 0; i < 9; i++)
        none = none && info->world_from_pane[i] == 0;
    for (int i = 0; i < 9; i++)
        tick->world_from_pane[i] = none ? (float)(i % 4 == 0) : info->world_from_pane[i];
    for (int axis = 0; axis < 3; axis++) {
        double velocity = 0;
        for (int k = 0; k < 3; k++)
            velocity += (double)tick->world_from_pane[3 * axis + k] * (double)info->velocity_m_s[k];
        tick->pane_velocity[axis] = (float)velocity;
        tick->water_offset[axis] = (float)(info->water_origin_m[axis] - info->position_m[axis]);
    }
    memcpy(tick->low, glass->low_m, sizeof tick->low);
    memcpy(tick->high, glass->high_m, sizeof tick->high);
}

void glass_fill_water(virga_glass *glass, const virga_glass_step_info *info, virga_glass_tick_gpu *tick)
{
    const double tick_s = glass->def.tick_s, break_s = (double)glass->settings.film_break_s;
    const uint32_t given = info->water ? info->water_count : 0;
    if (!glass->def.water)
        return;
    if (given) {
        const double rest_s = RECEDE_S + 1.5 * break_s;
        glass->flooded_until =
            info->first_tick + 2 * info->ticks + (uint32_t)ceil(rest_s / tick_s) + 2 * rows_of(&glass->def).turns;
    }
    tick->flooded = info->first_tick <= glass->flooded_until;
    tick->water_count = given;
    tick->water_spacing_m = info->water_spacing_m;
    tick->water_rounds = glass->flat ? 1 : SEARCH_STEPS;
    tick->left_m = (float)film_at_1_m_s();
    tick->recede_ticks = (uint32_t)ceil(RECEDE_S / tick_s);
    tick->break_ticks = (float)(break_s / tick_s);
    fill_pose(glass, info, tick);
}

/* ---- passes */

void glass_record_flood(virga_glass *glass, VkCommandBuffer cmd)
{
    virga_context *context = glass->base.context;
    if (!glass->blades.water_count)
        return;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "glass.flood");
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, glass->bindings, glass->water_set, 1, &glass->tick_offset);
    virga_dispatch_and_barrier(context, cmd, glass->flood,
                               (glass->blades.water_count + VIRGA_GLASS_GROUP - 1) / VIRGA_GLASS_GROUP);
    virga_pass_end(context, cmd, scope);
}

void glass_record_break(virga_glass *glass, VkCommandBuffer cmd)
{
    const uint32_t sites = glass->blades.sites;
    if (sites)
        virga_dispatch_and_barrier(glass->base.context, cmd, glass->break_film,
                                   (sites + VIRGA_GLASS_SMALL_GROUP - 1) / VIRGA_GLASS_SMALL_GROUP);
}

void glass_record_recede(virga_glass *glass, VkCommandBuffer cmd)
{
    virga_context *context = glass->base.context;
    if (!glass->blades.flooded)
        return;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "glass.recede");
    virga_dispatch_and_barrier(context, cmd, glass->recede, glass_film_blocks(&glass->def));
    virga_pass_end(context, cmd, scope);
}
