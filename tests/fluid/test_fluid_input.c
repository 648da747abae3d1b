/* What a host may give: no particles, too many, at one position, outside the box, not finite. */
#include "fluid_fixture.h"

static fluid_fixture f;

static void set_up(void)
{
    fluid_fixture_open(&f);
    fluid_fixture_box(&f, 0.04, 0.4, 0.4, 0.4);
}

static virga_particle_gpu *put(uint32_t i, double x, double y, double z)
{
    virga_particle_gpu *particle = (virga_particle_gpu *)f.upload.mapped + i;
    *particle = (virga_particle_gpu){.position = {(float)x, (float)y, (float)z}};
    return particle;
}

static void no_water_takes_steps(void **state)
{
    (void)state;
    set_up();
    fluid_fixture_step(&f, 0.02);
    assert_int_equal(f.stats.frame_index, 1);
    assert_int_equal(f.stats.particles, 0);
    assert_int_equal(f.stats.substeps, 0);
    fluid_fixture_close(&f);
}

static void one_particle_falls_to_the_floor_and_stays(void **state)
{
    (void)state;
    set_up();
    put(0, 0.2, 0.3, 0.2);
    REQUIRE(fluid_fixture_try(&f, 0.1, 1, true) == VIRGA_OK);
    /* Of n substeps, each with its velocity at the end: g t^2 / 2 (1 + 1 / n). */
    const double fallen = 0.3 - (double)f.particles[0].position[1];
    REQUIRE(fabs(fallen - 0.5 * GRAVITY * 0.01 * (1 + 1.0 / f.stats.substeps)) < 1e-5);
    fluid_fixture_run(&f, 30);
    assert_float_equal(f.particles[0].position[1], 0, 0.02);
    assert_float_equal(f.particles[0].velocity[1], 0, 1e-6);
    fluid_fixture_close(&f);
}

static void particles_outside_the_box_or_not_finite_stay_out(void **state)
{
    (void)state;
    set_up();
    fluid_fixture_block(&f, 0, 0, 0, 0.4, 0.16, 0.4);
    put(0, 0.2, 0.5, 0.2);
    put(1, NAN, 0.1, 0.1);
    put(2, 0.1, INFINITY, 0.1);
    put(3, -1e30, 0.1, 0.1);
    put(4, 0.2, 0.3, 0.2)->velocity[2] = NAN;
    REQUIRE(fluid_fixture_try(&f, 1.0 / 60, 5, true) == VIRGA_OK);
    assert_int_equal(f.stats.particles, 400 + 5);
    assert_int_equal(f.stats.moved, 400 + 1);
    assert_float_equal(f.particles[400].position[1], 0.5, 0);
    assert_int_equal(f.particles[404].id, 404);
    assert_float_equal(f.particles[404].velocity[2], 0, 0);
    for (uint32_t i = 0; i < 400; i++)
        for (int axis = 0; axis < 3; axis++)
            REQUIRE(isfinite(f.particles[i].position[axis]) && isfinite(f.particles[i].velocity[axis]));
    fluid_fixture_close(&f);
}

/* Thousands of particles at one position cannot be simulated; they must cost little and break nothing. */
static void all_particles_at_one_position_break_nothing(void **state)
{
    (void)state;
    static virga_particle_gpu first[3000];
    for (int run = 0; run < 2; run++) {
        set_up();
        for (uint32_t i = 0; i < 3000; i++)
            put(i, 0.21, 0.21, 0.21);
        REQUIRE(fluid_fixture_try(&f, 0.02, 3000, true) == VIRGA_OK);
        assert_in_range(f.stats.moved, VIRGA_GRID_CELL_MAX - 100, VIRGA_GRID_CELL_MAX + 100);
        for (uint32_t i = 0; i < 3000; i++)
            for (int axis = 0; axis < 3; axis++)
                REQUIRE(f.particles[i].position[axis] >= 0 && f.particles[i].position[axis] <= 0.4f);
        if (run)
            assert_memory_equal(first, f.particles, sizeof first);
        memcpy(first, f.particles, sizeof first);
        fluid_fixture_close(&f);
    }
}

static void blocks_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    set_up();
    virga_fluid_block block = {.low_m = {0, 0, 0}, .high_m = {0.4f, 0.01f, 0.4f}};
    assert_int_equal(virga_fluid_add(f.fluid, &block), VIRGA_ERROR_INVALID); /* thinner than a particle */
    block.high_m[1] = 5000;
    assert_int_equal(virga_fluid_add(f.fluid, &block), VIRGA_ERROR_INVALID); /* too many particles */
    block.high_m[1] = NAN;
    assert_int_equal(virga_fluid_add(f.fluid, &block), VIRGA_ERROR_INVALID);
    block.high_m[1] = 0.04f;
    block.velocity_m_s[0] = 1e9f;
    assert_int_equal(virga_fluid_add(f.fluid, &block), VIRGA_ERROR_INVALID);
    block.velocity_m_s[0] = 0;
    for (int i = 0; i < FLUID_MAX_BLOCKS; i++)
        assert_int_equal(virga_fluid_add(f.fluid, &block), VIRGA_OK);
    assert_int_equal(virga_fluid_add(f.fluid, &block), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_fluid_add(f.fluid, NULL), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_fluid_clear(f.fluid), VIRGA_OK);
    fluid_fixture_step(&f, 0.01);
    assert_int_equal(f.stats.particles, 0);
    fluid_fixture_close(&f);
}

/* The host throws its command buffer away: an empty one goes to the queue in its place. */
static void lose_a_step(void)
{
    host_device *device = &f.gpu.device;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    const virga_fluid_step_info info = {.dt_s = 0.01f};
    REQUIRE(virga_fluid_step(f.fluid, cmd, &info) == VIRGA_OK);
    REQUIRE(vkEndCommandBuffer(cmd) == VK_SUCCESS);
    REQUIRE(vkResetCommandPool(device->device, device->frames[device->frame % HOST_FRAMES].pool, 0) == VK_SUCCESS);
    REQUIRE(vkBeginCommandBuffer(cmd, &begin) == VK_SUCCESS);
    REQUIRE(virga_frame_dropped(f.context, device->frame) == VIRGA_OK);
    effect_fixture_complete(&f.gpu, f.context);
}

static void blocks_of_a_lost_frame_are_added_again(void **state)
{
    (void)state;
    static virga_particle_gpu expected[500];
    for (int lost = 0; lost < 2; lost++) {
        set_up();
        fluid_fixture_block(&f, 0, 0, 0, 0.4, 0.12, 0.4);
        if (lost)
            lose_a_step();
        fluid_fixture_block(&f, 0, 0.2, 0, 0.4, 0.28, 0.4);
        fluid_fixture_step(&f, 0.01);
        assert_int_equal(f.stats.moved, 500);
        if (lost)
            assert_memory_equal(f.particles, expected, sizeof expected);
        memcpy(expected, f.particles, sizeof expected);
        fluid_fixture_close(&f);
    }
}

static void wrong_settings_are_refused(void **state)
{
    (void)state;
    set_up();
    virga_fluid_settings settings = f.settings;
    settings.high_m[1] = 0.1f; /* less than four spacings */
    assert_int_equal(virga_fluid_set(f.fluid, &settings), VIRGA_ERROR_INVALID);
    settings.high_m[1] = 9000; /* too many cells */
    assert_int_equal(virga_fluid_set(f.fluid, &settings), VIRGA_ERROR_INVALID);
    settings = f.settings;
    settings.gravity_m_s2[0] = NAN;
    assert_int_equal(virga_fluid_set(f.fluid, &settings), VIRGA_ERROR_INVALID);
    settings = f.settings;
    settings.cfl = 50;
    assert_int_equal(virga_fluid_set(f.fluid, &settings), VIRGA_DEGRADED);
    virga_fluid_get(f.fluid, &settings);
    assert_float_equal(settings.cfl, 1, 0);
    fluid_fixture_close(&f);
}

static void wrong_steps_are_refused(void **state)
{
    (void)state;
    set_up();
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    virga_fluid_step_info info = {.dt_s = -1};
    assert_int_equal(virga_fluid_step(f.fluid, cmd, &info), VIRGA_ERROR_INVALID);
    info.dt_s = NAN;
    assert_int_equal(virga_fluid_step(f.fluid, cmd, &info), VIRGA_ERROR_INVALID);
    info = (virga_fluid_step_info){.dt_s = 0.01f, .count = 5};
    assert_int_equal(virga_fluid_step(f.fluid, cmd, &info), VIRGA_ERROR_INVALID);
    info.particles = f.upload.buffer;
    info.count = f.fluid->def.max_particles + 1;
    assert_int_equal(virga_fluid_step(f.fluid, cmd, &info), VIRGA_ERROR_INVALID);
    info.count = 0;
    info.offset = 1;
    assert_int_equal(virga_fluid_step(f.fluid, cmd, &info), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_fluid_step(f.fluid, cmd, NULL), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_fluid_step(NULL, cmd, &info), VIRGA_ERROR_INVALID);
    info.offset = 0;
    assert_int_equal(virga_fluid_step(f.fluid, cmd, &info), VIRGA_OK);
    assert_int_equal(virga_fluid_step(f.fluid, cmd, &info), VIRGA_ERROR_INVALID); /* once a frame */
    effect_fixture_complete(&f.gpu, f.context);
    fluid_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_water_takes_steps),
        cmocka_unit_test(one_particle_falls_to_the_floor_and_stays),
        cmocka_unit_test(particles_outside_the_box_or_not_finite_stay_out),
        cmocka_unit_test(all_particles_at_one_position_break_nothing),
        cmocka_unit_test(blocks_that_do_not_fit_are_refused),
        cmocka_unit_test(blocks_of_a_lost_frame_are_added_again),
        cmocka_unit_test(wrong_settings_are_refused),
        cmocka_unit_test(wrong_steps_are_refused),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
