/* Wheels and feet: the water under them goes where a calculation in double precision says, and all of it is counted. */
#include "droplet_list.h"

#include <virga/shared/random.h>

#include <math.h>

#define TICK_S (1.0 / 60)

static void begin(uint32_t flow_ticks)
{
    open_level_ground(flow_ticks, virga_default_ground_def().max_spawns);
    ground_fixture_step(&f, 0);
}

static void end(void)
{
    close_level_ground();
}

/* Depths between two in millimetres, at random. */
static void fill(double low_mm, double high_mm, uint32_t seed)
{
    virga_cell_gpu *cells = f.upload.mapped;
    for (uint32_t i = 0; i < CELLS; i++)
        cells[i] = (virga_cell_gpu){
            (uint32_t)(1000 * NL_UM * (low_mm + (high_mm - low_mm) * (double)virga_unit(virga_hash2(seed, i)))), 0};
    ground_fixture_put(&f);
}

static double between(uint32_t i, uint32_t use, double low, double high)
{
    return low + (high - low) * (double)virga_unit(virga_hash2(i, use));
}

static virga_wheel wheel_at(double x, double z, double speed, double heading)
{
    virga_wheel wheel = virga_default_wheel();
    wheel.contact_m[0] = x;
    wheel.contact_m[2] = z;
    wheel.velocity_m_s[0] = (float)(speed * cos(heading));
    wheel.velocity_m_s[2] = (float)(speed * sin(heading));
    wheel.axle[0] = (float)-sin(heading);
    wheel.axle[2] = (float)cos(heading);
    return wheel;
}

static virga_foot foot_at(double x, double z, double down_m_s, double heading)
{
    virga_foot foot = virga_default_foot();
    foot.sole_m[0] = x;
    foot.sole_m[2] = z;
    foot.velocity_m_s[1] = (float)-down_m_s;
    foot.heading[0] = (float)cos(heading);
    foot.heading[2] = (float)sin(heading);
    return foot;
}

static void roll(const virga_wheel *wheel, uint32_t ticks)
{
    f.wheels = wheel;
    f.wheel_count = 1;
    ground_fixture_step(&f, ticks);
}

static uint64_t listed_nl(void)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < head()->count; i++)
        sum += droplets()[i].water_nl;
    return sum;
}

/* ---- the calculation: the pages that contact_plan.glsl cites, in double precision */

typedef struct reference {
    double half[2], ahead[2], at[2], swept, speed;
    double after[CELLS]; /* nl, by the index of a cell */
    double thrown;
} reference;

static reference expected;

/* 57.7: Mundo et al. 1995 */
static double flying_share(double deep_m, double speed)
{
    const double we = 998.2 * speed * speed * deep_m / 0.0728, re = speed * deep_m / 1e-6;
    return fmax(1 - 57.7 / (sqrt(we) * pow(re, 0.25)), 0);
}

static double tread_share(const virga_wheel *wheel, double tread)
{
    const double held_m = sqrt(0.0728 * (double)wheel->radius_m / (998.2 * tread * tread));
    return fmax(1 - held_m / 0.002075, 0) * (1 - exp(-(double)wheel->open_deg * M_PI / 180 / 0.44));
}

static void to_contact(int x, int z, double out[2])
{
    const double d[2] = {(x + 0.5) * CELL_M - expected.at[0], (z + 0.5) * CELL_M - expected.at[1]};
    out[0] = d[0] * expected.ahead[0] + d[1] * expected.ahead[1];
    out[1] = d[1] * expected.ahead[0] - d[0] * expected.ahead[1];
}

/* One cell of the wheel's strip. */
static void expect_cell(const virga_wheel *wheel, int x, int z, const double at[2])
{
    const uint32_t index = ground_fixture_index(&f, x, z);
    const double free_nl = (double)((virga_cell_gpu *)f.upload.mapped)[index].free_nl;
    const double moved = fmax(free_nl - FILM * NL_UM, 0), carried = fmin(moved, 2075 * NL_UM);
    const bool fresh = at[0] > expected.half[0] - expected.swept;
    const double tread = fresh ? carried * tread_share(wheel, expected.speed * (1 + (double)wheel->slip)) : 0;
    const double rest = moved - carried, sheet = rest * flying_share(rest / NL_UM * 1e-6, expected.speed);
    const uint32_t hash = virga_hash4(f.ground->def.seed ^ wheel->id * 0x9e3779b9u, (uint32_t)x, (uint32_t)z, f.tick);
    const double side = at[1] > 0 ? 1 : -1;
    const double out_m =
        expected.half[1] - at[1] * side + CELL_M * (0.55 + 0.9 * (double)virga_unit(virga_hash1(hash)));
    const double across = at[1] + side * out_m;
    const int to[2] = {(int)floor((expected.at[0] + at[0] * expected.ahead[0] - across * expected.ahead[1]) / CELL_M),
                       (int)floor((expected.at[1] + at[0] * expected.ahead[1] + across * expected.ahead[0]) / CELL_M)};
    expected.after[index] -= tread + rest;
    expected.after[ground_fixture_index(&f, to[0], to[1])] += rest - sheet;
    expected.thrown += tread + sheet;
}

static void expect(const virga_wheel *wheel)
{
    const virga_cell_gpu *cells = f.upload.mapped;
    expected = (reference){.half = {0.5 * (double)wheel->patch_m, 0.5 * (double)wheel->width_m}};
    expected.speed = hypot((double)wheel->velocity_m_s[0], (double)wheel->velocity_m_s[2]);
    expected.swept = expected.speed * TICK_S;
    for (int axis = 0; axis < 2; axis++) {
        expected.at[axis] = wheel->contact_m[2 * axis];
        expected.ahead[axis] = (double)wheel->velocity_m_s[2 * axis] / expected.speed;
    }
    for (uint32_t i = 0; i < CELLS; i++)
        expected.after[i] = cells[i].free_nl;
    for (int x = -SIDE / 2; x < SIDE / 2; x++)
        for (int z = -SIDE / 2; z < SIDE / 2; z++) {
            double at[2];
            to_contact(x, z, at);
            if (fabs(at[1]) <= expected.half[1] && at[0] <= expected.half[0] &&
                at[0] > -expected.half[0] - expected.swept)
                expect_cell(wheel, x, z, at);
        }
}

/* Cells that differ by more than a float's rounding. A target at the edge of a cell may be the one beside it. */
static uint32_t wrong_cells(void)
{
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < CELLS; i++)
        wrong += fabs((double)f.cells[i].free_nl - expected.after[i]) > 16 + 2e-6 * expected.after[i];
    return wrong;
}

/* ---- tests */

static void water_goes_where_the_calculation_says(void **state)
{
    (void)state;
    begin(60);
    for (uint32_t i = 0; i < 8; i++) {
        virga_wheel wheel =
            wheel_at(between(i, 1, -1, 1), between(i, 2, -1, 1), between(i, 3, 1, 30), between(i, 4, 0, 6.28));
        wheel.width_m = (float)between(i, 5, 0.05, 0.4);
        wheel.patch_m = (float)between(i, 6, 0.05, 0.3);
        wheel.slip = (float)between(i, 7, -0.5, 1);
        wheel.open_deg = (float)between(i, 8, 10, 180);
        wheel.id = i;
        empty_list(MAX_LISTED);
        fill(0, i % 2 ? 1.5 : 12, i);
        expect(&wheel);
        roll(&wheel, 1);
        const double thrown = (double)listed_nl();
        printf("wheel %u at %.1f m/s: %.1f ml fly, expected %.1f; %u droplets\n", i, expected.speed, 1e-6 * thrown,
               1e-6 * expected.thrown, head()->count);
        assert_in_range(wrong_cells(), 0, 2);
        REQUIRE(fabs(thrown - expected.thrown) <= 64 * 8 + 2e-6 * expected.thrown);
    }
    end();
}

static void check_droplet(const virga_handed_droplet_gpu *d, const virga_wheel *wheel)
{
    const double volume = M_PI / 6 * pow((double)d->diameter_m, 3);
    const double tread = expected.speed * (1 + (double)wheel->slip), up = (double)d->velocity[1];
    REQUIRE(d->water_nl > 0 && d->age_s > 0 && d->number < 64);
    REQUIRE(d->diameter_m >= 5e-5f && d->diameter_m <= 0.005001f);
    REQUIRE(fabs((double)d->drops * volume / (1e-12 * d->water_nl) - 1) < 1e-4);
    const double level = hypot((double)d->velocity[0], (double)d->velocity[2]);
    REQUIRE(level < fmax(1.5 * expected.speed, tread + 1) && up < fmax(tread, expected.speed) && up > -1);
    REQUIRE(hypot((double)d->position[0] - expected.at[0], (double)d->position[2] - expected.at[1]) < 1.5);
}

/* What is thrown to the left is thrown to the right, too; the sheet goes ahead and up. */
static void droplets_leave_by_the_wheels_speed(void **state)
{
    (void)state;
    double aside[2] = {0, 0}, ahead = 0, behind = 0;
    virga_wheel wheel = wheel_at(0, 0, 15, 0);
    begin(60);
    fill(6, 6, 1);
    expect(&wheel);
    roll(&wheel, 1);
    REQUIRE(head()->count > 200 && head()->group_count[0] == (head()->count + 63) / 64);
    for (uint32_t i = 0; i < head()->count; i++) {
        const virga_handed_droplet_gpu *d = &droplets()[i];
        check_droplet(d, &wheel);
        aside[d->velocity[2] > 0] += (double)fabsf(d->velocity[2]) * d->water_nl;
        ahead += d->velocity[2] * d->velocity[2] > 9 ? (double)d->velocity[0] * d->water_nl : 0;
        behind += d->position[0] < -0.05f ? (double)d->water_nl : 0;
    }
    REQUIRE(aside[0] > 0.8 * aside[1] && aside[1] > 0.8 * aside[0]);
    REQUIRE(ahead > 0 && behind > 0.2 * (double)listed_nl());
    end();
}

/* Wheels and feet at random, a list that is too short, and a step of several ticks. */
static uint32_t play_at_random(uint32_t seed)
{
    virga_wheel wheels[6];
    virga_foot feet[4];
    uint64_t thrown_nl = 0;
    uint32_t hash = seed;
    begin(4);
    fill(0, 15, seed);
    ground_fixture_step(&f, 0);
    const uint64_t start_nl = ground_fixture_sum(&f);
    f.wheels = wheels;
    f.feet = feet;
    for (uint32_t frame = 0; frame < 24; frame++) {
        const uint32_t key = virga_hash2(seed, frame);
        f.wheel_count = virga_hash2(key, 1) % 7;
        f.foot_count = virga_hash2(key, 2) % 5;
        f.handed_late_s = (float)between(key, 3, 0, 0.016);
        for (uint32_t i = 0; i < 6; i++)
            wheels[i] = wheel_at(between(key, 10 + i, -3.5, 3.5), between(key, 20 + i, -1, 1),
                                 between(key, 30 + i, 0, 40), between(key, 40 + i, 0, 6.28));
        for (uint32_t i = 0; i < 4; i++)
            feet[i] = foot_at(between(key, 50 + i, -1, 1), between(key, 60 + i, -1, 1), between(key, 70 + i, -1, 2),
                              between(key, 80 + i, 0, 6.28));
        empty_list(frame % 3 ? MAX_LISTED : 200);
        ground_fixture_step(&f, 1 + frame % 3);
        assert_in_range(head()->count, 0, head()->capacity);
        thrown_nl += listed_nl();
        assert_int_equal(ground_fixture_sum(&f) + thrown_nl, start_nl);
        for (uint32_t i = 0; i < head()->count * sizeof *droplets() / 4; i++)
            hash = virga_hash2(hash, ((const uint32_t *)(const void *)droplets())[i]);
        for (uint32_t i = 0; i < 2 * CELLS; i++)
            hash = virga_hash2(hash, ((const uint32_t *)(const void *)f.cells)[i]);
    }
    virga_ground_stats stats;
    virga_ground_stats_get(f.ground, &stats);
    printf("seed %u: %.2f l of %.1f l were thrown\n", seed, 1e-9 * (double)thrown_nl, 1e-9 * (double)start_nl);
    assert_int_equal(stats.thrown_nl, thrown_nl);
    REQUIRE(thrown_nl > start_nl / 50);
    end();
    return hash;
}

static void every_nanolitre_is_counted(void **state)
{
    (void)state;
    play_at_random(1);
}

static void the_same_frames_give_the_same_bits(void **state)
{
    (void)state;
    const uint32_t first = play_at_random(2);
    effect_device_set_threads("0");
    assert_int_equal(play_at_random(2), first);
}

/* 10 mm of water: the track is bare behind the wheel, and a puddle again a second later. */
static void a_track_is_dry_and_closes_again(void **state)
{
    (void)state;
    virga_wheel wheel = wheel_at(-1, 0.025, 10, 0);
    begin(4);
    fill(10, 10, 1);
    for (int i = 0; i < 6; i++) {
        wheel.contact_m[0] += 10 * TICK_S;
        empty_list(MAX_LISTED);
        roll(&wheel, 1);
    }
    const double bare_mm = ground_fixture_free(&f, -1, 0) / NL_UM / 1000;
    f.wheel_count = 0;
    for (int i = 0; i < 12; i++)
        ground_fixture_step(&f, 16);
    const double later_mm = ground_fixture_free(&f, -1, 0) / NL_UM / 1000;
    printf("10 mm of water: %.2f mm behind the wheel, %.2f mm after 3 s\n", bare_mm, later_mm);
    REQUIRE(bare_mm < 2 && later_mm > 7);
    end();
}

static void a_foot_presses_a_ring_of_water_out(void **state)
{
    (void)state;
    const virga_foot foot = foot_at(0, 0, 0.8, 0);
    double away = 0;
    begin(60);
    fill(4, 4, 1);
    ground_fixture_step(&f, 0);
    const uint64_t before = ground_fixture_sum(&f);
    f.feet = &foot;
    f.foot_count = 1;
    ground_fixture_step(&f, 1);
    assert_int_equal(before, ground_fixture_sum(&f) + listed_nl());
    REQUIRE(ground_fixture_free(&f, 0, 0) < 200000 && ground_fixture_free(&f, -1, -1) < 200000);
    for (uint32_t i = 0; i < head()->count; i++) {
        const virga_handed_droplet_gpu *d = &droplets()[i];
        away += (double)(d->velocity[0] * d->position[0] + d->velocity[2] * d->position[2] > 0) / head()->count;
        REQUIRE(fabsf(d->velocity[0]) < 10 && d->velocity[1] > -1 && d->velocity[1] < 8);
    }
    REQUIRE(head()->count > 20 && away > 0.9);
    /* It stands there: what flows in is pushed aside, and none flies. */
    virga_foot stands = foot_at(0, 0, 0, 0);
    f.feet = &stands;
    empty_list(MAX_LISTED);
    ground_fixture_step(&f, 8);
    assert_int_equal(head()->count, 0);
    end();
}

static void without_a_list_all_is_pushed_aside(void **state)
{
    (void)state;
    const virga_wheel wheel = wheel_at(0, 0, 20, 1);
    begin(60);
    fill(8, 8, 1);
    ground_fixture_step(&f, 0);
    const uint64_t before = ground_fixture_sum(&f);
    f.handed = VK_NULL_HANDLE;
    roll(&wheel, 1);
    assert_int_equal(ground_fixture_sum(&f), before);
    REQUIRE(ground_fixture_free(&f, -1, -1) < 2200 * NL_UM);
    f.handed = list.buffer;
    f.settings.contact_droplets = 0;
    REQUIRE(virga_ground_set(f.ground, &f.settings) == VIRGA_OK);
    ground_fixture_step(&f, 1);
    assert_int_equal(head()->count, 0);
    assert_int_equal(ground_fixture_sum(&f), before);
    end();
}

/* In the air, on another floor, or outside of the window. */
static void what_does_not_touch_moves_nothing(void **state)
{
    (void)state;
    virga_wheel wheel = wheel_at(0, 0, 20, 1);
    virga_foot foot = foot_at(0, 0, 1, 0);
    begin(60);
    fill(3, 3, 1);
    wheel.contact_m[1] = 0.2;
    foot.sole_m[1] = 0.01;
    f.feet = &foot;
    f.foot_count = 1;
    roll(&wheel, 1);
    wheel.contact_m[1] = 0;
    wheel.contact_m[0] = 1e9;
    foot.sole_m[2] = -1e9;
    roll(&wheel, 1);
    assert_int_equal(head()->count, 0);
    for (uint32_t i = 0; i < CELLS; i++)
        REQUIRE(f.cells[i].free_nl == 3000 * (uint32_t)NL_UM);
    end();
}

static void refuse(const virga_wheel *wheel, const virga_foot *foot, const char *line)
{
    virga_ground_step_info info = {.impacts = f.impacts.buffer,
                                   .first_tick = f.tick,
                                   .wheels = wheel,
                                   .wheel_count = wheel ? 1 : 0,
                                   .feet = foot,
                                   .foot_count = foot ? 1 : 0};
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    f.logged[0] = 0;
    assert_int_equal(virga_ground_step(f.ground, cmd, &info), VIRGA_ERROR_INVALID);
    if (!strstr(f.logged, line))
        fail_msg("'%s' is not in '%s'", line, f.logged);
    ground_fixture_submit(&f);
}

static void wrong_ones_are_refused_with_a_line(void **state)
{
    (void)state;
    begin(4);
    virga_wheel wheel = virga_default_wheel();
    virga_foot foot = virga_default_foot();
    wheel.radius_m = 0;
    refuse(&wheel, NULL, "wheels[0].radius_m: expected 0.01 to 3, got 0");
    wheel = virga_default_wheel();
    wheel.axle[0] = 0;
    refuse(&wheel, NULL, "wheels[0].axle: expected a direction that is not vertical");
    wheel.axle[0] = NAN;
    refuse(&wheel, NULL, "wheels");
    foot.velocity_m_s[1] = 2000;
    refuse(NULL, &foot, "feet[0].velocity_m_s: expected -1000 to 1000, got 2000");
    foot = virga_default_foot();
    foot.length_m = NAN;
    refuse(NULL, &foot, "feet[0].length_m: expected 0.01 to 2");
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(water_goes_where_the_calculation_says),
        cmocka_unit_test(droplets_leave_by_the_wheels_speed),
        cmocka_unit_test(every_nanolitre_is_counted),
        cmocka_unit_test(the_same_frames_give_the_same_bits),
        cmocka_unit_test(a_track_is_dry_and_closes_again),
        cmocka_unit_test(a_foot_presses_a_ring_of_water_out),
        cmocka_unit_test(without_a_list_all_is_pushed_aside),
        cmocka_unit_test(what_does_not_touch_moves_nothing),
        cmocka_unit_test(wrong_ones_are_refused_with_a_line),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
