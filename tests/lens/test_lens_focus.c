/* test_lens_focus.c - the focus: what it follows, how it eases, and what it means for the camera. */
#include "lens_fixture.h"

static double focus_m(lens_fixture *f)
{
    virga_lens_stats stats;
    virga_lens_stats_get(f->lens, &stats);
    assert_int_equal(stats.frame_index, f->gpu.device.completed);
    return (double)stats.focus_m;
}

static void the_focus_follows_the_depth_at_the_point(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 32, 16, false);
    f.settings.follow = 1;
    f.settings.focus_time_s = 0;
    lens_paint_all(&f.scene, 0.5f, 8);
    lens_paint(&f.scene, 31, 15, 0.5f, 3);
    lens_fixture_run(&f);
    assert_float_equal(focus_m(&f), 8, 1e-4);
    f.settings.focus_point[0] = f.settings.focus_point[1] = 1;
    lens_fixture_run(&f);
    assert_float_equal(focus_m(&f), 3, 1e-4);
    lens_fixture_close(&f);
}

static void the_focus_eases_to_a_new_depth(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 16, 16, false);
    f.settings.follow = 1;
    f.settings.focus_time_s = 0.5f;
    lens_paint_all(&f.scene, 0.5f, 10);
    lens_fixture_run(&f);
    assert_float_equal(focus_m(&f), 10, 1e-4); /* the first picture is in focus at once */
    lens_paint_all(&f.scene, 0.5f, 2);
    for (int frame = 1; frame <= 4; frame++) {
        f.time_s = 0.1 * frame;
        lens_fixture_run(&f);
        assert_float_equal(1 / focus_m(&f), 0.5 + (0.1 - 0.5) * exp(-0.2 * frame), 1e-5);
    }
    f.time_s = 0; /* another shot: time runs backwards */
    lens_fixture_run(&f);
    assert_float_equal(focus_m(&f), 2, 1e-4);
    lens_fixture_close(&f);
}

/* Two views of a frame, at different focus: each picture is what it is alone, and each follows its own focus. */
static void two_views_have_their_own_pictures(void **state)
{
    (void)state;
    lens_fixture f;
    virga_lens_def def = virga_default_lens_def();
    virga_prepared prepared[2];
    virga_lens_image pictures[2], newest;
    host_image images[2][2];
    lens_fixture_open(&f, 16, 16, false);
    virga_lens_destroy(&f.lens);
    def.max_width = def.max_height = 16;
    def.max_views = 2;
    REQUIRE(virga_lens_create(f.context, &def, &f.lens) == VIRGA_OK);
    f.settings.follow = 1;
    f.settings.focus_time_s = 0.5f;
    REQUIRE(virga_lens_set(f.lens, &f.settings) == VIRGA_OK);
    for (int frame = 0; frame < 2; frame++) {
        virga_view views[2] = {f.view, f.view};
        for (int view = 0; view < 2; view++) {
            lens_paint_all(&f.scene, 0.5f, view ? 8 : 2);
            views[view].color = lens_upload(&f, &f.scene, false, &images[view][0]);
            views[view].depth = lens_upload(&f, &f.scene, true, &images[view][1]);
        }
        const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
        for (int view = 0; view < 2; view++)
            REQUIRE(virga_lens_prepare_view(f.lens, cmd, &views[view], NULL, 0, 0.1 * frame, &prepared[view]) ==
                    VIRGA_OK);
        for (int view = 0; view < 2; view++)
            virga_lens_picture_view(f.lens, prepared[view], &pictures[view]);
        virga_lens_picture(f.lens, &newest);
        effect_fixture_complete(&f.gpu, f.context);
        for (int view = 0; view < 4; view++)
            host_image_destroy(&f.gpu.device, &images[view / 2][view % 2]);
        virga_lens_stats stats;
        virga_lens_stats_get(f.lens, &stats);
        assert_int_equal(stats.views, 2);
        assert_float_equal(stats.view_focus_m[0], 2, 1e-4); /* it never saw the other depth */
        assert_float_equal(stats.view_focus_m[1], 8, 1e-4);
        assert_true(pictures[0].image != pictures[1].image && newest.image == pictures[1].image);
    }
    lens_fixture_close(&f);
}

static void without_depth_all_is_sharp(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 16, 16, false);
    f.flat = true;
    f.settings.follow = 1;
    f.settings.focus_m = 7;
    lens_paint_all(&f.scene, 0, 1);
    lens_paint(&f.scene, 8, 8, 4, 1);
    lens_fixture_run(&f);
    assert_float_equal(lens_result(&f, 8, 8), 4, 0);
    assert_float_equal(focus_m(&f), 7, 1e-4);
    lens_fixture_close(&f);
}

static void a_view_gets_the_lens_for_its_streaks(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 16, 16, false);
    f.settings.focal_m = 0.05f;
    f.settings.aperture_f = 2;
    f.settings.focus_m = 6;
    REQUIRE(virga_lens_set(f.lens, &f.settings) == VIRGA_OK);
    virga_lens_fill_view(f.lens, &f.view);
    assert_float_equal(f.view.aperture_m, 0.025, 1e-6);
    assert_float_equal(f.view.focus_m, 6, 0);
    lens_fixture_close(&f);
}

static void breathing_is_that_of_a_thin_lens(void **state)
{
    (void)state;
    /* 1 / focal = 1 / focus + 1 / image; the picture grows as the image distance. */
    const double image_m = 1 / (1 / 0.05 - 1 / 0.5);
    assert_float_equal(virga_lens_breathing(0.05, 0.5), image_m / 0.05, 1e-12);
    assert_float_equal(virga_lens_breathing(0.05, 0), 1, 0);
    assert_float_equal(virga_lens_breathing(0.05, 0.04), 1, 0);
}

/* A street of lamps at several depths, and a layer of drops on a pane. */
static void paint_street(lens_fixture *f, const lens_picture *drops)
{
    for (uint32_t y = 0; y < f->scene.height; y++)
        for (uint32_t x = 0; x < f->scene.width; x++) {
            const double depth_m = x < 20 ? 1.2 : x < 40 ? 2 : 5;
            lens_paint(&f->scene, x, y, x % 10 == 5 && y % 12 == 6 ? 20 : 0.5f, depth_m);
            if (x % 16 < 3 && y % 10 < 3) {
                lens_paint(drops, x, y, 0.7f, 0);
                lens_pixel(drops, x, y)[3] = 0.8f;
            }
        }
}

/* The values of a pixel in a run of frames: from the smallest to the largest. */
static float range_of(float *const *frames, int first, int end, size_t i)
{
    float low = frames[first][i], high = low;
    for (int k = first; k < end; k++) {
        low = fminf(low, frames[k][i]);
        high = fmaxf(high, frames[k][i]);
    }
    return high - low;
}

/* The focus goes from the pane to the street in 48 frames, by up to 4 px of blur. A change that comes from the blur is
 * spread over several frames; one that is in a single frame is a pop. */
static void nothing_pops_as_the_focus_moves(void **state)
{
    (void)state;
    enum { FRAMES = 49, WIDTH = 60, HEIGHT = 36, VALUES = 4 * WIDTH * HEIGHT };
    for (int half = 0; half < 2; half++) {
        lens_fixture f;
        float *frames[FRAMES], worst = 0;
        lens_fixture_open(&f, WIDTH, HEIGHT, half);
        f.settings.aperture_f *= 2; /* 5 px at 1/m */
        paint_street(&f, lens_fixture_layer(&f, 1));
        for (int k = 0; k < FRAMES; k++) {
            f.settings.focus_m = (float)(1 / (1 - 0.8 * k / (FRAMES - 1)));
            lens_fixture_run(&f);
            frames[k] = malloc(VALUES * sizeof(float));
            assert_non_null(frames[k]);
            memcpy(frames[k], f.result, VALUES * sizeof(float));
        }
        for (int k = 0; k + 1 < FRAMES; k++)
            for (size_t i = 0; i < VALUES; i++) {
                const float change = fabsf(frames[k + 1][i] - frames[k][i]);
                const int first = k < 4 ? 0 : k - 4, end = k + 6 > FRAMES ? FRAMES : k + 6;
                worst = fmaxf(worst, change / (range_of(frames, first, end, i) + 0.05f));
            }
        printf("%s resolution: at most %.2f of a change in one frame\n", half ? "half" : "full", (double)worst);
        assert_true(worst < 0.6f);
        for (int k = 0; k < FRAMES; k++)
            free(frames[k]);
        lens_fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_focus_follows_the_depth_at_the_point), cmocka_unit_test(the_focus_eases_to_a_new_depth),
        cmocka_unit_test(two_views_have_their_own_pictures),        cmocka_unit_test(without_depth_all_is_sharp),
        cmocka_unit_test(a_view_gets_the_lens_for_its_streaks),     cmocka_unit_test(breathing_is_that_of_a_thin_lens),
        cmocka_unit_test(nothing_pops_as_the_focus_moves),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
