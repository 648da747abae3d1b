/* rain/rain_state.c - checks a saved state of the rain, see gpu/state_check.h. */
#include "rain/rain_internal.h"

#include "core/settings.h"
#include "gpu/state_check.h"

#include <virga/shared/impact.h>

#define MAX_TRAVEL 1e18 /* in units of virga_class_gpu: so that a sum with a position fits into 64 bits */
#define MAX_KNOTS  1e15 /* of the gust noise */

static void expect_numbers(virga_state_check *check, const char *name, const double *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        virga_state_expect(check, name, values[i], -VIRGA_STATE_MAX_NUMBER, VIRGA_STATE_MAX_NUMBER);
}

/* What a definition decides is as in this scene. */
static void check_classes(const virga_rain *rain, virga_state_check *check)
{
    const rain_classes *saved = virga_state_saved_row(check, rain->classes), *own = rain->classes;
    virga_state_expect(check, "rain.classes.levels", saved->levels, own->levels, own->levels);
    virga_state_expect(check, "rain.classes.slots_per_level", saved->slots_per_level, own->slots_per_level,
                       own->slots_per_level);
    virga_state_expect(check, "rain.classes.side_m", saved->side_m, own->side_m, own->side_m);
    for (uint32_t level = 0; level < VIRGA_RAIN_MAX_LEVELS; level++)
        for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
            virga_state_expect(check, "rain.classes.slot_count", saved->slot_count[level][k], own->slot_count[level][k],
                               own->slot_count[level][k]);
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        const rain_class *c = &saved->classes[k];
        expect_numbers(check, "rain.classes.diameter_m", &c->diameter_m, 1);
        expect_numbers(check, "rain.classes.terminal_m_s", &c->terminal_m_s, 1);
        expect_numbers(check, "rain.classes.density_share", &c->density_share, 1);
        expect_numbers(check, "rain.classes.velocity", c->velocity, 3);
        expect_numbers(check, "rain.classes.drag", &c->drag, 1);
        for (uint32_t axis = 0; axis < 3; axis++)
            virga_state_expect(check, "rain.classes.travel", (double)c->travel[axis], -MAX_TRAVEL, MAX_TRAVEL);
    }
    expect_numbers(check, "rain.classes.per_m3", saved->per_m3, VIRGA_RAIN_CLASSES);
    expect_numbers(check, "rain.classes.per_m3_from", saved->per_m3_from, VIRGA_RAIN_CLASSES);
    expect_numbers(check, "rain.classes.per_m3_to", saved->per_m3_to, VIRGA_RAIN_CLASSES);
    expect_numbers(check, "rain.classes.rate_mm_h", &saved->rate_mm_h, 1);
    expect_numbers(check, "rain.classes.rate_from", &saved->rate_from, 1);
    expect_numbers(check, "rain.classes.rate_to", &saved->rate_to, 1);
    expect_numbers(check, "rain.classes.eased_s", &saved->eased_s, 1);
    expect_numbers(check, "rain.classes.ease_s", &saved->ease_s, 1);
}

/* Maps that are in use have a size. */
static void check_maps(const virga_rain *rain, virga_state_check *check)
{
    const rain_map *maps = VIRGA_STATE_SAVED(check, rain->maps);
    const double all = rain->def.occlusion_cascades * rain->def.occlusion_slants;
    const uint32_t count = VIRGA_STATE_SAVED(check, rain->map_count);
    virga_state_expect(check, "rain.map_count", count, count ? all : 0, all);
    expect_numbers(check, "rain.maps", (const double *)maps, sizeof rain->maps / (sizeof(double)));
    for (uint32_t i = 0; i < count && !check->failed; i++)
        virga_state_expect(check, "rain.maps.half_m", maps[i].half_m, 1e-3, VIRGA_STATE_MAX_NUMBER);
}

/* Sums of them fit into 64 bits. */
static void check_walls(const virga_rain *rain, virga_state_check *check)
{
    const rain_walls *walls = &VIRGA_STATE_SAVED(check, rain->walls);
    expect_numbers(check, "rain.walls.mm_s", walls->mm_s, VIRGA_WALL_ROWS);
    expect_numbers(check, "rain.walls.slants", walls->slants, 4);
    for (uint32_t row = 0; row < VIRGA_WALL_ROWS; row++)
        for (uint32_t i = 0; i < VIRGA_WALL_MATERIALS && !check->failed; i++) {
            const rain_wall *wall = &walls->walls[row][i];
            virga_state_expect(check, "rain.walls.pores_nl", (double)wall->pores_nl, 0, MAX_TRAVEL);
            virga_state_expect(check, "rain.walls.film_nl", (double)wall->film_nl, 0, MAX_TRAVEL);
            for (uint32_t way = 0; way < RAIN_WALL_WAYS; way++)
                virga_state_expect(check, "rain.walls.ways_nl", (double)wall->ways_nl[way], 0, MAX_TRAVEL);
        }
}

void rain_check_state(const void *object, virga_state_check *check)
{
    const virga_rain *rain = object;
    const double *origin = VIRGA_STATE_SAVED(check, rain->origin);
    const virga_impacts_gpu *impacts = virga_state_saved_buffer(check, rain->impact_buffer);
    for (uint32_t axis = 0; axis < 3; axis++)
        virga_state_expect(check, "rain.origin", origin[axis], -2 * VIRGA_MAX_COORDINATE_M, 2 * VIRGA_MAX_COORDINATE_M);
    virga_state_expect(check, "rain.wind.phase", VIRGA_STATE_SAVED(check, rain->wind).phase, -MAX_KNOTS, MAX_KNOTS);
    virga_state_expect(check, "rain.ticks", (double)VIRGA_STATE_SAVED(check, rain->ticks), 0, VIRGA_STATE_MAX_TICKS);
    virga_state_expect(check, "rain.ticks_of_step", VIRGA_STATE_SAVED(check, rain->ticks_of_step), 0,
                       rain->def.max_ticks_per_step);
    virga_state_expect(check, "rain.left_over_s", VIRGA_STATE_SAVED(check, rain->left_over_s), 0, rain->def.tick_s);
    virga_state_expect(check, "rain.impacts.count", impacts->count, 0, rain->def.max_impacts);
    virga_state_expect_groups(check, "rain.impacts.group_count", impacts->group_count,
                              rain->def.max_impacts / 64.0 + 1);
    check_classes(rain, check);
    check_maps(rain, check);
    check_walls(rain, check);
}
