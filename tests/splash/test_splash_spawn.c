/* What splashes are made of: 10,000 of each row of the table, against table 1 of Mizukami et al. and what
 * splash_table.c makes of it for other materials.
 *
 * Drops fall at the very end of a tick of 1 ms, so what is read are droplets at birth: they have flown for a nanosecond
 * at most, in which gravity and drag change a speed by less than 1e-6 m/s. */
#include "splash_fixture.h"

#include <math.h>

#define SPLASHES  10000
#define MATERIALS (VIRGA_MATERIAL_DRAIN + 1)
#define MAX_BORN  (22 * SPLASHES) /* droplets of one row */
#define DEGREE    (M_PI / 180)
#define TURNED    0x1p-10 /* of a vector turned by a device's sin and cos, each within 2^-11 (Vulkan, precision) */

static splash_fixture f;

/* Droplets of all splashes of a row, in the order of splashes. */
typedef struct births {
    uint32_t count, counts[SPLASHES]; /* all; by splash */
    double elevation[MAX_BORN], speed[MAX_BORN], azimuth[MAX_BORN];
} births;

static births born;

/* ---- statistics */

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* The normal distribution whose two deviations are the ends, cut there. */
static double cut_normal(double x, double low, double high)
{
    const double z = (x - 0.5 * (low + high)) / (0.25 * (high - low)), two = erf(2 / M_SQRT2);
    return fmin(fmax(0.5 + 0.5 * erf(z / M_SQRT2) / two, 0), 1);
}

static double even(double x, double low, double high)
{
    return (x - low) / (high - low);
}

/* Kolmogorov and Smirnov at 0.1 %: the greatest distance of the distribution of `values` (which are sorted) from the
 * right one. */
static void assert_distributed(double *values, uint32_t count, double (*share)(double, double, double), double low,
                               double high)
{
    double max_distance = 0;
    qsort(values, count, sizeof *values, by_size);
    for (uint32_t i = 0; i < count; i++) {
        const double right = share(values[i], low, high);
        max_distance = fmax(max_distance, fmax(right - (double)i / count, (i + 1.0) / count - right));
    }
    if (max_distance > 1.9495 / sqrt(count))
        fail_msg("from %g to %g: distance %.5f, expected up to %.5f", low, high, max_distance, 1.9495 / sqrt(count));
}

/* What chi-square passes once in a thousand times (Wilson and Hilferty 1931). */
static double chi_square_limit(uint32_t freedom)
{
    const double part = 2.0 / (9.0 * freedom), root = 1 - part + 3.0902 * sqrt(part);
    return freedom * root * root * root;
}

static void assert_even_counts(const uint32_t *counts, uint32_t low, uint32_t high)
{
    uint32_t cells[VIRGA_SPLASH_MAX_COUNT + 1] = {0};
    for (uint32_t i = 0; i < SPLASHES; i++) {
        assert_in_range(counts[i], low, high);
        cells[counts[i]]++;
    }
    const double expected = (double)SPLASHES / (high - low + 1);
    double chi_square = 0;
    for (uint32_t n = low; n <= high; n++)
        chi_square += (cells[n] - expected) * (cells[n] - expected) / expected;
    if (high > low && chi_square > chi_square_limit(high - low))
        fail_msg("%u to %u droplets: chi-square %.1f", low, high, chi_square);
}

static void assert_between(double value, double low, double high, double slack)
{
    if (!(value >= low - slack && value <= high + slack))
        fail_msg("%.9f is not in [%g; %g]", value, low, high);
}

/* ---- splashes */

static virga_splash_rule *row_of(uint32_t material, uint32_t state)
{
    return &f.settings.rules[material][state];
}

/* Drops that fall straight, with different water. */
static void throw_drops(uint32_t material, uint32_t state)
{
    splash_fixture_clear(&f);
    for (uint32_t i = 0; i < SPLASHES; i++) {
        virga_spawn_gpu *spawn = splash_fixture_spawn(&f, material, state);
        spawn->share = JUST_BELOW_1;
        spawn->random = virga_hash3(material, state, i);
        spawn->water_nl = spawn->water_nl ? 64 + virga_hash2(spawn->random, 7) % 4000 : 0;
    }
}

/* Droplets lie in the order of spawns. */
static void measure(void)
{
    memset(&born, 0, sizeof born);
    for (; born.count < f.state->staying; born.count++) {
        const virga_droplet_gpu *droplet = &f.droplets[born.count];
        REQUIRE(born.count < MAX_BORN && droplet->id < SPLASHES && droplet->kind & VIRGA_DROPLET_ALIVE);
        assert_int_equal(VIRGA_DROPLET_INDEX(droplet->kind), born.counts[droplet->id]++);
        const double x = (double)droplet->velocity[0], y = (double)droplet->velocity[1];
        const double z = (double)droplet->velocity[2], angle = atan2(z, x);
        born.elevation[born.count] = atan2(y, hypot(x, z)) / DEGREE;
        born.speed[born.count] = sqrt(x * x + y * y + z * z);
        born.azimuth[born.count] = angle < 0 ? angle + 2 * M_PI : angle;
    }
}

static void throw_row(uint32_t material, uint32_t state)
{
    throw_drops(material, state);
    splash_fixture_step(&f, 1);
    measure();
}

static void assert_row_is_kept(const virga_splash_rule *row)
{
    assert_even_counts(born.counts, (uint32_t)row->count[0], (uint32_t)row->count[1]);
    for (uint32_t i = 0; i < born.count; i++) {
        const double fastest = (double)row->speed_m_s[1];
        assert_between(born.elevation[i], (double)row->angle_deg[0], (double)row->angle_deg[1], TURNED / DEGREE);
        assert_between(born.speed[i], (double)row->speed_m_s[0], fastest, TURNED * fastest);
    }
}

static void assert_row_is_distributed(const virga_splash_rule *row)
{
    if (row->angle_deg[1] > row->angle_deg[0]) {
        assert_distributed(born.elevation, born.count, cut_normal, (double)row->angle_deg[0],
                           (double)row->angle_deg[1]);
        assert_distributed(born.azimuth, born.count, even, 0, 2 * M_PI);
    }
    assert_distributed(born.speed, born.count, cut_normal, (double)row->speed_m_s[0], (double)row->speed_m_s[1]);
}

/* ---- tests: the table */

static void test_asphalt_has_the_rows_of_table_1(void **state)
{
    (void)state;
    static const struct {
        uint32_t state, model;
        float count[2], angle_deg[2], speed_m_s[2];
    } table[4] = {{VIRGA_GROUND_WET, VIRGA_SPLASH_SCATTERING, {1, 5}, {1, 30}, {0.1f, 1.0f}},
                  {VIRGA_GROUND_PUDDLE_3, VIRGA_SPLASH_SCATTERING, {4, 14}, {1, 60}, {0.15f, 1.5f}},
                  {VIRGA_GROUND_PUDDLE_5, VIRGA_SPLASH_SCATTERING, {12, 22}, {1, 90}, {0.2f, 2.0f}},
                  {VIRGA_GROUND_PUDDLE_10, VIRGA_SPLASH_CROWN_CONE, {1, 1}, {90, 90}, {0.1f, 2.0f}}};
    for (int i = 0; i < 4; i++) {
        const virga_splash_rule *row = row_of(VIRGA_MATERIAL_ASPHALT, table[i].state);
        assert_int_equal(row->model, table[i].model);
        assert_memory_equal(row->count, table[i].count, sizeof row->count);
        assert_memory_equal(row->angle_deg, table[i].angle_deg, sizeof row->angle_deg);
        assert_memory_equal(row->speed_m_s, table[i].speed_m_s, sizeof row->speed_m_s);
    }
}

static void test_every_material_splashes_in_every_state_but_dry(void **state)
{
    (void)state;
    for (uint32_t material = 0; material < VIRGA_GROUND_MATERIALS; material++) {
        for (uint32_t wet = VIRGA_GROUND_WET; wet < VIRGA_GROUND_STATES; wet++) {
            const virga_splash_rule *row = row_of(material, wet);
            assert_in_range(row->model, VIRGA_SPLASH_SCATTERING, VIRGA_SPLASH_CROWN_CONE);
            assert_true(row->count[0] >= 1 && row->count[1] >= row->count[0]);
            assert_true(row->angle_deg[1] >= row->angle_deg[0] && row->speed_m_s[1] > row->speed_m_s[0]);
            assert_true(row->share[0] > 0 && row->share[1] > row->share[0] && row->share[1] < 1);
        }
        assert_int_equal(row_of(material, VIRGA_GROUND_PUDDLE_10)->model, VIRGA_SPLASH_CROWN_CONE);
    }
}

static void test_only_steel_and_its_like_show_disks_when_they_are_dry(void **state)
{
    (void)state;
    for (uint32_t material = 0; material < MATERIALS; material++) {
        const bool sealed = material == VIRGA_MATERIAL_STEEL || material == VIRGA_MATERIAL_GLASS ||
                            material == VIRGA_MATERIAL_PLASTIC || material == VIRGA_MATERIAL_TILE;
        if (material != VIRGA_MATERIAL_WATER)
            assert_int_equal(row_of(material, VIRGA_GROUND_DRY)->model, sealed ? VIRGA_SPLASH_DISK : VIRGA_SPLASH_NONE);
    }
    assert_int_equal(row_of(VIRGA_MATERIAL_WATER, VIRGA_GROUND_DRY)->model, VIRGA_SPLASH_CROWN_CONE);
}

/* ---- tests: what splashes make of it */

static void test_asphalt_throws_what_table_1_says(void **state)
{
    (void)state;
    for (uint32_t wet = VIRGA_GROUND_WET; wet < VIRGA_GROUND_STATES; wet++) {
        throw_row(VIRGA_MATERIAL_ASPHALT, wet);
        assert_row_is_kept(row_of(VIRGA_MATERIAL_ASPHALT, wet));
    }
}

static void test_angles_and_speeds_are_normal_and_cut_at_two_deviations(void **state)
{
    (void)state;
    for (uint32_t wet = VIRGA_GROUND_WET; wet < VIRGA_GROUND_STATES; wet++) {
        throw_row(VIRGA_MATERIAL_ASPHALT, wet);
        assert_row_is_distributed(row_of(VIRGA_MATERIAL_ASPHALT, wet));
    }
}

static void test_every_material_throws_what_its_rows_say(void **state)
{
    (void)state;
    for (uint32_t material = 0; material < MATERIALS; material++)
        for (uint32_t wet = VIRGA_GROUND_WET; wet < VIRGA_GROUND_STATES; wet++) {
            if (material == VIRGA_MATERIAL_ASPHALT || (wet == VIRGA_GROUND_PUDDLE_10 && material))
                continue; /* has been thrown; 10 mm are the same on all */
            throw_row(material, wet);
            assert_row_is_kept(row_of(material, wet));
            assert_row_is_distributed(row_of(material, wet));
        }
}

static void test_angle_and_speed_of_a_droplet_know_nothing_of_each_other(void **state)
{
    (void)state;
    double both = 0, angles = 0, speeds = 0, angles2 = 0, speeds2 = 0;
    throw_row(VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_5);
    const double n = born.count;
    for (uint32_t i = 0; i < born.count; i++) {
        both += born.elevation[i] * born.speed[i];
        angles += born.elevation[i];
        speeds += born.speed[i];
        angles2 += born.elevation[i] * born.elevation[i];
        speeds2 += born.speed[i] * born.speed[i];
    }
    const double correlation =
        (both - angles * speeds / n) / sqrt((angles2 - angles * angles / n) * (speeds2 - speeds * speeds / n));
    assert_true(fabs(correlation) < 3.3 / sqrt(n));
}

static void test_piles_stand_on_the_circle_and_point_outwards(void **state)
{
    (void)state;
    const virga_splash_rule *row = row_of(VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_3);
    const double radius = (double)row->circle_radius * 2e-3;
    throw_row(VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_3);
    for (uint32_t i = 0; i < born.count; i++) {
        const double x = (double)f.droplets[i].base[0], z = (double)f.droplets[i].base[2];
        assert_float_equal(hypot(x, z), radius, TURNED * radius);
        assert_float_equal(f.droplets[i].base[1], 0, 1e-9);
        assert_float_equal(x * sin(born.azimuth[i]) - z * cos(born.azimuth[i]), 0, 1e-5 * radius);
        assert_true(x * cos(born.azimuth[i]) + z * sin(born.azimuth[i]) > 0);
    }
}

static void test_the_water_of_droplets_is_that_of_their_splash(void **state)
{
    (void)state;
    static uint32_t sums[SPLASHES];
    for (uint32_t wet = VIRGA_GROUND_WET; wet < VIRGA_GROUND_STATES; wet++) {
        throw_drops(VIRGA_MATERIAL_ASPHALT, wet);
        const virga_spawn_gpu *spawns = (virga_spawn_gpu *)((virga_spawns_gpu *)f.spawns.mapped + 1);
        splash_fixture_step(&f, 1);
        memset(sums, 0, sizeof sums);
        for (uint32_t i = 0; i < f.state->staying; i++) {
            const virga_droplet_gpu *droplet = &f.droplets[i];
            const double sphere = M_PI / 6 * pow((double)droplet->diameter_m, 3);
            sums[droplet->id] += droplet->water_nl;
            assert_true(droplet->water_nl > 0);
            assert_float_equal(sphere / (droplet->water_nl * 1e-12), 1, 1e-4);
        }
        for (uint32_t i = 0; i < SPLASHES; i++)
            assert_int_equal(sums[i], spawns[i].water_nl);
    }
}

static void test_no_droplet_is_without_water_however_little_there_is(void **state)
{
    (void)state;
    splash_fixture_clear(&f);
    for (uint32_t water_nl = 1; water_nl <= 64; water_nl++)
        for (int i = 0; i < 16; i++)
            splash_fixture_spawn(&f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_5)->water_nl = water_nl;
    splash_fixture_step(&f, 1);
    assert_int_equal(splash_fixture_count(&f, VIRGA_SPLASH_FLOWN),
                     splash_fixture_count(&f, VIRGA_SPLASH_RETURNED) + splash_fixture_water(&f));
    assert_true(f.state->staying > 0);
    for (uint32_t i = 0; i < f.state->staying; i++)
        assert_in_range(f.droplets[i].water_nl, 1, 64);
}

/* ---- tests: the crown-cone, disks, drops that come in aslant */

/* Height of a crown as shaders/splash/shape.glsl has it: 0.045 We^1/2 diameters; it rises and falls as if thrown. */
static double crown_time(double diameter_m, double speed)
{
    const double weber = 998.2 * speed * speed * diameter_m / 0.0728;
    return 2 * sqrt(2 * 0.045 * sqrt(weber) * diameter_m / 9.80665);
}

static void test_the_droplet_of_a_cone_waits_until_its_crown_is_over(void **state)
{
    (void)state;
    throw_row(VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_10);
    const double wait_s = crown_time(2e-3, 6.5);
    assert_true(wait_s > 0.03 && wait_s < 0.08);
    const uint32_t ticks = (uint32_t)(wait_s / f.splash->def.tick_s);
    for (uint32_t i = 0; i < born.count; i++)
        assert_float_equal(f.droplets[i].age_s, -wait_s, 1e-6);
    for (uint32_t i = 0; i < ticks; i++)
        splash_fixture_step(&f, 1);
    for (uint32_t i = 0; i < born.count; i++)
        assert_true(f.droplets[i].position[1] == 0);
    splash_fixture_step(&f, 1);
    for (uint32_t i = 0; i < born.count; i++)
        assert_true(f.droplets[i].position[1] > 0);
}

static void test_the_droplet_of_a_cone_goes_straight_up_and_leaves_at_the_top(void **state)
{
    (void)state;
    throw_drops(VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_10);
    virga_spawn_gpu *spawns = (virga_spawn_gpu *)((virga_spawns_gpu *)f.spawns.mapped + 1);
    for (uint32_t i = 0; i < SPLASHES; i++) {
        spawns[i].velocity[0] = 4; /* wind and the drop's own way do not matter: section 4.2, step 3 */
        spawns[i].normal[0] = 0.1f, spawns[i].normal[1] = 0.995f;
    }
    f.wind[0] = 5;
    splash_fixture_step(&f, 1);
    for (int step = 0; step < 20; step++) { /* 0.3 s */
        splash_fixture_step(&f, 15);
        for (uint32_t i = 0; i < f.state->staying; i++) {
            const virga_droplet_gpu *droplet = &f.droplets[i];
            assert_true(droplet->velocity[0] == 0 && droplet->velocity[2] == 0);
            assert_true(droplet->position[0] == 0 && droplet->position[2] == 0);
            assert_int_equal(!(droplet->kind & VIRGA_DROPLET_FREE), droplet->velocity[1] > 0);
        }
    }
    f.wind[0] = 0;
}

static void test_disks_have_no_droplets(void **state)
{
    (void)state;
    throw_row(VIRGA_MATERIAL_STEEL, VIRGA_GROUND_DRY);
    assert_int_equal(born.count, 0);
    assert_int_equal(f.state->end_splash, SPLASHES);
    assert_int_equal(splash_fixture_count(&f, VIRGA_SPLASH_BY_MODEL + VIRGA_SPLASH_DISK * VIRGA_SPLASH_MATERIALS +
                                                  VIRGA_MATERIAL_STEEL),
                     SPLASHES);
    for (uint32_t i = 0; i < SPLASHES; i++) {
        assert_int_equal(VIRGA_DROPLET_MODEL(f.splashes[i].kind), VIRGA_SPLASH_DISK);
        assert_int_equal(f.splashes[i].kind >> 16, 0);
    }
}

/* What one impact far away stands for falls one after the other. */
static void test_a_splash_that_falls_ticks_later_waits_for_its_time(void **state)
{
    (void)state;
    splash_fixture_clear(&f);
    for (uint32_t i = 0; i < 100; i++)
        splash_fixture_spawn(&f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_3)->share = 3.5f;
    for (int tick = 0; tick < 3; tick++) {
        splash_fixture_step(&f, 1);
        for (uint32_t i = 0; i < f.state->staying; i++)
            assert_memory_equal(f.droplets[i].position, f.droplets[i].base, sizeof f.droplets[i].base);
    }
    const uint32_t before = f.state->staying;
    splash_fixture_step(&f, 1);
    assert_int_equal(f.state->staying + f.returns_head->count, before);
    for (uint32_t i = 0; i < f.state->staying; i++) {
        assert_float_equal(f.droplets[i].age_s, 0.5 * f.splash->def.tick_s, 1e-8);
        assert_true(f.droplets[i].position[1] > 0);
    }
}

/* 45 degrees at 6 m/s either way: droplets have a quarter of the 6 m/s beside their own speeds, whose mean over the
 * circle is zero. The epsilon is four deviations of that mean. */
static void test_drops_that_come_in_aslant_send_their_droplets_on(void **state)
{
    (void)state;
    double mean[2] = {0, 0};
    throw_drops(VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_3);
    virga_spawn_gpu *spawns = (virga_spawn_gpu *)((virga_spawns_gpu *)f.spawns.mapped + 1);
    for (uint32_t i = 0; i < SPLASHES; i++) {
        spawns[i].velocity[0] = 6;
        spawns[i].velocity[1] = -6;
    }
    splash_fixture_step(&f, 1);
    const uint32_t count = f.state->staying;
    for (uint32_t i = 0; i < count; i++) {
        mean[0] += (double)f.droplets[i].velocity[0] / count;
        mean[1] += (double)f.droplets[i].velocity[2] / count;
    }
    const double epsilon = 4 * 0.55 / sqrt(count);
    assert_float_equal(mean[0], f.settings.bounce * 6, epsilon);
    assert_float_equal(mean[1], 0, epsilon);
}

/* The same on a slope of 45 degrees that the drop meets head on: nothing of it is along the surface. */
static void test_drops_that_meet_a_slope_head_on_do_not(void **state)
{
    (void)state;
    double along = 0;
    throw_drops(VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_WET);
    virga_spawn_gpu *spawns = (virga_spawn_gpu *)((virga_spawns_gpu *)f.spawns.mapped + 1);
    for (uint32_t i = 0; i < SPLASHES; i++) {
        spawns[i].velocity[0] = 6;
        spawns[i].velocity[1] = -6;
        spawns[i].normal[0] = -(float)M_SQRT1_2;
        spawns[i].normal[1] = (float)M_SQRT1_2;
    }
    splash_fixture_step(&f, 1);
    const uint32_t count = f.state->staying;
    for (uint32_t i = 0; i < count; i++)
        along += M_SQRT1_2 * (double)(f.droplets[i].velocity[0] + f.droplets[i].velocity[1]) / count;
    assert_float_equal(along, 0, 4 * 0.55 / sqrt(count));
}

/* ---- */

static int open_all(void **state)
{
    (void)state;
    virga_splash_def def = virga_default_splash_def();
    def.max_splashes = 16384;
    def.max_droplets = 262144;
    def.max_spawns = 16384;
    def.max_returned_droplets = 16384;
    def.tick_s = 1e-3;
    splash_fixture_open(&f, &def);
    return 0;
}

static void test_spawns_that_no_device_can_bind_are_refused(void **state)
{
    (void)state;
    const VkCommandBuffer cmd = splash_fixture_begin(&f);
    virga_splash_step_info info = {.spawns = f.spawns.buffer, .first_tick = f.tick, .spawns_offset = 2};
    assert_int_equal(virga_splash_step(f.splash, cmd, &info), VIRGA_ERROR_INVALID);
    info.spawns_offset = 0;
    info.spawns_size = sizeof(virga_spawns_gpu) - 1;
    assert_int_equal(virga_splash_step(f.splash, cmd, &info), VIRGA_ERROR_INVALID);
    info.spawns_size = sizeof(virga_spawns_gpu) + 100 * sizeof(virga_spawn_gpu);
    assert_int_equal(virga_splash_step(f.splash, cmd, &info), VIRGA_OK);
    splash_fixture_submit(&f);
}

static double half_of(uint32_t bits)
{
    return ldexp(1024 + (bits & 1023), (int)(bits >> 10 & 31) - 25);
}

/* Its axes are those of the spawn's velocity when gravity has stopped it, and it lives twice as long. */
static void test_the_sheet_of_a_foot_rises_by_its_speed(void **state)
{
    (void)state;
    splash_fixture_clear(&f);
    virga_spawn_gpu *spawn = splash_fixture_spawn(&f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_5);
    spawn->kind = VIRGA_GROUND_PUDDLE_5 | VIRGA_SPLASH_CROWN_CONE << 16 | VIRGA_SPAWN_SHEET;
    spawn->velocity[0] = 3;
    spawn->velocity[1] = -1.5f;
    spawn->velocity[2] = 2;
    spawn->normal[0] = 0.6f;
    spawn->normal[1] = 0;
    spawn->normal[2] = 0.8f;
    spawn->water_nl = 0;
    splash_fixture_step(&f, 1);
    assert_int_equal(f.state->staying, 0);
    const virga_splash_gpu *splash = &f.splashes[f.state->tick_splash % f.splash->def.max_splashes];
    const double up_s = 1.5 / 9.80665;
    assert_true(splash->kind & VIRGA_SPLASH_OF_FOOT);
    assert_true(fabs((double)splash->life_s - 2 * up_s) < 1e-5 && splash->speed_m_s == 1.5f);
    assert_true(fabs(half_of(splash->lean) - 3 * up_s) < 1e-3 && fabs(half_of(splash->lean >> 16) - 2 * up_s) < 1e-3);
    assert_true(splash->normal[0] == 0.6f && splash->normal[2] == 0.8f);
    assert_true(splash->position[0] == spawn->position[0] && splash->position[2] == spawn->position[2]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_asphalt_has_the_rows_of_table_1),
        cmocka_unit_test(test_every_material_splashes_in_every_state_but_dry),
        cmocka_unit_test(test_only_steel_and_its_like_show_disks_when_they_are_dry),
        cmocka_unit_test(test_asphalt_throws_what_table_1_says),
        cmocka_unit_test(test_angles_and_speeds_are_normal_and_cut_at_two_deviations),
        cmocka_unit_test(test_every_material_throws_what_its_rows_say),
        cmocka_unit_test(test_angle_and_speed_of_a_droplet_know_nothing_of_each_other),
        cmocka_unit_test(test_piles_stand_on_the_circle_and_point_outwards),
        cmocka_unit_test(test_the_water_of_droplets_is_that_of_their_splash),
        cmocka_unit_test(test_no_droplet_is_without_water_however_little_there_is),
        cmocka_unit_test(test_the_droplet_of_a_cone_waits_until_its_crown_is_over),
        cmocka_unit_test(test_the_droplet_of_a_cone_goes_straight_up_and_leaves_at_the_top),
        cmocka_unit_test(test_disks_have_no_droplets),
        cmocka_unit_test(test_a_splash_that_falls_ticks_later_waits_for_its_time),
        cmocka_unit_test(test_drops_that_come_in_aslant_send_their_droplets_on),
        cmocka_unit_test(test_drops_that_meet_a_slope_head_on_do_not),
        cmocka_unit_test(test_spawns_that_no_device_can_bind_are_refused),
        cmocka_unit_test(test_the_sheet_of_a_foot_rises_by_its_speed),
    };
    const int failed = cmocka_run_group_tests(tests, open_all, NULL);
    return effect_fixture_close(failed + (int)splash_fixture_end(&f));
}
