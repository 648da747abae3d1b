/* glass/glass_state.c - checks a saved state of a pane, see gpu/state_check.h. */
#include "glass/glass_internal.h"

#include "gpu/state_check.h"

#define OUTSIDE (VIRGA_GLASS_NONE - 1) /* see shaders/glass/step/pane.glsl */

static double groups_of(double invocations)
{
    return invocations / VIRGA_GLASS_SMALL_GROUP + 1;
}

static void check_counts(const virga_glass *glass, const virga_glass_state_gpu *saved, virga_state_check *check)
{
    const double slots = glass->def.max_drops;
    virga_state_expect(check, "glass.state.alive", saved->alive, 0, slots);
    virga_state_expect(check, "glass.state.free", saved->free, 0, slots);
    virga_state_expect(check, "glass.state.spawned", saved->spawned, 0, slots);
    virga_state_expect(check, "glass.state.active_count", saved->active_count, 0, slots);
    virga_state_expect(check, "glass.state.active_particles", saved->active_particles, 0, slots);
    virga_state_expect(check, "glass.state.impacts", saved->impacts, 0, GLASS_MAX_IMPACTS);
    virga_state_expect(check, "glass.state.shown", saved->shown, 0, slots);
    virga_state_expect(check, "glass.state.film_blocks", saved->film_blocks, 0, (double)glass_film_blocks(&glass->def));
    virga_state_expect(check, "glass.state.free_listed", saved->free_listed, 0, slots);
}

static void check_groups(const virga_glass *glass, const virga_glass_state_gpu *saved, virga_state_check *check)
{
    const double slots = glass->def.max_drops, blocks = (double)glass_film_blocks(&glass->def);
    const double seeds = GLASS_MAX_ARRIVALS + GLASS_MAX_IMPACTS + slots + VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS +
                         glass_max_sites(&glass->def) + glass_fog_sites(&glass->def);
    virga_state_expect_groups(check, "glass.state.alive_groups", saved->alive_groups, groups_of(slots));
    virga_state_expect_groups(check, "glass.state.seed_groups", saved->seed_groups, groups_of(seeds));
    virga_state_expect_groups(check, "glass.state.active_groups", saved->active_groups, groups_of(slots));
    virga_state_expect_groups(check, "glass.state.particle_groups", saved->particle_groups, groups_of(slots));
    virga_state_expect_groups(check, "glass.state.settle_groups", saved->settle_groups, groups_of(seeds));
    for (uint32_t i = 0; i < VIRGA_GLASS_ROUNDS; i++)
        virga_state_expect_groups(check, "glass.state.round_groups", saved->round_groups + 3 * i, groups_of(slots));
    virga_state_expect_groups(check, "glass.state.shown_groups", saved->shown_groups, groups_of(slots));
    virga_state_expect_groups(check, "glass.state.measure_groups", saved->measure_groups, groups_of(slots) + blocks);
    virga_state_expect_groups(check, "glass.state.live_list_groups", saved->live_list_groups,
                              slots / VIRGA_GLASS_GROUP);
}

/* A cell, or one of the numbers that are none. */
static void expect_cell(virga_state_check *check, const char *name, uint32_t cell, double cells)
{
    if (cell < OUTSIDE)
        virga_state_expect(check, name, cell, 0, cells - 1);
}

/* Free slots are not read before they are written. A particle's cell is one of the grid of particles. */
static void check_drops(const virga_glass *glass, double cells, virga_state_check *check)
{
    const virga_glass_drop_gpu *drops = virga_state_saved_buffer(check, glass->drops);
    for (uint32_t i = 0; i < glass->def.max_drops && !check->failed; i++) {
        const uint32_t kind = drops[i].kind & VIRGA_GLASS_KIND;
        if (kind == VIRGA_GLASS_FREE)
            continue;
        virga_state_expect(check, "glass.drops.kind", kind, VIRGA_GLASS_DROP, VIRGA_GLASS_PARTICLE);
        if (kind == VIRGA_GLASS_DROP)
            virga_state_expect(check, "glass.drops.cell", drops[i].cell, 0, cells - 1);
        expect_cell(check, "glass.drops.from_cell", drops[i].from_cell, cells);
        expect_cell(check, "glass.drops.target", drops[i].target, cells);
        if (drops[i].absorbed_by != VIRGA_GLASS_NONE)
            virga_state_expect(check, "glass.drops.absorbed_by", drops[i].absorbed_by, 0, glass->def.max_drops - 1.0);
    }
}

static void check_cells(const virga_glass *glass, uint32_t cells, virga_state_check *check)
{
    const uint32_t *occupants = virga_state_saved_buffer(check, glass->occupants);
    const uint32_t *blocks = virga_state_saved_buffer(check, glass->film_blocks);
    const uint32_t block_count = (uint32_t)glass_film_blocks(&glass->def);
    for (uint32_t i = 0; i < cells && !check->failed; i++)
        virga_state_expect(check, "glass.occupants", occupants[i], 0, glass->def.max_drops);
    /* Flags of the blocks, then the list of blocks. */
    for (uint32_t i = 0; i < block_count && !check->failed; i++)
        virga_state_expect(check, "glass.film_blocks", blocks[block_count + i], 0, block_count - 1.0);
}

void glass_check_state(const void *object, virga_state_check *check)
{
    const virga_glass *glass = object;
    const virga_glass_state_gpu *saved = virga_state_saved_buffer(check, glass->state);
    const uint32_t *listed =
        (const uint32_t *)((const virga_list_gpu *)virga_state_saved_buffer(check, glass->list) + 1);
    const uint32_t *grid = virga_state_saved_buffer(check, glass->grid);
    const uint32_t cells = glass->columns * glass->rows;
    virga_glass_tick_gpu tick;
    glass_fill_grid(glass, &tick);
    virga_state_expect(check, "glass.ticks", (double)VIRGA_STATE_SAVED(check, glass->ticks), 0, VIRGA_STATE_MAX_TICKS);
    check_counts(glass, saved, check);
    glass_check_fog_state(glass, check);
    check_groups(glass, saved, check);
    for (uint32_t i = 0; !check->failed && i < saved->shown; i++)
        virga_state_expect(check, "glass.list", listed[i], 0, glass->def.max_drops - 1.0);
    for (uint32_t i = 0; i < VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS && !check->failed; i++) {
        virga_state_expect(check, "glass.state.asked_nl", saved->asked_nl[i], 0, 0);
        virga_state_expect(check, "glass.state.given_nl", saved->given_nl[i], 0, 0);
    }
    /* Lists of particles are empty between ticks. A list that is not may have no end. */
    for (uint32_t i = 0; i < tick.grid_columns * tick.grid_rows && !check->failed; i++)
        virga_state_expect(check, "glass.grid", grid[i], 0, 0);
    check_drops(glass, cells, check);
    check_cells(glass, cells, check);
}
