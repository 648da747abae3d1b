/* What must hold on a pane whatever happens to it: one drop to a cell, water to the nanolitre, particles beside blades
 * and not in them or in each other, nothing under a blade and nothing outside; and the same input gives the same bits.
 * */
#include "glass_fixture.h"

#include <math.h>

static glass_fixture f;

/* ---- what must hold after each step */

static void blade_local(const virga_glass_blade_gpu *blade, const float position[2], double out[2])
{
    const double off[2] = {(double)position[0] - (double)blade->middle[0],
                           (double)position[1] - (double)blade->middle[1]};
    out[0] = -off[0] * (double)blade->along[1] + off[1] * (double)blade->along[0];
    out[1] = off[0] * (double)blade->along[0] + off[1] * (double)blade->along[1];
}

static void cell_middle(uint32_t cell, float out[2])
{
    out[0] = fminf(((float)(cell % f.glass->columns) + 0.5f) * f.glass->def.cell_m, f.glass->def.width_m);
    out[1] = fminf(((float)(cell / f.glass->columns) + 0.5f) * f.glass->def.cell_m, f.glass->def.height_m);
}

static bool under_blade(const virga_glass_tick_gpu *tick, const float position[2], double by)
{
    for (uint32_t i = 0; i < tick->blade_count; i++) {
        double local[2];
        blade_local(&tick->blades[i], position, local);
        if (fabs(local[0]) < (double)tick->blades[i].half_width_m + by &&
            fabs(local[1]) < (double)tick->blades[i].half_length_m + by)
            return true;
    }
    return false;
}

static void assert_cells(void)
{
    const uint32_t cells = f.glass->columns * f.glass->rows;
    uint32_t drops = 0, occupied = 0;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++) {
        const virga_glass_drop_gpu *drop = &f.drops[i];
        if (glass_fixture_kind(drop) != VIRGA_GLASS_DROP)
            continue;
        drops++;
        REQUIRE(drop->cell < cells && f.occupants[drop->cell] == i + 1);
        REQUIRE(drop->water_nl > 0 && isfinite(drop->velocity[0]) && isfinite(drop->velocity[1]));
    }
    for (uint32_t i = 0; i < cells; i++) {
        occupied += f.occupants[i] != 0;
        REQUIRE(f.claims[i] == VIRGA_GLASS_NONE && f.claims[cells + i] == VIRGA_GLASS_NONE);
    }
    assert_int_equal(drops, occupied);
}

static void assert_budget(void)
{
    const uint64_t gone = glass_fixture_count(&f, VIRGA_GLASS_RUN_OFF) + glass_fixture_count(&f, VIRGA_GLASS_WIPED) +
                          glass_fixture_count(&f, VIRGA_GLASS_EVAPORATED);
    assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_LANDED), glass_fixture_water(&f) + gone);
    virga_glass_stats stats;
    virga_glass_stats_get(f.glass, &stats);
    assert_int_equal(stats.landed_nl, stats.drops_nl + stats.particles_nl + stats.film_nl + stats.run_off_nl +
                                          stats.wiped_nl + stats.evaporated_nl);
    assert_int_equal(stats.landed_nl, glass_fixture_count(&f, VIRGA_GLASS_LANDED));
}

static void assert_blades(const virga_glass_tick_gpu *tick)
{
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++) {
        const virga_glass_drop_gpu *drop = &f.drops[i];
        float middle[2];
        if (glass_fixture_kind(drop) == VIRGA_GLASS_DROP) {
            cell_middle(drop->cell, middle);
            REQUIRE(!under_blade(tick, middle, 0));
        }
        /* One that began in this tick is pushed out in the next. */
        if (glass_fixture_kind(drop) == VIRGA_GLASS_PARTICLE && drop->age_s > 0)
            REQUIRE(!under_blade(tick, drop->position, -1e-5));
    }
}

#define EDGE_M 1e-7f /* the largest rounding error of the mean of two positions */

static void assert_on_pane(const uint8_t *mask, uint32_t mask_columns)
{
    const float size[2] = {f.glass->def.width_m, f.glass->def.height_m};
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++) {
        const virga_glass_drop_gpu *drop = &f.drops[i];
        if (glass_fixture_kind(drop) == VIRGA_GLASS_FREE)
            continue;
        for (int axis = 0; axis < 2; axis++)
            REQUIRE(drop->position[axis] >= -EDGE_M && drop->position[axis] <= size[axis] + EDGE_M);
        const float *at = drop->position;
        const uint32_t cell =
            glass_fixture_kind(drop) == VIRGA_GLASS_DROP
                ? drop->cell
                : (uint32_t)(at[0] / f.glass->def.cell_m) + (uint32_t)(at[1] / f.glass->def.cell_m) * f.glass->columns;
        float middle[2];
        cell_middle(cell, middle);
        REQUIRE(!mask || mask[(uint32_t)(middle[0] / size[0] * (float)mask_columns)]);
    }
}

/* A particle in its tick out of all bands, with no drop near that keeps it (sections 4.5 and 4.6). */
static bool may_leave(const virga_glass_tick_gpu *tick, const virga_glass_drop_gpu *drop)
{
    const int reach = (int)tick->hold_back_cells;
    const int cell[2] = {(int)(drop->position[0] / f.glass->def.cell_m),
                         (int)(drop->position[1] / f.glass->def.cell_m)};
    if (glass_fixture_kind(drop) != VIRGA_GLASS_PARTICLE || !(drop->kind & VIRGA_GLASS_WAITING))
        return false;
    for (int y = cell[1] - reach; y <= cell[1] + reach; y++)
        for (int x = cell[0] - reach; x <= cell[0] + reach; x++) {
            if (x < 0 || y < 0 || x >= (int)f.glass->columns || y >= (int)f.glass->rows)
                continue;
            const uint32_t other = f.occupants[x + y * (int)f.glass->columns];
            if (other && f.drops[other - 1].water_nl >= tick->hold_back_nl)
                return false;
        }
    return true;
}

/* No particle stays one for a second, which is four looks at 25 ticks each, while nothing near keeps it. */
static void assert_let_go(const virga_glass_tick_gpu *tick, uint8_t looks[1024], uint32_t ids[1024])
{
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++) {
        const bool same = ids[i] == f.drops[i].id && may_leave(tick, &f.drops[i]);
        looks[i] = may_leave(tick, &f.drops[i]) ? (uint8_t)(same ? looks[i] + 1 : 1) : 0;
        ids[i] = f.drops[i].id;
        REQUIRE(looks[i] < 4);
    }
}

/* ---- a pane in the rain under two wipers that do not agree */

static void two_wipers(virga_glass_settings *settings)
{
    settings->wiper_count = 2;
    for (uint32_t i = 0; i < 2; i++) {
        virga_glass_wiper *wiper = &settings->wipers[i];
        wiper->pivot_m[0] = i ? 0.1f : 0.01f;
        wiper->pivot_m[1] = -0.01f;
        wiper->reach_m = 0.09f;
        wiper->blade_m = 0.07f;
        wiper->sweep_s = i ? 0.9f : 0.7f;
        wiper->low_deg = 10;
        wiper->high_deg = 140;
        wiper->drive = i ? VIRGA_GLASS_INTERMITTENT : VIRGA_GLASS_CONTINUOUS;
        wiper->pause_s = 0.7f;
    }
}

/* Dispatches for a pane this small are so short that handing them to threads takes longer. */
#define NO_THREADS "0"

static uint64_t hash_of(const void *data, size_t bytes)
{
    const uint32_t *words = data;
    uint64_t hash = 1469598103934665603u;
    for (size_t i = 0; i < bytes / 4; i++)
        hash = (hash ^ words[i]) * 1099511628211u;
    return hash;
}

static uint64_t state_hash(void)
{
    const size_t cells = (size_t)f.glass->columns * f.glass->rows;
    virga_glass_state_gpu state = *f.state;
    state.film_blocks = 0; /* the list of blocks with film, which only the passes for software Vulkan have: see below */
    memset(state.measure_groups, 0, sizeof state.measure_groups);
    return hash_of(f.drops, f.glass->def.max_drops * sizeof *f.drops) ^ hash_of(f.film, cells * 4) * 3 ^
           hash_of(&state, sizeof state) * 7 ^ hash_of(f.passed, cells * 4) * 11 ^
           hash_of(f.film_blocks, glass_film_blocks(&f.glass->def) * sizeof *f.film_blocks) * 13;
}

static void budget_and_cells_hold_over_4000_ticks(void **unused)
{
    (void)unused;
    static uint8_t looks[1024];
    static uint32_t ids[1024];
    uint32_t hash = 7, max_waiting = 0;
    glass_fixture_open(&f, NULL);
    two_wipers(&f.settings);
    f.settings.film_um = 10;
    for (uint32_t done = 0; done < 4000; done += 25) {
        hash = virga_hash1(hash);
        f.info.rate_mm_h = (float)(hash % 150);
        f.info.velocity_m_s[2] = (float)(hash >> 8 & 31);
        f.info.acceleration_m_s2[0] = (float)(hash >> 16 & 15) - 8;
        for (uint32_t i = 0; i < (hash >> 20 & 7); i++)
            glass_fixture_land(&f, 0.16 * (double)virga_unit(virga_hash2(hash, i)),
                               0.12 * (double)virga_unit(virga_hash2(hash, 9 + i)), virga_hash2(hash, 20 + i) % 60000);
        glass_fixture_step(&f, 25, true);
        assert_cells();
        assert_budget();
        assert_blades(&f.glass->blades);
        assert_on_pane(NULL, 0);
        assert_let_go(&f.glass->blades, looks, ids);
        max_waiting = f.state->particles_waiting > max_waiting ? f.state->particles_waiting : max_waiting;
    }
    REQUIRE(max_waiting > 0);
    virga_glass_stats stats;
    virga_glass_stats_get(f.glass, &stats);
    printf("landed %.1f ml, run off %.1f, wiped %.1f, evaporated %.1f; %u drops, %u particles, %u held; merged %llu, "
           "to particles %llu, to drops %llu, crowded %llu\n",
           (double)stats.landed_nl * 1e-6, (double)stats.run_off_nl * 1e-6, (double)stats.wiped_nl * 1e-6,
           (double)stats.evaporated_nl * 1e-6, stats.drops, stats.particles, stats.particles_waiting,
           (unsigned long long)stats.merged, (unsigned long long)stats.to_particles, (unsigned long long)stats.to_drops,
           (unsigned long long)stats.drops_without_slot);
    glass_fixture_close(&f);
}

/* ---- a pane that is no whole number of cells, with a hole, under blades that come to meet each other */

static void opposed_wipers(virga_glass_settings *settings)
{
    settings->wiper_count = 2;
    for (uint32_t i = 0; i < 2; i++) {
        virga_glass_wiper *wiper = &settings->wipers[i];
        wiper->pivot_m[0] = i ? 0.15f : 0.01f;
        wiper->pivot_m[1] = -0.01f;
        wiper->reach_m = 0.1f;
        wiper->blade_m = 0.08f;
        wiper->sweep_s = 0.6f;
        wiper->low_deg = i ? 185 : -5;
        wiper->high_deg = i ? 85 : 95;
        wiper->blade_hold_direction = 0.5f;
    }
}

/* Bent about its upright middle, without glass in columns 5 of 16. */
static void open_odd(const uint8_t *mask)
{
    static float positions[17 * 3 * 3];
    virga_glass_def def = glass_fixture_def();
    def.width_m = 0.1609f;
    def.height_m = 0.1207f;
    glass_fixture_open(&f, &def);
    virga_glass_shape shape = virga_default_glass_shape();
    virga_glass_fill_windshield(def.width_m, def.height_m, 30, 0.2f, 17, 3, positions);
    shape.positions = positions;
    shape.columns = 17;
    shape.rows = 3;
    shape.mask = mask;
    shape.mask_columns = 16;
    shape.mask_rows = 1;
    REQUIRE(virga_glass_shape_set(f.glass, &shape) == VIRGA_OK);
}

static void nothing_leaves_an_odd_pane_under_opposed_blades(void **unused)
{
    (void)unused;
    static const uint8_t mask[16] = {1, 1, 1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    uint32_t hash = 11;
    open_odd(mask);
    opposed_wipers(&f.settings);
    f.settings.tail_spacing_m = 0.004f;
    for (uint32_t done = 0; done < 2000; done += 8) {
        hash = virga_hash1(hash);
        f.info.rate_mm_h = 100;
        f.info.velocity_m_s[2] = 15;
        f.info.acceleration_m_s2[0] = (float)(hash & 31) - 16;
        for (uint32_t i = 0; i < 6; i++) /* some beside the pane, which never were */
            glass_fixture_land(&f, 0.163 * (double)virga_unit(virga_hash2(hash, i)),
                               0.123 * (double)virga_unit(virga_hash2(hash, 9 + i)), virga_hash2(hash, 20 + i) % 60000);
        glass_fixture_step(&f, 8, true);
        assert_cells();
        assert_budget();
        assert_blades(&f.glass->blades);
        assert_on_pane(mask, 16);
    }
    glass_fixture_close(&f);
}

/* Each block that is marked is once in the list of blocks, and the pass that measures ran over this list and the slots.
 * The list may have more: that pass clears the marks of blocks whose film is gone. */
static void assert_listed_blocks(void)
{
    static uint8_t listed[4096];
    const uint32_t blocks = (uint32_t)glass_film_blocks(&f.glass->def), count = f.state->film_blocks;
    const uint32_t groups = (count + VIRGA_GLASS_BLOCKS_PER_GROUP - 1) / VIRGA_GLASS_BLOCKS_PER_GROUP;
    REQUIRE(blocks <= sizeof listed && count <= blocks);
    memset(listed, 0, sizeof listed);
    for (uint32_t i = 0; i < count; i++)
        REQUIRE(f.film_blocks[blocks + i] < blocks && !listed[f.film_blocks[blocks + i]]++);
    for (uint32_t i = 0; i < blocks; i++)
        REQUIRE(!f.film_blocks[i] || listed[i]);
    REQUIRE(f.state->measure_groups[0] >= groups && f.state->measure_groups[1] == 1 && f.state->measure_groups[2] == 1);
}

/* Of all that a pane is, under so many threads of software Vulkan. */
static uint64_t run_of(uint32_t ticks_a_step, const char *threads)
{
    effect_device_set_threads(threads);
    glass_fixture_open(&f, NULL);
    two_wipers(&f.settings);
    f.info.rate_mm_h = 60;
    f.info.velocity_m_s[2] = 10;
    for (uint32_t done = 0; done < 240; done += ticks_a_step) {
        for (uint32_t i = 0; done % 12 == 0 && done < 200 && i < 16;
             i++) /* a crowd of particles, some of which merge */
            glass_fixture_land(&f, 0.16 * (double)virga_unit(virga_hash2(done, i)),
                               0.12 * (double)virga_unit(virga_hash2(done, 20 + i)), 120000);
        glass_fixture_step(&f, ticks_a_step, done + ticks_a_step == 240);
    }
    const uint64_t hash = state_hash();
    if (f.context->for_software)
        assert_listed_blocks();
    glass_fixture_close(&f);
    return hash;
}

static void same_bits_whatever_the_frames_and_threads(void **unused)
{
    (void)unused;
    const uint64_t first = run_of(4, "2");
    assert_int_equal(first, run_of(4, "2"));
    assert_int_equal(first, run_of(12, "1"));
    assert_int_equal(first, run_of(12, "3"));
    effect_device_set_threads(NO_THREADS);
}

static void same_bits_by_passes_for_software_and_for_a_gpu(void **unused)
{
    (void)unused;
    effect_fixture_variants = VIRGA_VARIANTS_SOFTWARE;
    const uint64_t first = run_of(12, "1");
    effect_fixture_variants = VIRGA_VARIANTS_GPU;
    assert_int_equal(first, run_of(12, "1"));
    assert_int_equal(first, run_of(4, "2"));
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
    effect_device_set_threads(NO_THREADS);
}

static uint32_t marked_blocks(void)
{
    uint32_t marked = 0;
    for (uint32_t i = 0; i < glass_film_blocks(&f.glass->def); i++)
        marked += f.film_blocks[i];
    return marked;
}

/* Fine drops on two cells of one block and on one of another are film; a hundred nanolitres dry within two seconds. */
static void blocks_are_marked_while_they_have_film(void **unused)
{
    (void)unused;
    glass_fixture_open(&f, NULL);
    f.settings.evaporation_mm_h = 0;
    glass_fixture_land(&f, 0.0101, 0.0101, 100);
    glass_fixture_land(&f, 0.0151, 0.0101, 50);
    glass_fixture_land(&f, 0.1501, 0.1101, 20);
    glass_fixture_step(&f, 1, true);
    REQUIRE(glass_fixture_water(&f) == 170 && marked_blocks() == 2);
    assert_budget();
    f.settings.evaporation_mm_h = 100;
    glass_fixture_step(&f, 64, true);
    glass_fixture_step(&f, 64, true);
    REQUIRE(glass_fixture_water(&f) == 0 && marked_blocks() == 0);
    f.settings.evaporation_mm_h = 0;
    glass_fixture_land(&f, 0.0101, 0.0101, 30);
    glass_fixture_step(&f, 1, true);
    REQUIRE(marked_blocks() == 1);
    assert_budget();
    glass_fixture_close(&f);
}

int main(void)
{
    effect_device_set_threads(NO_THREADS);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(budget_and_cells_hold_over_4000_ticks),
        cmocka_unit_test(nothing_leaves_an_odd_pane_under_opposed_blades),
        cmocka_unit_test(same_bits_whatever_the_frames_and_threads),
        cmocka_unit_test(same_bits_by_passes_for_software_and_for_a_gpu),
        cmocka_unit_test(blocks_are_marked_while_they_have_film),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
