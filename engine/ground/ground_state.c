/* ground/ground_state.c - checks a saved state of the ground, see gpu/state_check.h. */
#include "ground/ground_internal.h"

#include "core/settings.h"
#include "gpu/state_check.h"

/* A tile is in the cache if it has left the window. The cache has twice the tiles of the window, so there is a free
 * slot in each move, as long as no tile claims to be wanted or to have left in a move that has not been. */
static void check_cache(const virga_ground *ground, virga_state_check *check)
{
    const ground_cached_tile *cache = virga_state_saved_row(check, ground->window.cache);
    const double moves = (double)VIRGA_STATE_SAVED(check, ground->window.moves);
    uint32_t cached = 0;
    for (uint32_t i = 0; i < ground->window.cache_capacity && !check->failed; i++) {
        virga_state_expect(check, "ground.window.cache.since", (double)cache[i].since, 0, moves);
        virga_state_expect(check, "ground.window.cache.wanted", *(const unsigned char *)&cache[i].wanted, 0, 0);
        cached += cache[i].since > 0;
    }
    virga_state_expect(check, "ground.window.cached_count", VIRGA_STATE_SAVED(check, ground->window.cached_count),
                       cached, cached);
}

static void expect_material(virga_state_check *check, const char *name, uint32_t material)
{
    if (material != GROUND_NO_MATERIAL)
        virga_state_expect(check, name, material, 0, VIRGA_GROUND_MATERIALS - 1);
}

/* What was not placed yet is made anew. */
static void check_floors(const virga_ground *ground, virga_state_check *check)
{
    const virga_floor_gpu *floors = virga_state_saved_buffer(check, ground->floors);
    const virga_far_floor_gpu *far = virga_state_saved_buffer(check, ground->far.floors);
    const uint32_t cells = ground->def.cells * ground->def.cells, far_cells = ground->def.far_cells;
    for (uint32_t i = 0; VIRGA_STATE_SAVED(check, ground->window.is_placed) && i < cells && !check->failed; i++)
        expect_material(check, "ground.floors.material", floors[i].material);
    for (uint32_t i = 0; VIRGA_STATE_SAVED(check, ground->far.is_placed) && i < far_cells * far_cells && !check->failed;
         i++)
        expect_material(check, "ground.far_floors.traits & 255", far[i].traits & 255);
}

static void check_window(const virga_ground *ground, virga_state_check *check)
{
    const int32_t *low = VIRGA_STATE_SAVED(check, ground->window.low), *far = VIRGA_STATE_SAVED(check, ground->far.low);
    const double *ripples_m = VIRGA_STATE_SAVED(check, ground->ripple_low_m);
    /* Cell numbers must fit into an int, as in ground_window_wanted and ground_far_follow. */
    const double max = INT32_MAX / VIRGA_GROUND_TILE - 2.0 * ground->window.tiles, max_far = INT32_MAX / 2.0;
    for (uint32_t axis = 0; axis < 2; axis++) {
        virga_state_expect(check, "ground.window.low", low[axis], -max - ground->window.tiles, max);
        virga_state_expect(check, "ground.far.low", far[axis], -max_far, max_far);
        virga_state_expect(check, "ground.ripple_low_m", ripples_m[axis], -2 * VIRGA_MAX_COORDINATE_M,
                           2 * VIRGA_MAX_COORDINATE_M);
    }
    virga_state_expect(check, "ground.base_m", VIRGA_STATE_SAVED(check, ground->base_m), -2 * VIRGA_MAX_COORDINATE_M,
                       2 * VIRGA_MAX_COORDINATE_M);
}

void ground_check_state(const void *object, virga_state_check *check)
{
    const virga_ground *ground = object;
    const ground_standing *standing = VIRGA_STATE_SAVED(check, ground->standing);
    virga_state_expect(check, "ground.ticks", (double)VIRGA_STATE_SAVED(check, ground->ticks), 0,
                       VIRGA_STATE_MAX_TICKS);
    virga_state_expect(check, "ground.window.moves", (double)VIRGA_STATE_SAVED(check, ground->window.moves), 0,
                       VIRGA_STATE_MAX_TICKS);
    for (uint32_t i = 0; i < GROUND_STANDING; i++) {
        virga_state_expect(check, "ground.standing.held_nl", standing[i].held_nl, 0, VIRGA_STATE_MAX_NUMBER);
        virga_state_expect(check, "ground.standing.film_nl", standing[i].film_nl, 0, VIRGA_STATE_MAX_NUMBER);
        virga_state_expect(check, "ground.standing.level_um", standing[i].level_um, 0, VIRGA_STATE_MAX_NUMBER);
        virga_state_expect(check, "ground.standing.spots", standing[i].spots, 0, VIRGA_STATE_MAX_NUMBER);
    }
    check_window(ground, check);
    check_cache(ground, check);
    check_floors(ground, check);
}
