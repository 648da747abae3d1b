/* test_glass_fog.c - condensation: how fast glass fogs and dries, what takes the fog, and where its water goes. */
#include "glass_even_fixture.h"

#define TICK_S    (1 / 60.0)
#define TURNS     16
#define HEAT_AIR  (1.2 * 1005 * 0.8973)
#define PL_PER_UM 4000.0 /* on a cell of 2 mm */
#define WATER_KG  998.2

/* Vapour of saturated air (kg/m^3), by Magnus' formula. */
static double saturated(double celsius)
{
    return 611.2 * exp(17.62 * celsius / (243.12 + celsius)) / (461.5 * (celsius + 273.15));
}

static const uint32_t *fog_cells(void)
{
    return f.film + (size_t)f.glass->columns * f.glass->rows;
}

/* A pane that can fog, on which nothing condenses or dries: `heat` is 0. */
static void open_fog(virga_glass_fog_side side)
{
    virga_glass_def def = glass_fixture_def();
    def.condensation = true;
    open_even(&def);
    f.settings.condensation.side = side;
    f.settings.condensation.heat_w_m2_k = 0;
}

static void assert_budget(void)
{
    const uint32_t cells = f.glass->columns * f.glass->rows;
    uint64_t fog = 0;
    for (uint32_t i = 0; i < cells; i++)
        fog += fog_cells()[i];
    const uint64_t given = glass_fixture_count(&f, VIRGA_GLASS_FOG_GIVEN);
    assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_CONDENSED),
                     fog + glass_fixture_count(&f, VIRGA_GLASS_FOG_DRIED) + 1000 * given);
    assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_LANDED) + given,
                     glass_fixture_water(&f) + glass_fixture_count(&f, VIRGA_GLASS_RUN_OFF) +
                         glass_fixture_count(&f, VIRGA_GLASS_WIPED) + glass_fixture_count(&f, VIRGA_GLASS_EVAPORATED));
    virga_glass_stats stats;
    virga_glass_stats_get(f.glass, &stats);
    assert_int_equal(stats.fog_pl, fog);
    assert_int_equal(stats.landed_nl + stats.fog_given_nl, stats.drops_nl + stats.particles_nl + stats.film_nl +
                                                               stats.run_off_nl + stats.wiped_nl + stats.evaporated_nl);
}

/* The mean fog (pl) of the cells of a block, and the time (s) up to its last turn. */
static double block_fog(uint32_t block, uint32_t first_tick, double *seconds)
{
    const uint32_t blocks = (f.glass->columns + 15) / 16, last = f.tick - 1;
    double sum = 0;
    uint32_t cells = 0, turn = last;
    for (uint32_t y = block / blocks * 16; y < f.glass->rows && y < block / blocks * 16 + 16; y++)
        for (uint32_t x = block % blocks * 16; x < f.glass->columns && x < block % blocks * 16 + 16; x++, cells++)
            sum += fog_cells()[x + y * f.glass->columns];
    while (turn % TURNS != block % TURNS)
        turn--;
    *seconds = (turn - first_tick + 1) * TICK_S;
    return sum / cells;
}

/* The density of saturated vapour in tables (CRC Handbook), to half a percent. */
static void saturated_vapour_is_that_of_tables(void **unused)
{
    static const double table[][2] = {{0, 4.85e-3}, {10, 9.40e-3}, {20, 17.3e-3}, {30, 30.4e-3}, {34, 37.6e-3}};
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE);
    for (int i = 0; i < 5; i++) {
        virga_glass_tick_gpu tick = {.tick = 1};
        f.settings.condensation.air_c = (float)table[i][0];
        f.settings.condensation.humidity = 1;
        REQUIRE(virga_glass_set(f.glass, &f.settings) == VIRGA_OK);
        glass_fill_fog(f.glass, &tick);
        assert_float_equal(tick.air_vapour, table[i][1], 5e-3 * table[i][1]);
    }
    glass_fixture_close(&f);
}

/* Below the dew point each block gains h_m (rho_air - rho_sat) t, to a hundredth. */
static void fog_grows_by_the_excess_of_vapour(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE);
    f.settings.condensation.heat_w_m2_k = 30;
    f.settings.condensation.humidity = 0.9f;
    f.settings.condensation.glass_c = 8;
    for (int i = 0; i < 3; i++)
        glass_fixture_step(&f, 40, i == 2);
    const double um_s = 30 / HEAT_AIR * (0.9 * saturated(20) - saturated(8)) / WATER_KG * 1e6;
    for (uint32_t block = 0; block < 20; block++) {
        double seconds;
        const double fog = block_fog(block, 1, &seconds);
        assert_float_equal(fog, um_s * seconds * PL_PER_UM, 0.01 * um_s * seconds * PL_PER_UM);
    }
    assert_budget();
    glass_fixture_close(&f);
}

/* Above it, fog of 5 um dries at that rate, and is gone after the time that the rate gives. */
static void fog_dries_in_the_time_of_the_rate(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE);
    f.settings.condensation.heat_w_m2_k = 200;
    f.settings.condensation.humidity = 0.2f;
    f.settings.condensation.glass_c = 25;
    f.settings.condensation.start_um = 5;
    const double um_s = 200 / HEAT_AIR * (saturated(25) - 0.2 * saturated(20)) / WATER_KG * 1e6;
    glass_fixture_step(&f, 48, true);
    for (uint32_t block = 0; block < 20; block++) {
        double seconds;
        const double fog = block_fog(block, 1, &seconds);
        assert_float_equal(fog, (5 - um_s * seconds) * PL_PER_UM, 0.01 * 5 * PL_PER_UM);
    }
    while (f.tick * TICK_S < 5 / um_s + 2 * TURNS * TICK_S)
        glass_fixture_step(&f, 32, true);
    for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++)
        assert_int_equal(fog_cells()[i], 0);
    assert_budget();
    glass_fixture_close(&f);
}

/* Breath: a Gaussian share of its air, and a coefficient that is larger in the jet. Each cell to 3 % of the middle's.
 * */
static void breath_fogs_by_its_share_of_the_air(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE);
    f.settings.condensation.heat_w_m2_k = 4;
    f.settings.condensation.humidity = (float)(saturated(12) / saturated(20)); /* nothing condenses without breath */
    f.settings.condensation.glass_c = 12;
    REQUIRE(virga_glass_breathe(f.glass,
                                &(virga_glass_breath){
                                    .duration_s = 1, .position_m = {0.08f, 0.06f}, .radius_m = 0.03f, .share = 0.8f}) ==
            VIRGA_OK);
    for (int i = 0; i < 3; i++)
        glass_fixture_step(&f, 40, i == 2);
    const double most = (4 + 28 * 0.8) / HEAT_AIR * 0.8 * (saturated(34) - saturated(12)) / WATER_KG * 1e6 * PL_PER_UM;
    for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++) {
        const double u = (i % f.glass->columns + 0.5) * 0.002 - 0.08, v = (i / f.glass->columns + 0.5) * 0.002 - 0.06;
        const double share = 0.8 * exp(-(u * u + v * v) / (0.03 * 0.03));
        const double um = (4 + 28 * share) / HEAT_AIR * share * (saturated(34) - saturated(12)) / WATER_KG * 1e6;
        assert_float_equal(fog_cells()[i], um * PL_PER_UM, 0.03 * most);
    }
    assert_int_equal(f.glass->breath_count, 0);
    assert_budget();
    glass_fixture_close(&f);
}

/* ---- the heater */

#define STEPS 208 /* of the solver, over half the distance of two wires: 16 of them are half a wire's strip */

/* The rise after a time over the mean in the end, by explicit differences: dT/dt = D T'' - T / s + P / (rho c d). The
 * wire is at x = 0, and heats a strip of a thirteenth of the distance. */
static void solve_heater(double half_m, double heater_s, double seconds, double rise[STEPS])
{
    const double dx = half_m / STEPS, diffusivity = 4.8e-7, dt = 0.4 * dx * dx / diffusivity;
    double next[STEPS];
    memset(rise, 0, STEPS * sizeof *rise);
    for (double now = 0; now < seconds; now += dt) {
        for (int i = 0; i < STEPS; i++) {
            const double below = rise[i ? i - 1 : 0], above = rise[i < STEPS - 1 ? i + 1 : i];
            const double power = i < STEPS / 13 ? 13 / heater_s : 0;
            next[i] =
                rise[i] + dt * (diffusivity * (below - 2 * rise[i] + above) / (dx * dx) - rise[i] / heater_s + power);
        }
        memcpy(rise, next, sizeof next);
    }
}

/* To 1 % of the mean in the end. */
static void wires_warm_the_glass_as_the_equation_of_heat_says(void **unused)
{
    static double solved[STEPS];
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE);
    f.settings.condensation.heater_k = 20;
    f.settings.condensation.heater_s = 120;
    f.settings.condensation.heater_wires = 3; /* 4 cm apart */
    REQUIRE(virga_glass_set(f.glass, &f.settings) == VIRGA_OK);
    virga_glass_tick_gpu tick = {0};
    for (tick.tick = 1; tick.tick <= 60 * 60; tick.tick++)
        glass_fill_fog(f.glass, &tick);
    solve_heater(0.02, 120, 60, solved);
    for (int i = 0; i < STEPS; i++) {
        const double v = 0.06 + (i + 0.5) / STEPS * 0.02; /* the middle wire is in the middle */
        double rise = (double)tick.heat_k[0];
        for (int wave = 1; wave < VIRGA_GLASS_HEAT_WAVES; wave++)
            rise += (double)tick.heat_k[wave] * cos(wave * ((double)tick.heat_wave * v + (double)tick.heat_phase));
        assert_float_equal(rise, 20 * solved[i], 0.01 * 20);
    }
    glass_fixture_close(&f);
}

/* A heater without wires: T = K (1 - exp(-t / s)). The fog that is left follows from the integral over the rate. */
static void a_heater_dries_the_glass_in_the_time_of_its_closed_form(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE);
    f.settings.condensation.heat_w_m2_k = 100;
    f.settings.condensation.glass_c = 9.27f; /* the dew point of the air */
    f.settings.condensation.start_um = 10;
    f.settings.condensation.heater_k = 25;
    f.settings.condensation.heater_s = 4;
    double left_um = 10, seconds = 0;
    while (left_um > 4) {
        const double glass = 9.27 + 25 * (1 - exp(-(seconds + 0.5e-3) / 4));
        left_um -= 1e-3 * 100 / HEAT_AIR * (saturated(glass) - 0.5 * saturated(20)) / WATER_KG * 1e6;
        seconds += 1e-3;
    }
    while (f.tick * TICK_S < seconds)
        glass_fixture_step(&f, 1, f.tick * TICK_S + TICK_S >= seconds);
    double mean = 0; /* blocks have had their last turn 7.5 ticks ago on average */
    for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++)
        mean += fog_cells()[i] / PL_PER_UM / (f.glass->columns * f.glass->rows);
    const double um_s =
        100 / HEAT_AIR * (saturated(9.27 + 25 * (1 - exp(-seconds / 4))) - 0.5 * saturated(20)) / WATER_KG * 1e6;
    assert_float_equal(mean, 4 + 7.5 * TICK_S * um_s, 0.1);
    assert_budget();
    glass_fixture_close(&f);
}

/* While it dries there is no more fog at a wire, and the more of it the farther away. */
static void glass_dries_from_the_wires_outwards(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE);
    f.settings.condensation.heat_w_m2_k = 60;
    f.settings.condensation.start_um = 20;
    f.settings.condensation.heater_k = 40;
    f.settings.condensation.heater_s = 60;
    f.settings.condensation.heater_wires = 3;
    for (int i = 0; i < 20; i++)
        glass_fixture_step(&f, 32, i == 19);
    double before = 0;
    for (uint32_t row = 29; row > 25; row--) { /* of one block, from the middle wire down to 7 mm below it */
        double sum = 0;
        for (uint32_t x = 0; x < 16; x++)
            sum += fog_cells()[x + row * f.glass->columns];
        assert_true(row == 29 ? sum == 0 : sum > before + 16 * 0.1 * PL_PER_UM);
        before = sum;
    }
    assert_budget();
    glass_fixture_close(&f);
}

/* ---- what takes the fog */

/* A drop of 3 mm runs down: where it was there is none, a drop's width beside it there is all; and it is so much
 * heavier. */
static void a_running_drop_clears_its_path(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_OUTSIDE);
    f.settings.condensation.start_um = 10;
    f.settings.meander = 0;
    glass_fixture_land(&f, 0.081, 0.101, water_of(0.003));
    glass_fixture_step(&f, 12, true);
    uint32_t ran = 0, slot = 0;
    while (glass_fixture_kind(&f.drops[slot]) != VIRGA_GLASS_DROP)
        slot++;
    for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++) {
        const uint32_t x = i % f.glass->columns;
        if (f.passed[i] && (i / f.glass->columns + 0.5) * 0.002 > (double)f.drops[slot].position[1]) {
            assert_int_equal(fog_cells()[i], 0);
            ran++;
        }
        if (x < 35 || x > 45)
            assert_float_equal(fog_cells()[i], 10 * PL_PER_UM, 1);
    }
    assert_true(ran > 5);
    /* Its base is 3 cells wide: so many clear cells for each that it ran over. */
    uint32_t clear = 0;
    for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++)
        clear += fog_cells()[i] == 0;
    assert_true(clear >= 5 * ran / 2);
    assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_FOG_GIVEN), 40 * clear);
    assert_budget();
    glass_fixture_close(&f);
}

/* A blade, on dry fog: what it has swept is clear, and the water is in its bins and its film. */
static void a_blade_clears_what_it_sweeps(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_OUTSIDE);
    f.settings.condensation.start_um = 10;
    f.settings.wiper_count = 1;
    virga_glass_wiper *wiper = &f.settings.wipers[0];
    *wiper = virga_default_glass_wiper();
    wiper->pivot_m[0] = 0.08f;
    wiper->reach_m = 0.1f;
    wiper->blade_m = 0.08f;
    wiper->low_deg = 20;
    wiper->high_deg = 160;
    glass_fixture_step(&f, 36, true);
    uint32_t clear = 0;
    for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++) {
        const double u = (i % f.glass->columns + 0.5) * 0.002 - 0.08, v = (i / f.glass->columns + 0.5) * 0.002;
        const double r = hypot(u, v), deg = atan2(v, u) * 180 / M_PI;
        if (r > 0.023 && r < 0.097 && deg > 25 && deg < 150) {
            assert_int_equal(fog_cells()[i], 0);
            clear++;
        }
        if (r < 0.015 || r > 0.105)
            assert_float_equal(fog_cells()[i], 10 * PL_PER_UM, 1);
    }
    assert_true(clear > 1000);
    assert_true(glass_fixture_count(&f, VIRGA_GLASS_FOG_GIVEN) >= 40 * clear);
    assert_budget();
    glass_fixture_close(&f);
}

/* Rain and blades on the other side leave it as it is. */
static void rain_and_blades_do_not_touch_fog_inside(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE);
    f.settings.condensation.start_um = 10;
    f.settings.wiper_count = 1;
    f.settings.wipers[0] = virga_default_glass_wiper();
    f.settings.wipers[0].reach_m = 0.1f;
    f.settings.wipers[0].blade_m = 0.08f;
    glass_fixture_land(&f, 0.081, 0.101, water_of(0.003));
    glass_fixture_step(&f, 48, true);
    for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++)
        assert_float_equal(fog_cells()[i], 10 * PL_PER_UM, 1);
    assert_budget();
    glass_fixture_close(&f);
}

/* Droplets of more than drop_radius_mm are drops of the pane, one on a square of 8 mm at a time. */
static void large_droplets_become_drops(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_OUTSIDE);
    f.settings.merge_distance = 0;
    f.settings.condensation.drop_radius_mm = 0.4f;
    /* The mean thickness at that radius, and half as much again: 0.55 r volume(1) / pi. */
    const double um = 0.55 * 400 * glass_cap_volume(glass_rest_deg(&f.settings)) / M_PI;
    f.settings.condensation.start_um = (float)(1.5 * um);
    glass_fixture_step(&f, TURNS, true);
    uint32_t drops = 0;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP) {
            assert_float_equal(f.drops[i].water_nl, 1.5 * um * PL_PER_UM / 1000, 2);
            drops++;
        }
    assert_int_equal(drops, 20 * 15);
    glass_fixture_step(&f, 64, true);
    f.settings.condensation.start_um = 0;
    assert_budget();
    glass_fixture_close(&f);
}

/* Below that they stay fog. */
static void small_droplets_stay_fog(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_OUTSIDE);
    f.settings.condensation.drop_radius_mm = 0.4f;
    const double um = 0.55 * 400 * glass_cap_volume(glass_rest_deg(&f.settings)) / M_PI;
    f.settings.condensation.start_um = (float)(0.55 * um);
    glass_fixture_step(&f, 2 * TURNS, true);
    assert_int_equal(f.state->drops, 0);
    assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_FOG_GIVEN), 0);
    glass_fixture_close(&f);
}

/* What condenses on a drop at rest joins it. */
static void dew_on_a_drop_joins_it(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_OUTSIDE);
    f.settings.condensation.heat_w_m2_k = 500;
    f.settings.condensation.humidity = 1;
    f.settings.condensation.glass_c = 0;
    glass_fixture_land(&f, 0.081, 0.061, water_of(0.0008));
    for (int i = 0; i < 3; i++)
        glass_fixture_step(&f, 32, i == 2);
    uint32_t water = 0;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        water += glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP ? f.drops[i].water_nl : 0;
    const double um_s = 500 / HEAT_AIR * (saturated(20) - saturated(0)) / WATER_KG * 1e6;
    /* up to the last turn of its block, at most 15 ticks ago */
    assert_in_range(water - water_of(0.0008), (uint32_t)(um_s * 80 * TICK_S * 4) - 2,
                    (uint32_t)(um_s * 96 * TICK_S * 4));
    assert_budget();
    glass_fixture_close(&f);
}

/* ---- whatever happens */

static double pick(uint32_t seed, uint32_t what, double low, double high)
{
    return low + (high - low) * (double)virga_unit(virga_hash2(seed, what));
}

static void set_random(uint32_t seed)
{
    virga_glass_condensation *c = &f.settings.condensation;
    c->side = pick(seed, 1, 0, 1) < 0.7 ? VIRGA_GLASS_FOG_OUTSIDE : (virga_glass_fog_side)pick(seed, 2, 0, 2.99);
    c->air_c = (float)pick(seed, 3, -5, 40);
    c->humidity = (float)pick(seed, 4, 0, 1);
    c->glass_c = (float)pick(seed, 5, -5, 30);
    c->heat_w_m2_k = (float)pick(seed, 6, 0, 500);
    c->drop_radius_mm = (float)pick(seed, 7, 0.1, 0.5);
    c->start_um = (float)pick(seed, 8, 0, 60);
    c->heater_k = pick(seed, 9, 0, 1) < 0.5 ? 0 : (float)pick(seed, 10, 0, 40);
    c->heater_s = (float)pick(seed, 11, 1, 20);
    c->heater_wires = (uint32_t)pick(seed, 12, 0, 6);
    f.settings.wiper_count = (uint32_t)pick(seed, 13, 0, 1.99);
    f.settings.wipers[0] = virga_default_glass_wiper();
    f.settings.wipers[0].pivot_m[0] = 0.08f;
    f.settings.wipers[0].reach_m = 0.1f;
    f.settings.wipers[0].blade_m = 0.08f;
    f.settings.wipers[0].high_deg = 170;
    f.settings.film_um = 6;
    f.settings.tail_max_radius_mm = 0.5f;
    f.settings.evaporation_mm_h = 0.5f;
    f.info.rate_mm_h = (float)pick(seed, 14, 0, 100);
    f.info.wind_m_s[2] = -6;
}

static void breathe_at_random(uint32_t seed)
{
    const virga_glass_breath breath = {.start_s = f.tick * TICK_S + pick(seed, 20, 0, 1),
                                       .duration_s = (float)pick(seed, 21, 0.01, 1),
                                       .position_m = {(float)pick(seed, 22, 0, 0.16), (float)pick(seed, 23, 0, 0.12)},
                                       .radius_m = (float)pick(seed, 24, 0.01, 0.1),
                                       .share = (float)pick(seed, 25, 0, 1)};
    REQUIRE(virga_glass_breathe(f.glass, &breath) == VIRGA_OK);
}

static uint32_t run_random(uint32_t seed, uint32_t steps)
{
    uint32_t hash = seed;
    open_fog(VIRGA_GLASS_FOG_OUTSIDE);
    for (uint32_t i = 0; i < steps; i++) {
        set_random(virga_hash2(seed, i));
        breathe_at_random(virga_hash2(seed, i));
        glass_fixture_step(&f, (uint32_t)pick(seed, 30 + i, 1, 50), true);
        assert_budget();
    }
    for (uint32_t i = 0; i < 2 * f.glass->columns * f.glass->rows; i++)
        hash = virga_hash2(hash, f.film[i]);
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (glass_fixture_kind(&f.drops[i]) != VIRGA_GLASS_FREE)
            hash = virga_hash3(hash, f.drops[i].water_nl, f.drops[i].cell);
    glass_fixture_close(&f);
    return hash;
}

static void water_adds_up_whatever_happens(void **unused)
{
    (void)unused;
    for (uint32_t seed = 1; seed <= 3; seed++)
        run_random(seed, 12);
}

static void the_same_input_gives_the_same_bits(void **unused)
{
    (void)unused;
    assert_int_equal(run_random(7, 10), run_random(7, 10));
}

static void a_pane_without_condensation_refuses_it(void **unused)
{
    (void)unused;
    glass_fixture_open(&f, NULL);
    f.settings.condensation.side = VIRGA_GLASS_FOG_INSIDE;
    assert_int_equal(virga_glass_set(f.glass, &f.settings), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_glass_breathe(f.glass, &(virga_glass_breath){.duration_s = 1, .radius_m = 0.1f}),
                     VIRGA_ERROR_INVALID);
    glass_fixture_close(&f);
}

static void wrong_breaths_are_refused(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE);
    const virga_glass_breath right = {.duration_s = 1, .radius_m = 0.1f, .share = 0.5f};
    virga_glass_breath wrong[6] = {right, right, right, right, right, right};
    wrong[0].start_s = -1;
    wrong[1].duration_s = 0;
    wrong[2].radius_m = 0;
    wrong[3].share = 1.5f;
    wrong[4].position_m[1] = NAN;
    wrong[5].start_s = NAN;
    for (int i = 0; i < 6; i++)
        assert_int_equal(virga_glass_breathe(f.glass, &wrong[i]), VIRGA_ERROR_INVALID);
    for (int i = 0; i < VIRGA_GLASS_MAX_BREATHS; i++)
        assert_int_equal(virga_glass_breathe(f.glass, &right), VIRGA_OK);
    assert_int_equal(virga_glass_breathe(f.glass, &right), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_glass_breathe(NULL, &right), VIRGA_ERROR_INVALID);
    glass_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(saturated_vapour_is_that_of_tables),
        cmocka_unit_test(fog_grows_by_the_excess_of_vapour),
        cmocka_unit_test(fog_dries_in_the_time_of_the_rate),
        cmocka_unit_test(breath_fogs_by_its_share_of_the_air),
        cmocka_unit_test(wires_warm_the_glass_as_the_equation_of_heat_says),
        cmocka_unit_test(a_heater_dries_the_glass_in_the_time_of_its_closed_form),
        cmocka_unit_test(glass_dries_from_the_wires_outwards),
        cmocka_unit_test(a_running_drop_clears_its_path),
        cmocka_unit_test(a_blade_clears_what_it_sweeps),
        cmocka_unit_test(rain_and_blades_do_not_touch_fog_inside),
        cmocka_unit_test(large_droplets_become_drops),
        cmocka_unit_test(small_droplets_stay_fog),
        cmocka_unit_test(dew_on_a_drop_joins_it),
        cmocka_unit_test(water_adds_up_whatever_happens),
        cmocka_unit_test(the_same_input_gives_the_same_bits),
        cmocka_unit_test(a_pane_without_condensation_refuses_it),
        cmocka_unit_test(wrong_breaths_are_refused),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
