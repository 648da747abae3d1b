/* test_splash_draw.c - settings and light in the picture of splashes, and prepares and draws one after another. */
#include "splash_picture_fixture.h"

/* ---- settings and light */

static void with_no_gain_nothing_is_drawn(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    for (int style = 0; style < 2; style++) {
        s.f.settings.style = (virga_splash_style)style;
        s.f.settings.gain = 1;
        apply_settings(&s);
        aim(&s, (const double[3]){0, 0.02, 0.06}, nowhere);
        put_crown(&s);
        assert_true(drawn_alpha(&s) > 1);
        s.f.settings.gain = 0;
        apply_settings(&s);
        assert_true(drawn_alpha(&s) == 0);
        put_pile(&s, 0);
        assert_true(drawn_alpha(&s) == 0);
        put_flying(&s, 3e-3, nowhere, at_rest);
        assert_true(drawn_alpha(&s) == 0);
    }
    close_shot(&s);
}

static void what_is_near_the_camera_fades(void **state)
{
    (void)state;
    static const double distances[5] = {0.15, 0.09, 0.12, 0.2, 0.3}, shares[5] = {0.5, 0, 0.2, 1, 1};
    shot s;
    open_shot(&s);
    for (int i = 0; i < 5; i++) {
        s.f.settings.near_fade_m = 0;
        apply_settings(&s);
        put_flying(&s, 3e-3, nowhere, at_rest);
        aim_from(&s, distances[i]);
        const double whole = drawn_alpha(&s);
        s.f.settings.near_fade_m = 0.1f;
        apply_settings(&s);
        assert_true(fabs(drawn_alpha(&s) / whole - shares[i]) < 0.01);
    }
    close_shot(&s);
}

static void lamps_brighten_droplets_and_change_no_coverage(void **state)
{
    (void)state;
    static const double distances[2] = {0.05, 0.5}; /* wide, thin */
    shot s;
    open_shot(&s);
    put_flying(&s, 3e-3, nowhere, at_rest);
    s.f.settings.lighting.lights[0] = (virga_light){.position_m = {0, 0, -1}, .intensity = {1, 2, 0}};
    for (int i = 0; i < 2; i++) {
        double more[3] = {0};
        aim_from(&s, distances[i]);
        s.f.settings.lighting.light_count = 0;
        apply_settings(&s);
        float *dark = copy_of(&s, draw_frame(&s));
        s.f.settings.lighting.light_count = 1;
        apply_settings(&s);
        const float *lit = draw_frame(&s);
        for (size_t j = 0; j < pixel_count(&s); j++)
            assert_true(lit[j * 4 + 3] == dark[j * 4 + 3]);
        for (int c = 0; c < 3; c++)
            more[c] = sum_of(&s, lit, c) - sum_of(&s, dark, c);
        assert_true(more[0] > 0.2 * sum_of(&s, dark, 0));
        assert_near(more[1], 2 * more[0], 0.02);
        assert_true(fabs(more[2]) < 1e-3 * more[0]);
        free(dark);
        s.f.settings.light_gain = 1;
    }
    close_shot(&s);
}

/* 44 px wide before red on the left, green on the right and blue above: it stands all on its head. */
static void a_wide_droplet_shows_the_scene_on_its_head(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    memset(s.f.settings.lighting.environment_sh, 0, sizeof s.f.settings.lighting.environment_sh);
    apply_settings(&s);
    put_flying(&s, 10e-3, nowhere, at_rest);
    aim_from(&s, 0.04);
    assert_true(sum_of(&s, draw_frame(&s), 0) == 0); /* the environment is black */
    s.give_color = true;
    const float *pixels = draw_frame(&s);
    double left[3] = {0}, right[3] = {0}, above[3] = {0}, below[3] = {0};
    for (size_t i = 0; i < pixel_count(&s); i++)
        for (size_t c = 0; c < 3; c++) {
            (i % SIDE < SIDE / 2 ? left : right)[c] += (double)pixels[i * 4 + c];
            (i / SIDE < SIDE / 2 ? above : below)[c] += (double)pixels[i * 4 + c];
        }
    printf("left: red %.1f, green %.1f; right: red %.1f, green %.1f; blue above %.1f, below %.1f\n", left[0], left[1],
           right[0], right[1], above[2], below[2]);
    assert_true(left[1] > 20 && left[1] > 10 * left[0]);
    assert_true(right[0] > 20 && right[0] > 10 * right[1]);
    assert_true(below[2] > 20 && below[2] > 10 * above[2]);
    close_shot(&s);
}

/* 0.735 is what the curve of sRGB makes of 0.5. */
static void a_droplet_decodes_an_encoded_picture(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    put_flying(&s, 10e-3, nowhere, at_rest);
    aim_from(&s, 0.04);
    s.give_color = true;
    s.even = 0.5f;
    const double light = sum_of(&s, draw_frame(&s), 0);
    s.even = 0.735357f;
    const double wrong = sum_of(&s, draw_frame(&s), 0);
    s.encoding = VIRGA_ENCODING_SRGB;
    const double decoded = sum_of(&s, draw_frame(&s), 0);
    printf("light %.3f, of the encoded picture %.3f, and %.3f if it is not decoded\n", light, decoded, wrong);
    assert_true(fabs(decoded / light - 1) < 1e-4 && wrong > 1.2 * light);
    close_shot(&s);
}

/* ---- prepares and draws */

static void assert_nothing(const shot *s, const float *pixels)
{
    for (int c = 0; c < 4; c++)
        assert_true(sum_of(s, pixels, c) == 0);
}

static void without_a_prepare_in_this_frame_nothing_is_drawn(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    aim_from(&s, 0.1);
    put_flying(&s, 3e-3, nowhere, at_rest);
    assert_true(drawn_alpha(&s) > 1);
    VkCommandBuffer cmd = splash_fixture_begin(&s.f); /* the prepare was in the frame before */
    record_empty(&s, cmd);
    assert_int_equal(record_layer(&s, cmd, HOST_LAYER), VIRGA_NOT_READY);
    assert_nothing(&s, finish_frame(&s, cmd));
    cmd = splash_fixture_begin(&s.f); /* a prepare that did not go well leaves none */
    record_empty(&s, cmd);
    REQUIRE(prepare(&s, cmd) == VIRGA_OK);
    virga_view view = view_of(&s);
    view.viewport[2] = 0;
    assert_int_equal(virga_splash_prepare(s.f.splash, cmd, &view, virga_splash_time(s.f.splash)), VIRGA_NOT_READY);
    assert_int_equal(record_layer(&s, cmd, HOST_LAYER), VIRGA_NOT_READY);
    assert_nothing(&s, finish_frame(&s, cmd));
    cmd = splash_fixture_begin(&s.f); /* and what a step has changed is to be prepared again */
    record_empty(&s, cmd);
    REQUIRE(prepare(&s, cmd) == VIRGA_OK);
    const virga_splash_step_info info = {.spawns = s.f.spawns.buffer, .first_tick = s.f.tick};
    REQUIRE(virga_splash_step(s.f.splash, cmd, &info) == VIRGA_OK);
    assert_int_equal(record_layer(&s, cmd, HOST_LAYER), VIRGA_NOT_READY);
    assert_nothing(&s, finish_frame(&s, cmd));
    assert_true(drawn_alpha(&s) > 1);
    close_shot(&s);
}

static void into_a_target_not_attached_nothing_is_drawn(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    aim_from(&s, 0.1);
    put_flying(&s, 3e-3, nowhere, at_rest);
    virga_target *attached = s.layer;
    REQUIRE(virga_target_create(s.f.context, &s.layer_def, &s.layer) == VIRGA_OK);
    VkCommandBuffer cmd = splash_fixture_begin(&s.f);
    record_empty(&s, cmd);
    REQUIRE(prepare(&s, cmd) == VIRGA_OK);
    assert_int_equal(record_layer(&s, cmd, HOST_LAYER), VIRGA_NOT_READY);
    assert_nothing(&s, finish_frame(&s, cmd));
    REQUIRE(virga_splash_attach(s.f.splash, s.layer) == VIRGA_OK);
    assert_true(drawn_alpha(&s) > 1);
    virga_target_destroy(&attached);
    close_shot(&s);
}

static void aim_of_view(shot *s, int view)
{
    aim(s, (const double[3]){view ? 0.08 : 0, 0.03, view ? 0.01 : 0.06}, (const double[3]){0, 0.01, 0});
}

/* Droplets, one with a pile, and a crown: all there is to see. */
static void put_all(shot *s)
{
    splash_fixture_clear(&s->f);
    for (uint32_t i = 0; i < 3; i++)
        splash_fixture_spawn(&s->f, VIRGA_MATERIAL_ASPHALT, i ? VIRGA_GROUND_PUDDLE_5 : VIRGA_GROUND_PUDDLE_10);
    splash_fixture_step(&s->f, 1);
}

static void two_views_of_a_frame_both_come_out_right(void **state)
{
    (void)state;
    shot s;
    float *alone[2];
    open_shot(&s);
    put_all(&s);
    for (int view = 0; view < 2; view++) {
        aim_of_view(&s, view);
        alone[view] = copy_of(&s, draw_frame(&s));
        assert_true(sum_of(&s, alone[view], 3) > 20);
        assert_in_range(prepared(&s)->sprites, 2, FEW_SPRITES);
    }
    assert_memory_not_equal(alone[0], alone[1], pixel_count(&s) * 16);
    const VkCommandBuffer cmd = splash_fixture_begin(&s.f);
    record_plate(&s, cmd);
    for (int view = 0; view < 2; view++) {
        aim_of_view(&s, view);
        REQUIRE(prepare(&s, cmd) == VIRGA_OK);
        REQUIRE(record_layer(&s, cmd, view ? SECOND_LAYER : HOST_LAYER) == VIRGA_OK);
    }
    finish_frame(&s, cmd);
    for (int view = 0; view < 2; view++) {
        const host_output output = view ? SECOND_LAYER : HOST_LAYER;
        assert_memory_equal(host_target_floats(&s.f.gpu.device, &s.picture, output), alone[view], pixel_count(&s) * 16);
        free(alone[view]);
    }
    close_shot(&s);
}

static void more_views_than_there_is_room_for_are_refused(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    aim_from(&s, 0.1);
    put_flying(&s, 3e-3, nowhere, at_rest);
    for (int frame = 0; frame < 2; frame++) {
        const VkCommandBuffer cmd = splash_fixture_begin(&s.f);
        record_empty(&s, cmd);
        record_plate(&s, cmd);
        for (int view = 0; view < VIRGA_SPLASH_MAX_VIEWS; view++)
            assert_int_equal(prepare(&s, cmd), VIRGA_OK);
        assert_int_equal(record_layer(&s, cmd, SECOND_LAYER), VIRGA_OK);
        assert_int_equal(prepare(&s, cmd), VIRGA_ERROR_INVALID);
        assert_int_equal(record_layer(&s, cmd, HOST_LAYER), VIRGA_NOT_READY);
        assert_nothing(&s, finish_frame(&s, cmd));
        assert_true(sum_of(&s, host_target_floats(&s.f.gpu.device, &s.picture, SECOND_LAYER), 3) > 1);
    }
    close_shot(&s);
}

static void the_same_frame_twice_gives_the_same_bits(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    s.shutter_s = 1.0 / 96;
    s.give_color = s.give_depth = true;
    for (int style = 0; style < 2; style++) {
        s.f.settings.style = (virga_splash_style)style;
        apply_settings(&s);
        put_all(&s);
        aim_of_view(&s, 0);
        float *first = copy_of(&s, draw_frame(&s));
        assert_true(sum_of(&s, first, 3) > 20);
        assert_memory_equal(draw_frame(&s), first, pixel_count(&s) * 16);
        free(first);
    }
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(with_no_gain_nothing_is_drawn),
        cmocka_unit_test(what_is_near_the_camera_fades),
        cmocka_unit_test(lamps_brighten_droplets_and_change_no_coverage),
        cmocka_unit_test(a_wide_droplet_shows_the_scene_on_its_head),
        cmocka_unit_test(a_droplet_decodes_an_encoded_picture),
        cmocka_unit_test(without_a_prepare_in_this_frame_nothing_is_drawn),
        cmocka_unit_test(into_a_target_not_attached_nothing_is_drawn),
        cmocka_unit_test(two_views_of_a_frame_both_come_out_right),
        cmocka_unit_test(more_views_than_there_is_room_for_are_refused),
        cmocka_unit_test(the_same_frame_twice_gives_the_same_bits),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
