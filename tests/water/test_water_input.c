/* What a host or a damaged file may give: no particles, too many, at one position, far away, not finite. */
#include "water_fixture.h"

static water_fixture f;

static void set_up(void)
{
    water_fixture_open(&f);
    f.settings.spacing_m = 0.02f;
    REQUIRE(virga_water_set(f.water, &f.settings) == VIRGA_OK);
}

static void put_ball(void)
{
    const double center[3] = {0, 0, 0};
    water_fixture_ball(&f, center, 0.1, 0.02);
}

static void no_particles_have_no_surface(void **state)
{
    (void)state;
    set_up();
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    const virga_water_step_info info = {.count = 0};
    REQUIRE(virga_water_step(f.water, cmd, &info) == VIRGA_OK);
    effect_fixture_complete(&f.gpu, f.context);
    virga_water_stats_get(f.water, &f.stats);
    assert_int_equal(f.stats.frame_index, 1);
    assert_int_equal(f.stats.surfels, 0);
    water_fixture_close(&f);
}

static void positions_that_are_not_finite_are_left_out(void **state)
{
    (void)state;
    set_up();
    put_ball();
    water_fixture_step(&f);
    const uint32_t surfels = f.stats.surfels, count = f.count;
    water_fixture_add(&f, NAN, 0, 0);
    water_fixture_add(&f, 0, INFINITY, 0);
    water_fixture_add(&f, 0, 0, -1e30);
    water_fixture_add(&f, 0, 0, 0)->share = NAN;
    water_fixture_step(&f);
    assert_int_equal(f.stats.invalid, 3);
    assert_int_equal(f.stats.in_grid, count);
    assert_int_equal(f.stats.surfels, surfels);
    water_fixture_close(&f);
}

static void velocities_that_are_not_finite_count_as_rest(void **state)
{
    (void)state;
    set_up();
    put_ball();
    for (uint32_t i = 0; i < f.count; i++)
        f.particles[i].velocity[i % 3] = i % 2 ? NAN : INFINITY;
    water_fixture_step(&f);
    for (uint32_t i = 0; i < f.stats.surfels; i++)
        assert_float_equal(f.surfels[i].velocity[0], 0, 0);
    water_fixture_close(&f);
}

/* Without thinning this would be 64 million pairs a pass. */
static void all_particles_at_one_position_are_thinned_out_alike_in_every_run(void **state)
{
    (void)state;
    float first = 0;
    set_up();
    while (f.count < f.water->def.max_particles)
        water_fixture_add(&f, 0.01, 0.01, 0.01);
    for (int i = 0; i < 3; i++) {
        water_fixture_step(&f);
        assert_in_range(f.stats.in_grid, VIRGA_GRID_CELL_MAX - 100, VIRGA_GRID_CELL_MAX + 100);
        float max = 0;
        for (uint32_t k = 0; k < f.count; k++)
            max = fmaxf(max, f.densities[k]);
        first = i ? first : max;
        assert_float_equal(max, first, 0);
    }
    /* Their volume stays. */
    const double alone = 315 / (64 * M_PI * 8);
    assert_float_equal((double)first, alone * f.count, 1e-3 * alone * f.count);
    water_fixture_close(&f);
}

static void particles_far_from_the_others_do_not_cost_the_others_their_surface(void **state)
{
    (void)state;
    set_up();
    put_ball();
    water_fixture_step(&f);
    const uint32_t surfels = f.stats.surfels, count = f.count;
    water_fixture_add(&f, 900, 0, 0);
    water_fixture_add(&f, 0, -2000, 0);
    water_fixture_add(&f, 30, 40, 50);
    water_fixture_step(&f);
    assert_int_equal(f.stats.surfels, surfels);
    assert_int_equal(f.stats.in_grid, count);
    assert_int_equal(f.stats.invalid, 0);
    water_fixture_close(&f);
}

static void more_particles_than_there_is_room_for_are_said(void **state)
{
    (void)state;
    set_up();
    put_ball();
    const uint32_t count = f.count;
    f.count = f.water->def.max_particles + 1;
    assert_int_equal(water_fixture_try(&f), VIRGA_DEGRADED);
    f.count = count;
    water_fixture_step(&f);
    water_fixture_close(&f);
}

typedef struct log_lines {
    bool blocks, surfels;
} log_lines;

static void note_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    log_lines *lines = user;
    const bool dropped = level == VIRGA_LOG_WARNING && id == VIRGA_LOG_CLAMPED;
    lines->blocks = lines->blocks || (dropped && strstr(text, "water_def.max_blocks is 64"));
    lines->surfels = lines->surfels || (dropped && strstr(text, "water_def.max_surfels is 256"));
}

static void too_few_blocks_and_surfels_are_counted_and_said(void **state)
{
    (void)state;
    virga_water_def def = water_fixture_def();
    def.max_blocks = 64;
    def.max_surfels = 256;
    water_fixture_open_with(&f, &def, false);
    f.settings.spacing_m = 0.02f;
    log_lines lines = {0};
    f.context->log = (virga_log){note_line, &lines};
    put_ball();
    water_fixture_step(&f);
    assert_int_equal(f.stats.surfels, 256);
    assert_int_equal(f.stats.blocks, 64);
    REQUIRE(f.stats.surfels_dropped > 0 && f.stats.blocks_dropped > 0);
    REQUIRE(lines.blocks && lines.surfels);
    f.context->log = (virga_log){effect_fixture_log, NULL};
    water_fixture_close(&f);
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    set_up();
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    virga_water_step_info info = {.count = 5};
    assert_int_equal(virga_water_step(f.water, cmd, &info), VIRGA_ERROR_INVALID);
    info.particles = f.particle_buffer.buffer;
    info.offset = 1;
    assert_int_equal(virga_water_step(f.water, cmd, &info), VIRGA_ERROR_INVALID);
    info.offset = 0;
    info.origin_m[1] = NAN;
    assert_int_equal(virga_water_step(f.water, cmd, &info), VIRGA_ERROR_INVALID);
    info.origin_m[1] = 0;
    assert_int_equal(virga_water_step(f.water, cmd, NULL), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_water_step(NULL, cmd, &info), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_water_step(f.water, cmd, &info), VIRGA_OK);
    assert_int_equal(virga_water_step(f.water, cmd, &info), VIRGA_ERROR_INVALID); /* once a frame */
    effect_fixture_complete(&f.gpu, f.context);
    f.settings.level = NAN;
    assert_int_equal(virga_water_set(f.water, &f.settings), VIRGA_ERROR_INVALID);
    f.settings.level = 2;
    assert_int_equal(virga_water_set(f.water, &f.settings), VIRGA_DEGRADED);
    virga_water_get(f.water, &f.settings);
    assert_float_equal(f.settings.level, 0.95, 1e-6);
    water_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_particles_have_no_surface),
        cmocka_unit_test(positions_that_are_not_finite_are_left_out),
        cmocka_unit_test(velocities_that_are_not_finite_count_as_rest),
        cmocka_unit_test(all_particles_at_one_position_are_thinned_out_alike_in_every_run),
        cmocka_unit_test(particles_far_from_the_others_do_not_cost_the_others_their_surface),
        cmocka_unit_test(more_particles_than_there_is_room_for_are_said),
        cmocka_unit_test(too_few_blocks_and_surfels_are_counted_and_said),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
