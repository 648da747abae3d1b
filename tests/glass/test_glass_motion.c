/* test_glass_motion.c - how drops move: what holds them, the way they meander, and what they become together. */
#include "glass_even_fixture.h"

static const virga_glass_drop_gpu *only_drop(void)
{
    const virga_glass_drop_gpu *found = NULL;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP && (!found || f.drops[i].water_nl > found->water_nl))
            found = &f.drops[i];
    return found;
}

/* ---- what holds drops */

static bool runs(double radius_m, double tilt_deg)
{
    open_even(NULL);
    const float c = (float)cos(tilt_deg * M_PI / 180), s = (float)sin(tilt_deg * M_PI / 180);
    const float lean[9] = {1, 0, 0, 0, c, -s, 0, s, c}; /* leaning back from upright by the tilt */
    memcpy(f.info.world_from_pane, lean, sizeof lean);
    glass_fixture_land(&f, 0.08, 0.1, water_of(radius_m));
    glass_fixture_step(&f, 60, true);
    const virga_glass_drop_gpu *drop = only_drop();
    const bool moved = !drop || drop->velocity[0] != 0 || drop->velocity[1] != 0;
    glass_fixture_close(&f);
    return moved;
}

static void drops_run_from_a_radius_of_2_2_mm_on_upright_paper_glass(void **unused)
{
    (void)unused;
    assert_false(runs(2.15e-3, 0));
    assert_true(runs(2.25e-3, 0));
}

/* The radius goes with one over the root of the slope: a pane that leans by 60 degrees feels half of gravity. */
static void a_leaning_pane_holds_larger_drops(void **unused)
{
    (void)unused;
    const double critical = 2.2e-3 / sqrt(cos(60 * M_PI / 180));
    assert_false(runs(critical * 0.97, 60));
    assert_true(runs(critical * 1.03, 60));
}

/* Water (m^3) of the smallest drop that runs on an upright pane, and the speed of one of twice that. */
static double critical_water(virga_glass_kind kind, double *speed_m_s)
{
    virga_glass_settings s = virga_default_glass_settings();
    virga_glass_apply_kind(kind, &s);
    const double cap = glass_cap_volume(glass_rest_deg(&s)), weight = VIRGA_WATER_DENSITY * VIRGA_GRAVITY * cap;
    const double radius = sqrt(glass_hold(&s) / weight), twice = radius * cbrt(2);
    const double pulled = weight * twice * twice * twice - (double)s.kinetic_hold * glass_hold(&s) * twice;
    *speed_m_s = pulled / (glass_drag(&s) * twice);
    return cap * radius * radius * radius;
}

/* Dirt holds more water than clean glass, and on a coating drops run faster than on either. */
static void kinds_of_glass_differ_in_what_sticks_and_how_fast_it_runs(void **unused)
{
    (void)unused;
    double clean_m_s, dirty_m_s, coated_m_s;
    const double clean = critical_water(VIRGA_GLASS_KIND_CLEAN, &clean_m_s);
    const double dirty = critical_water(VIRGA_GLASS_KIND_DIRTY, &dirty_m_s);
    const double coated = critical_water(VIRGA_GLASS_KIND_COATED, &coated_m_s);
    print_message("run from %.1f ul clean, %.1f dirty, %.1f coated on; twice as large at %.3f, %.3f, %.3f m/s\n",
                  clean * 1e9, dirty * 1e9, coated * 1e9, clean_m_s, dirty_m_s, coated_m_s);
    assert_true(dirty > 1.5 * clean);
    assert_true(coated_m_s > 1.5 * clean_m_s && coated_m_s > 1.5 * dirty_m_s);
}

static void cap_volume_is_the_hemisphere_at_90_degrees(void **unused)
{
    (void)unused;
    assert_true(fabs(glass_cap_volume(90) - 2 * M_PI / 3) < 1e-12);
    /* A flat cap is a parabola of half the height of its cone: pi a^2 h / 2 with h = a tan(t / 2). */
    assert_true(fabs(glass_cap_volume(2) / (M_PI / 2 * tan(M_PI / 180)) - 1) < 1e-3);
}

/* On even glass v goes to (F - H) / C. The glass before it is dry: its own path does not ease it. */
static void a_running_drop_reaches_its_terminal_speed(void **unused)
{
    (void)unused;
    virga_glass_def def = glass_fixture_def();
    def.height_m = 0.6f;
    open_even(&def);
    f.settings.meander = 0;
    const double radius = 2.4e-3, mass = water_of(radius) * 0.9982e-9;
    const double pulled = mass * VIRGA_GRAVITY,
                 held = (double)f.settings.kinetic_hold * glass_hold(&f.settings) * radius;
    const double expected = (pulled - held) / (glass_drag(&f.settings) * radius);
    glass_fixture_land(&f, 0.08, 0.58, water_of(radius));
    glass_fixture_step(&f, 60, true);
    const virga_glass_drop_gpu *drop = only_drop();
    REQUIRE(drop);
    print_message("terminal speed %.4f m/s, expected %.4f\n", -(double)drop->velocity[1], expected);
    assert_true(fabs(-(double)drop->velocity[1] / expected - 1) < 0.01);
    const double way = 0.58 - (double)drop->position[1];
    assert_true(fabs(way / (expected * 59 / 60.0) - 1) < 0.12); /* less the start and what the drawing lags */
    glass_fixture_close(&f);
}

/* ---- meander */

#define LANES  4 /* drops that run side by side, too far apart to meet */
#define TOP_M  0.29
#define DOWN_M 0.25 /* that they run before they are looked at */

typedef struct paths {
    double mean, deviation; /* of u when a drop has come down by DOWN_M, less where it began */
    uint32_t count;
} paths;

static const virga_glass_drop_gpu *drop_of(uint32_t id)
{
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (f.drops[i].id == id && glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP)
            return &f.drops[i];
    return NULL;
}

static void open_tall(uint32_t seed, float affinity)
{
    virga_glass_def def = glass_fixture_def();
    def.seed = seed;
    def.width_m = 0.5f;
    def.height_m = 0.3f;
    open_even(&def);
    f.settings.affinity = affinity;
}

/* Drops of 3 mm released at four spots of a tall pane, each of them on new glass; linear between two looks. */
static void run_lanes(double *sum, double *squares, uint32_t *count)
{
    uint32_t ids[LANES];
    double before[LANES][2];
    bool seen[LANES] = {false};
    for (uint32_t i = 0; i < LANES; i++) {
        before[i][0] = 0.06 + 0.09 * i;
        before[i][1] = TOP_M;
        ids[i] = glass_fixture_land(&f, before[i][0], TOP_M, water_of(3e-3))->id;
    }
    for (uint32_t done = 0, tick = 0; done < LANES && tick < 400; tick += 8) {
        glass_fixture_step(&f, 8, true);
        for (uint32_t i = 0; i < LANES; i++) {
            const virga_glass_drop_gpu *drop = drop_of(ids[i]);
            if (seen[i] || (!drop && before[i][1] == TOP_M))
                continue;
            const double now[2] = {drop ? (double)drop->position[0] : before[i][0],
                                   drop ? (double)drop->position[1] : 0};
            if (now[1] <= TOP_M - DOWN_M) {
                const double t = (before[i][1] - (TOP_M - DOWN_M)) / (before[i][1] - now[1]);
                const double off = before[i][0] + t * (now[0] - before[i][0]) - (0.06 + 0.09 * i);
                *sum += off;
                *squares += off * off;
                (*count)++;
                done++;
                seen[i] = true;
            }
            before[i][0] = now[0];
            before[i][1] = now[1];
        }
    }
}

static paths release(uint32_t panes, float affinity, float wind_m_s)
{
    double sum = 0, squares = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < panes; i++) {
        open_tall(100 + i, affinity);
        f.info.wind_m_s[0] = wind_m_s;
        run_lanes(&sum, &squares, &count);
        glass_fixture_close(&f);
    }
    REQUIRE(count == panes * LANES);
    return (paths){.mean = sum / count, .deviation = sqrt(squares / count - sum * sum / count / count), .count = count};
}

static void drops_run_straight_down_on_average_and_spread_with_affinity(void **unused)
{
    (void)unused;
    const paths all[3] = {release(3, 0, 0), release(5, 0.6f, 0), release(5, 1.6f, 0)};
    for (int i = 0; i < 3; i++) {
        print_message("mean %.4f m, deviation %.4f m of %u\n", all[i].mean, all[i].deviation, all[i].count);
        assert_true(fabs(all[i].mean) < 3 * all[i].deviation / sqrt(all[i].count) + 5e-4);
    }
    assert_true(all[0].deviation < all[1].deviation && all[1].deviation < all[2].deviation);
}

/* What holds and what drags lie along the way, so the way is that of the force. */
static void wind_from_the_side_tilts_the_mean_as_the_force(void **unused)
{
    (void)unused;
    const float wind = 14;
    virga_glass_settings s = virga_default_glass_settings();
    const double angle = glass_rest_deg(&s) * M_PI / 180, a = 3e-3;
    const double section = (angle - sin(angle) * cos(angle)) / (sin(angle) * sin(angle));
    const double along = (double)wind * (double)s.air_share;
    const double aside = 0.5 * VIRGA_AIR_DENSITY * 0.9 * section * a * a * along * along;
    const double down = glass_cap_volume(glass_rest_deg(&s)) * a * a * a * VIRGA_WATER_DENSITY * VIRGA_GRAVITY;
    const paths tilted = release(4, 0.3f, wind);
    print_message("mean %.4f m, expected %.4f\n", tilted.mean, aside / down * DOWN_M);
    assert_true(aside / down > 0.1);
    assert_true(fabs(tilted.mean - aside / down * DOWN_M) <
                0.06 * aside / down * DOWN_M + 3 * tilted.deviation / sqrt(tilted.count));
}

/* Share of the cells of a second drop's path that lie on the first one's. */
static double overlap(float path_ease)
{
    uint32_t common = 0, all = 0;
    for (uint32_t seed = 0; seed < 5; seed++) {
        open_tall(seed, 0.6f);
        f.settings.path_ease = path_ease;
        f.settings.path_dry_s = 30;
        uint32_t first = 0;
        for (int drop = 0; drop < 2; drop++) {
            first = f.tick;
            glass_fixture_land(&f, 0.25, TOP_M, water_of(3e-3));
            for (int i = 0; i < 12 && (i == 0 || only_drop()); i++)
                glass_fixture_step(&f, 24, true);
            if (drop == 0)
                memcpy(f.upload.mapped, f.passed, f.glass->passed->size);
        }
        const uint32_t *before = f.upload.mapped;
        for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++)
            if (f.passed[i] >= first) {
                all++;
                common += before[i] != 0;
            }
        glass_fixture_close(&f);
    }
    REQUIRE(all > 0);
    return (double)common / all;
}

static void a_second_drop_follows_the_path_of_the_first(void **unused)
{
    (void)unused;
    const double eased = overlap(0.8f), chance = overlap(0);
    print_message("on the first one's path: %.2f, by chance %.2f\n", eased, chance);
    assert_true(eased > chance + 0.1);
}

/* ---- drops that touch */

/* Two drops land side by side, in cells that are no neighbours. How many are left; *found is the largest. */
static uint32_t land_two(double radius_m, double apart_m, double second_share, const virga_glass_drop_gpu **found)
{
    uint32_t count = 0;
    glass_fixture_land(&f, 0.0805, 0.0611, water_of(radius_m));
    glass_fixture_land(&f, 0.0805 + apart_m, 0.0611, (uint32_t)(second_share * water_of(radius_m)));
    glass_fixture_step(&f, 4, true);
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        count += glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP;
    *found = only_drop();
    REQUIRE(*found);
    return count;
}

static void drops_at_rest_become_one_where_their_bases_meet(void **unused)
{
    (void)unused;
    const virga_glass_drop_gpu *drop;
    const double radius = 1.8e-3;
    open_even(NULL);
    f.settings.merge_distance = 1;
    assert_int_equal(land_two(radius, 2.02 * radius, 1, &drop), 2);
    glass_fixture_close(&f);
    open_even(NULL);
    f.settings.merge_distance = 1;
    assert_int_equal(land_two(radius, 1.98 * radius, 1, &drop), 1);
    assert_int_equal(drop->water_nl, 2 * water_of(radius));
    glass_fixture_close(&f);
    open_even(NULL);
    f.settings.merge_distance = 0; /* as Goto et al. */
    assert_int_equal(land_two(radius, 1.98 * radius, 1, &drop), 2);
    glass_fixture_close(&f);
    for (int i = 0; i < 2; i++) { /* drops whose rims are held are flatter, and so wider */
        open_even(NULL);
        f.settings.merge_distance = f.settings.pinning = 1;
        const double wider =
            cbrt(glass_cap_volume(glass_rest_deg(&f.settings)) / glass_cap_volume(glass_seen_deg(&f.settings)));
        REQUIRE(wider > 1.05);
        assert_int_equal(land_two(radius, (i ? 1.98 : 2.02) * wider * radius, 1, &drop), i ? 1 : 2);
        glass_fixture_close(&f);
    }
}

/* Lying flat, so that it stays there: the middle of all the water, to the 10 um that moments are counted in. */
static void drops_that_become_one_lie_in_the_middle_of_their_water(void **unused)
{
    (void)unused;
    const virga_glass_drop_gpu *drop;
    const double radius = 2e-3, apart = 3.4e-3, share = 0.5;
    const float flat[9] = {1, 0, 0, 0, 0, -1, 0, 1, 0};
    open_even(NULL);
    memcpy(f.info.world_from_pane, flat, sizeof flat);
    assert_int_equal(land_two(radius, apart, share, &drop), 1);
    assert_true(fabs((double)drop->position[0] - (0.0805 + apart * share / (1 + share))) < 1e-5);
    assert_true(fabs((double)drop->position[1] - 0.0611) < 1e-5);
    assert_true(drop->velocity[0] == 0 && drop->velocity[1] == 0);
    assert_true(drop->previous_position[0] == drop->position[0]); /* it was there a tick before, too */
    glass_fixture_close(&f);
}

/* The drops as a test changed them in `upload`. */
static void put_drops(void)
{
    const VkCommandBuffer cmd = glass_fixture_begin(&f);
    const VkBufferCopy all = {0, 0, f.glass->drops->size};
    effect_fixture_transfers(cmd);
    vkCmdCopyBuffer(cmd, f.upload.buffer, f.glass->drops->buffer, 1, &all);
    glass_fixture_submit(&f);
}

/* It has no direction: that of (0, 0) is undefined. */
static void a_stopped_drop_with_way_left_stays(void **unused)
{
    (void)unused;
    const float flat[9] = {1, 0, 0, 0, 0, -1, 0, 1, 0};
    open_even(NULL);
    memcpy(f.info.world_from_pane, flat, sizeof flat);
    glass_fixture_land(&f, 0.0805, 0.0611, water_of(1e-3));
    glass_fixture_step(&f, 1, true);
    const uint32_t slot = (uint32_t)(only_drop() - f.drops), cell = only_drop()->cell;
    virga_glass_drop_gpu *given = f.upload.mapped;
    memcpy(given, f.drops, f.glass->drops->size);
    given[slot].progress_m = 3 * f.glass->def.cell_m;
    given[slot].kind |= VIRGA_GLASS_RUNNING;
    put_drops();
    glass_fixture_step(&f, 1, true);
    assert_int_equal(f.drops[slot].cell, cell);
    assert_true(f.drops[slot].progress_m == 0);
    assert_true(f.drops[slot].velocity[0] == 0 && f.drops[slot].velocity[1] == 0);
    glass_fixture_close(&f);
}

/* Two of ten millilitres at 0.8 m/s: the momentum of each is more than a whole number of nl mm/s holds. What comes of
 * them runs on, and not back. */
static void the_largest_drops_keep_their_direction_as_they_merge(void **unused)
{
    (void)unused;
    open_even(NULL);
    glass_fixture_land(&f, 0.0805, 0.0811, 10000000);
    glass_fixture_land(&f, 0.0825, 0.0811, 10000000);
    glass_fixture_step(&f, 1, true);
    virga_glass_drop_gpu *given = f.upload.mapped;
    memcpy(given, f.drops, f.glass->drops->size);
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (glass_fixture_kind(&given[i]) == VIRGA_GLASS_DROP)
            given[i].velocity[0] = 0.8f;
    put_drops();
    glass_fixture_step(&f, 1, true);
    const virga_glass_drop_gpu *drop = only_drop();
    REQUIRE(drop && drop->water_nl == 20000000);
    assert_true(drop->velocity[0] > 0.4f && drop->velocity[0] < 0.9f);
    glass_fixture_close(&f);
}

/* Five drops as a wiper gathers them. The heaviest, in the middle, merges the others into itself. The momenta of two of
 * them together do not fit into an integer, in nl mm/s. */
static void momenta_of_many_large_drops_add_up(void **unused)
{
    (void)unused;
    static const double around[5][2] = {{0, 0}, {4e-3, 0}, {-4e-3, 0}, {0, 4e-3}, {0, -4e-3}};
    open_even(NULL);
    for (int i = 0; i < 5; i++)
        glass_fixture_land(&f, 0.0805 + around[i][0], 0.0611 + around[i][1], i ? 2200000 : 2600000);
    glass_fixture_step(&f, 1, true);
    virga_glass_drop_gpu *given = f.upload.mapped;
    memcpy(given, f.drops, f.glass->drops->size);
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (glass_fixture_kind(&given[i]) == VIRGA_GLASS_DROP)
            given[i].velocity[0] = 0.8f;
    put_drops();
    glass_fixture_step(&f, 1, true);
    const virga_glass_drop_gpu *drop = only_drop();
    REQUIRE(drop && drop->water_nl == 4 * 2200000 + 2600000);
    assert_true(drop->velocity[0] > 0.7f && drop->velocity[0] < 0.9f);
    glass_fixture_close(&f);
}

/* Four in a row, each heavier than the next. The first merges the second into itself, which moves it away from the
 * third. The third and the fourth were to merge into drops that have merged themselves, so they look again. */
static void a_drop_whose_captor_is_gone_looks_again(void **unused)
{
    (void)unused;
    const double radii[4] = {1.2e-3, 1.15e-3, 1.1e-3, 0.7e-3};
    double x = 0.0505;
    uint32_t count = 0;
    open_even(NULL);
    f.settings.merge_distance = 1;
    for (int i = 0; i < 4; i++) {
        x += i ? 0.95 * (radii[i - 1] + radii[i]) : 0;
        glass_fixture_land(&f, x, 0.0611, water_of(radii[i]));
    }
    glass_fixture_step(&f, 5, true);
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        count += glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP;
    assert_int_equal(count, 2);
    glass_fixture_close(&f);
}

/* Whichever of them come first, whoever takes in whom: in the end no two that have nothing left to do touch. */
static void drops_at_rest_do_not_touch(void **unused)
{
    (void)unused;
    uint32_t resting = 0;
    open_even(NULL);
    f.settings.advancing_deg = 90; /* large ones stay, too */
    f.settings.receding_deg = 10;
    for (uint32_t step = 0; step < 12; step++) {
        for (uint32_t i = 0; i < 60; i++)
            glass_fixture_land(&f, 0.005 + 0.15 * (double)virga_unit(virga_hash3(step, i, 1)),
                               0.005 + 0.11 * (double)virga_unit(virga_hash3(step, i, 2)),
                               100 + virga_hash3(step, i, 3) % 2000);
        glass_fixture_step(&f, 12, true);
    }
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++) {
        const virga_glass_drop_gpu *a = &f.drops[i];
        if (a->kind != VIRGA_GLASS_DROP)
            continue;
        resting++;
        for (uint32_t k = 0; k < i; k++) {
            const virga_glass_drop_gpu *b = &f.drops[k];
            const double apart =
                hypot((double)a->position[0] - (double)b->position[0], (double)a->position[1] - (double)b->position[1]);
            const double cap = glass_cap_volume(glass_rest_deg(&f.settings)) * NL_OF_M3;
            if (b->kind == VIRGA_GLASS_DROP)
                REQUIRE(apart > 0.999 * (double)f.settings.merge_distance *
                                    (cbrt(a->water_nl / cap) + cbrt(b->water_nl / cap)));
        }
    }
    print_message("%u drops at rest of 720\n", resting);
    assert_true(resting > 30);
    glass_fixture_close(&f);
}

static void the_surface_has_one_value_per_cell(void **unused)
{
    (void)unused;
    virga_glass_buffer surface;
    uint32_t columns, rows;
    glass_fixture_open(&f, NULL);
    virga_glass_surface(f.glass, &surface, &columns, &rows);
    assert_int_equal(columns, 80); /* 0.16 m by 2 mm */
    assert_int_equal(rows, 60);
    assert_int_equal(surface.size, 80 * 60 * 4);
    virga_glass_surface(NULL, &surface, &columns, &rows);
    assert_int_equal(surface.size + columns + rows, 0);
    glass_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinds_of_glass_differ_in_what_sticks_and_how_fast_it_runs),
        cmocka_unit_test(cap_volume_is_the_hemisphere_at_90_degrees),
        cmocka_unit_test(drops_run_from_a_radius_of_2_2_mm_on_upright_paper_glass),
        cmocka_unit_test(a_leaning_pane_holds_larger_drops),
        cmocka_unit_test(a_running_drop_reaches_its_terminal_speed),
        cmocka_unit_test(drops_run_straight_down_on_average_and_spread_with_affinity),
        cmocka_unit_test(wind_from_the_side_tilts_the_mean_as_the_force),
        cmocka_unit_test(a_second_drop_follows_the_path_of_the_first),
        cmocka_unit_test(drops_at_rest_become_one_where_their_bases_meet),
        cmocka_unit_test(drops_that_become_one_lie_in_the_middle_of_their_water),
        cmocka_unit_test(a_stopped_drop_with_way_left_stays),
        cmocka_unit_test(the_largest_drops_keep_their_direction_as_they_merge),
        cmocka_unit_test(momenta_of_many_large_drops_add_up),
        cmocka_unit_test(a_drop_whose_captor_is_gone_looks_again),
        cmocka_unit_test(drops_at_rest_do_not_touch),
        cmocka_unit_test(the_surface_has_one_value_per_cell),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
