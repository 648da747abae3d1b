/* test_lens_input.c - what hosts and pictures may get wrong, and the draw into a target. */
#include "lens_drawn.h"

static void colors_that_are_not_numbers_are_black_and_infinite_ones_are_bright(void **state)
{
    (void)state;
    for (int paper = 0; paper < 2; paper++) {
        lens_fixture f;
        lens_fixture_open(&f, 32, 32, false);
        f.settings.style = paper ? VIRGA_LENS_STYLE_PAPER : VIRGA_LENS_STYLE_PHYSICAL;
        lens_paint_all(&f.scene, 0.5f, 0.5);
        lens_paint(&f.scene, 8, 8, NAN, 0.5);
        lens_paint(&f.scene, 16, 16, INFINITY, 0.5);
        lens_fixture_run(&f);
        for (size_t i = 0; i < 4u * 32 * 32; i++)
            assert_true(isfinite(f.result[i]) && f.result[i] >= 0);
        assert_true(lens_result(&f, 16, 16) > 100);
        lens_fixture_close(&f);
    }
}

/* A depth that is no number counts as infinitely far. */
static void depths_that_are_not_numbers_spoil_nothing(void **state)
{
    (void)state;
    for (int paper = 0; paper < 2; paper++)
        for (int halved = 0; halved < 2; halved++) {
            lens_fixture f;
            lens_fixture_open(&f, 32, 32, halved);
            f.settings.style = paper ? VIRGA_LENS_STYLE_PAPER : VIRGA_LENS_STYLE_PHYSICAL;
            lens_paint_all(&f.scene, 0.5f, 1);
            f.scene.depth[8 * 32 + 8] = NAN;
            f.scene.depth[20 * 32 + 20] = INFINITY;
            f.scene.depth[20 * 32 + 8] = -INFINITY;
            const lens_picture *layer = lens_fixture_layer(&f, 0);
            lens_paint(layer, 16, 16, NAN, 0.5);
            lens_paint(layer, 24, 8, 0.25f, 1);
            layer->depth[8 * 32 + 24] = NAN;
            lens_fixture_run(&f);
            for (size_t i = 0; i < 4u * 32 * 32; i++)
                assert_true(isfinite(f.result[i]) && f.result[i] >= 0 && f.result[i] <= 1.01f);
            assert_float_equal(lens_result(&f, 2, 30), 0.5, 1e-3);
            lens_fixture_close(&f);
        }
}

static void a_picture_of_one_pixel_is_itself(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        lens_fixture f;
        lens_fixture_open(&f, 1, 1, kind & 1);
        f.settings.style = kind & 2 ? VIRGA_LENS_STYLE_PAPER : VIRGA_LENS_STYLE_PHYSICAL;
        lens_paint_all(&f.scene, 3, 0.2);
        lens_fixture_run(&f);
        assert_float_equal(lens_result(&f, 0, 0), 3, 2e-3);
        lens_fixture_close(&f);
    }
}

static void both_kinds_of_depth_buffers_give_the_same_picture(void **state)
{
    (void)state;
    lens_fixture f;
    uint32_t hash = 77;
    float reversed[4 * 32 * 32];
    lens_fixture_open(&f, 32, 32, false);
    f.settings.max_radius_px = 6;
    for (uint32_t y = 0; y < 32; y++)
        for (uint32_t x = 0; x < 32; x++)
            lens_paint(&f.scene, x, y, (float)lens_random(&hash), 0.6 + 3 * lens_random(&hash));
    lens_fixture_run(&f);
    memcpy(reversed, f.result, sizeof reversed);
    /* depth = far / (far - near) - near far / (far - near) / z */
    const float near = 0.1f, far = 100, a = far / (far - near);
    f.view.clip_from_view[10] = -a;
    f.view.clip_from_view[14] = -a * near;
    memcpy(f.view.open_clip_from_view, f.view.clip_from_view, sizeof f.view.clip_from_view);
    f.view.reversed_depth = false;
    for (size_t i = 0; i < 32 * 32; i++)
        f.scene.depth[i] = a - a * near * f.scene.depth[i];
    lens_fixture_run(&f);
    for (size_t i = 0; i < 4u * 32 * 32; i++)
        assert_float_equal(f.result[i], reversed[i], 2e-3);
    lens_fixture_close(&f);
}

static void the_same_picture_gives_the_same_bits(void **state)
{
    (void)state;
    lens_fixture f;
    uint32_t hash = 78;
    float first[4 * 32 * 32];
    lens_fixture_open(&f, 32, 32, true);
    for (uint32_t y = 0; y < 32; y++)
        for (uint32_t x = 0; x < 32; x++)
            lens_paint(&f.scene, x, y, (float)lens_random(&hash), 0.2 + 3 * lens_random(&hash));
    lens_fixture_run(&f);
    memcpy(first, f.result, sizeof first);
    lens_fixture_run(&f);
    assert_memory_equal(first, f.result, sizeof first);
    lens_fixture_close(&f);
}

static void wrong_arguments_are_refused_with_a_line(void **state)
{
    (void)state;
    lens_fixture f;
    virga_lens_layer layer = {0};
    lens_fixture_open(&f, 16, 16, false);
    lens_paint_all(&f.scene, 0.5f, 1);
    lens_fixture_run(&f);
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    virga_view no_color = virga_default_view(), large = f.view;
    memcpy(no_color.clip_from_view, f.view.clip_from_view, sizeof no_color.clip_from_view);
    memcpy(no_color.open_clip_from_view, f.view.clip_from_view, sizeof no_color.clip_from_view);
    no_color.reversed_depth = true;
    memcpy(no_color.viewport, f.view.viewport, sizeof no_color.viewport);
    large.viewport[2] = 64;
    assert_int_equal(virga_lens_prepare(NULL, cmd, &f.view, NULL, 0, 0), VIRGA_ERROR_INVALID);
    const uint32_t lines = f.log_lines;
    assert_int_equal(virga_lens_prepare(f.lens, cmd, NULL, NULL, 0, 0), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_lens_prepare(f.lens, cmd, &no_color, NULL, 0, 0), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_lens_prepare(f.lens, cmd, &large, NULL, 0, 0), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_lens_prepare(f.lens, cmd, &f.view, NULL, 1, 0), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_lens_prepare(f.lens, cmd, &f.view, &layer, 1, 0), VIRGA_ERROR_INVALID);
    layer.color = f.view.color;
    assert_int_equal(virga_lens_prepare(f.lens, cmd, &f.view, &layer, 1, 0), VIRGA_ERROR_INVALID); /* no depth */
    assert_int_equal(f.log_lines - lines, 6);
    effect_fixture_complete(&f.gpu, f.context);
    f.settings.focus_m = NAN;
    assert_int_equal(virga_lens_set(f.lens, &f.settings), VIRGA_ERROR_INVALID);
    f.settings.focus_m = 1;
    f.settings.max_radius_px = 1000;
    assert_int_equal(virga_lens_set(f.lens, &f.settings), VIRGA_DEGRADED);
    lens_fixture_close(&f);
}

static void radii_beyond_the_work_image_are_cut_with_a_line(void **state)
{
    (void)state;
    for (uint32_t half = 0; half < 2; half++) {
        lens_fixture f;
        lens_fixture_open(&f, 16, 16, half);
        f.settings.max_radius_px = 63;
        assert_int_equal(virga_lens_set(f.lens, &f.settings), VIRGA_OK);
        f.settings.max_radius_px = 126;
        const uint32_t lines = f.log_lines;
        assert_int_equal(virga_lens_set(f.lens, &f.settings), half ? VIRGA_OK : VIRGA_DEGRADED);
        assert_int_equal(f.log_lines - lines, half ? 0 : 1);
        assert_true(half || strstr(f.log[lines % 8], "max_radius_px, at full resolution"));
        lens_fixture_close(&f);
    }
}

/* ---- the draw */

static void a_draw_puts_the_picture_into_its_viewport(void **state)
{
    (void)state;
    lens_fixture f;
    lens_drawn made = {0};
    host_image color;
    lens_fixture_open(&f, 24, 20, false);
    lens_create_drawn(&f, &made);
    lens_paint_all(&f.scene, 0.5f, 1);
    lens_paint(&f.scene, 10, 9, 4, 1);
    f.view.color = lens_upload(&f, &f.scene, false, &color);
    f.view.viewport[0] = 4;
    f.view.viewport[1] = 2;
    f.view.viewport[2] = 16;
    f.view.viewport[3] = 12;
    VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    REQUIRE(virga_lens_prepare(f.lens, cmd, &f.view, NULL, 0, 0) == VIRGA_OK);
    assert_int_equal(lens_draw_and_read(&f, &made, cmd, LENS_WHOLE), VIRGA_OK);
    const uint16_t *halves = f.download.mapped;
    for (uint32_t y = 0; y < 20; y++)
        for (uint32_t x = 0; x < 24; x++) {
            const bool inside = x >= 4 && x < 20 && y >= 2 && y < 14;
            const double expected = !inside ? 9 : x == 10 && y == 9 ? 4 : 0.5;
            assert_float_equal(lens_half_float(halves[4 * (y * 24 + x)]), expected, 0);
        }
    cmd = effect_fixture_begin(&f.gpu, f.context); /* nothing is prepared in this frame */
    assert_int_equal(lens_draw_and_read(&f, &made, cmd, LENS_WHOLE), VIRGA_NOT_READY);
    host_image_destroy(&f.gpu.device, &color);
    lens_destroy_drawn(&f, &made);
    lens_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_that_are_not_numbers_are_black_and_infinite_ones_are_bright),
        cmocka_unit_test(depths_that_are_not_numbers_spoil_nothing),
        cmocka_unit_test(a_picture_of_one_pixel_is_itself),
        cmocka_unit_test(both_kinds_of_depth_buffers_give_the_same_picture),
        cmocka_unit_test(the_same_picture_gives_the_same_bits),
        cmocka_unit_test(a_draw_puts_the_picture_into_its_viewport),
        cmocka_unit_test(wrong_arguments_are_refused_with_a_line),
        cmocka_unit_test(radii_beyond_the_work_image_are_cut_with_a_line),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
