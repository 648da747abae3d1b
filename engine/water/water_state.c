/* water/water_state.c - checks a saved state of water, see gpu/state_check.h. */
#include "water/water_internal.h"

#include "core/settings.h"
#include "gpu/state_check.h"

#include <virga/shared/foam.h>
#include <virga/shared/leaver.h>

/* Splash particles: their two halves, and the table in which they are found by their ids. */
static void check_leavers(const virga_water *water, virga_state_check *check)
{
    const double entries = water_table_entries(&water->def), max = water->def.max_spray;
    const virga_leavers_gpu *head = virga_state_saved_buffer(check, water->spray.splashes);
    const virga_leaver_gpu *leavers = (const virga_leaver_gpu *)(head + 1);
    const uint32_t *table = virga_state_saved_buffer(check, water->spray.table);
    virga_state_expect(check, "water.splashes.half_now", head->half_now, 0, 1);
    virga_state_expect(check, "water.splashes.max", head->max, 0, max);
    virga_state_expect(check, "water.splashes.mask", head->mask, 0, entries - 1);
    virga_state_expect(check, "water.splashes.count", head->count, 0, head->max);
    for (uint32_t i = 0; i < 2 * water->def.max_spray && !check->failed; i++)
        virga_state_expect(check, "water.splashes.pieces", leavers[i].pieces, 0, VIRGA_WATER_PIECES);
    for (uint32_t i = 0; i < 2 * entries && !check->failed; i++)
        virga_state_expect(check, "water.spray_table", table[i], 0, max);
}

static void check_counts(const virga_water *water, const virga_water_state_gpu *saved, virga_state_check *check)
{
    virga_state_expect(check, "water.state.blocks", saved->blocks, 0, water->def.max_blocks);
    virga_state_expect(check, "water.state.surfels", saved->surfels, 0, water->def.max_surfels);
    virga_state_expect(check, "water.state.splashes", saved->splashes, 0, water->def.max_spray);
    virga_state_expect(check, "water.state.droplets", saved->droplets, 0, water->def.max_droplets);
    virga_state_expect(check, "water.state.splash_half", saved->splash_half, 0, 1);
    virga_state_expect(check, "water.state.foam", saved->foam, 0, water->def.max_foam);
    virga_state_expect(check, "water.state.foam_first", saved->foam_first, 0, water->def.max_foam);
    virga_state_expect(check, "water.state.foam_vertices", saved->foam_vertices[0], 0, 6.0 * water->def.max_foam);
    virga_state_expect(check, "water.state.foam_vertices", saved->foam_vertices[1], 0, 1.0 * water->def.max_foam + 1);
    virga_state_expect_groups(check, "water.state.foam_groups", saved->foam_groups,
                              water->def.max_foam / (double)VIRGA_WATER_LANES + 1);
}

static void check_foam(const virga_water *water, virga_state_check *check)
{
    const virga_foam_gpu *foam = virga_state_saved_buffer(check, water->foam.particles);
    for (uint32_t i = 0; i < water->def.max_foam && !check->failed; i++)
        virga_state_expect(check, "water.foam.kind", foam[i].kind, 0, VIRGA_FOAM_BUBBLE);
}

void water_check_state(const void *object, virga_state_check *check)
{
    const virga_water *water = object;
    const double *origin_m = VIRGA_STATE_SAVED(check, water->origin_m);
    const uint32_t *histogram = virga_state_saved_buffer(check, water->grid.histogram);
    for (int axis = 0; axis < 3; axis++)
        virga_state_expect(check, "water.origin_m", origin_m[axis], -2 * VIRGA_MAX_COORDINATE_M,
                           2 * VIRGA_MAX_COORDINATE_M);
    virga_state_expect(check, "water.spray_style", VIRGA_STATE_SAVED(check, water->spray_style), 0,
                       VIRGA_WATER_STYLE_PHYSICAL);
    /* It is empty between searches: sums of others would place the grid anywhere. */
    for (uint32_t i = 0; i < 3 * VIRGA_GRID_BINS; i++)
        virga_state_expect(check, "water.histogram", histogram[i], 0, 0);
    check_counts(water, virga_state_saved_buffer(check, water->state), check);
    check_leavers(water, check);
    check_foam(water, check);
}
