/* test_lens_in_place.c - what is out of focus is blended over the picture that the target already holds: the same
 * picture as in an image of its own, and what is in focus is not touched. */
#include "lens_host.h"
#include "lens_kinds.h"

#define WIDTH  LENS_KINDS_WIDTH
#define HEIGHT LENS_KINDS_HEIGHT
#define TILE   (2 * VIRGA_LENS_TILE) /* px */

/* ---- tests */

/* The picture of a lens with an image of its own. */
static float *run_apart(const lens_kind *kind, float max_radius_px)
{
    lens_fixture f;
    lens_fixture_open(&f, WIDTH, HEIGHT, true);
    lens_set_up(&f, kind);
    f.settings.max_radius_px = max_radius_px;
    lens_fixture_run(&f);
    float *result = f.result;
    f.result = NULL;
    lens_fixture_close(&f);
    return result;
}

static const virga_target_kind target_kinds[] = {VIRGA_TARGET_RENDER_PASS, VIRGA_TARGET_DYNAMIC};

/* Half floats have 11 bits, and are truncated on some devices. What is beneath and what is blended over it are rounded
 * one after the other. One pass for narrow discs without layers keeps the far field with nine bits for each channel,
 * which are rounded: up to 1 / 512 of the largest one. */
#define HALF_FLOATS     (3.0 / 1024)
#define SHARED_EXPONENT (HALF_FLOATS + 2.0 / 1024)

static void compare_to_an_image_of_its_own(virga_pass_variants variants, float max_radius_px)
{
    static const lens_kind frames[] = {{.aperture_scale = 1},
                                       {.aperture_scale = 2, .cats_eye = 0.5f},
                                       {.aperture_scale = 1, .layers = 1},
                                       {.aperture_scale = 1, .layers = 3},
                                       {.aperture_scale = 1, .layers = 2, .flat = true}};
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        float *apart = run_apart(&frames[i], max_radius_px);
        for (int k = 0; k < 2; k++) {
            host h;
            double worst = 0;
            effect_fixture_variants = variants;
            const bool there = open_host(&h, target_kinds[k], WIDTH, HEIGHT, 1);
            effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
            if (!there)
                continue;
            lens_set_up(&h.f, &frames[i]);
            h.f.settings.max_radius_px = max_radius_px;
            run(&h);
            for (size_t p = 0; p < 4u * WIDTH * HEIGHT; p++)
                worst = fmax(worst, fabs((double)h.f.result[p] - (double)apart[p]) / (0.01 + fabs((double)apart[p])));
            printf("frame %zu, target %d: up to %.2g apart\n", i, k, worst);
            assert_true(worst < (variants == VIRGA_VARIANTS_GPU ? SHARED_EXPONENT : HALF_FLOATS));
            close_host(&h);
        }
        free(apart);
    }
}

/* With the passes of GPUs the wide discs of the one lens come from a quarter of the resolution, and those of the other
 * from blocks of texels. They are as exact as each other, but not the same: tests/lens/wide has its own references. */
static void the_picture_is_that_of_an_image_of_its_own(void **state)
{
    (void)state;
    if (effect_fixture_wanted_variants() == VIRGA_VARIANTS_GPU) {
        printf("skipped: with the passes of GPUs the two lenses gather wide discs in two ways\n");
        skip();
    }
    compare_to_an_image_of_its_own(VIRGA_VARIANTS_OF_DEVICE, virga_default_lens_settings().max_radius_px);
}

/* Where one pass does it all, tiles are drawn from entries of their own, and some of them overwrite the target. */
static void so_is_that_of_one_pass_for_narrow_discs(void **state)
{
    (void)state;
    compare_to_an_image_of_its_own(VIRGA_VARIANTS_GPU, 16);
}

/* Noise all at one depth, behind the focus: 1.2 px, of which a part of each pixel comes from what is beneath, and 3 px,
 * of which none does, so that one pass lets its tiles overwrite the target; and 7 and 9.8 px, which it gathers as even
 * (shaders/lens/even.glsl). */
static void noise_at_one_depth_is_the_same_from_one_pass(void **state)
{
    static const double depths_m[] = {1 / (1 - 0.12), 1 / (1 - 0.3), 1 / (1 - 0.7), 1 / (1 - 0.98)};
    static float many[4 * WIDTH * HEIGHT];
    (void)state;
    for (int i = 0; i < 8; i++) {
        host h;
        uint32_t hash = 3;
        double worst = 0, light[2] = {0};
        effect_fixture_variants = i & 1 ? VIRGA_VARIANTS_GPU : VIRGA_VARIANTS_SOFTWARE;
        REQUIRE(open_host(&h, VIRGA_TARGET_RENDER_PASS, WIDTH, HEIGHT, 1));
        h.f.settings.max_radius_px = 16;
        for (uint32_t y = 0; y < HEIGHT; y++)
            for (uint32_t x = 0; x < WIDTH; x++)
                lens_paint(&h.f.scene, x, y, lens_gray(&hash), depths_m[i / 2]);
        run(&h);
        for (size_t p = 0; p < 4u * WIDTH * HEIGHT && i & 1; p++) {
            worst = fmax(worst, fabs((double)h.f.result[p] - (double)many[p]) / (0.01 + fabs((double)many[p])));
            light[0] += (double)many[p];
            light[1] += (double)h.f.result[p];
        }
        printf("depth %d: up to %.2g apart, light %.2g\n", i / 2, worst, i & 1 ? light[1] / light[0] - 1 : 0);
        assert_true(worst < SHARED_EXPONENT);
        if (i & 1) /* half floats that are truncated lose 0.0003 of it on average */
            assert_float_equal(light[1] / light[0], 1, 5e-4);
        memcpy(many, h.f.result, sizeof many);
        close_host(&h);
    }
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
}

/* The target holds something else there than what the lens was given, and keeps it to the last bit. */
static void what_nothing_out_of_focus_reaches_is_not_touched(void **state)
{
    (void)state;
    host h;
    REQUIRE(open_host(&h, VIRGA_TARGET_RENDER_PASS, WIDTH, HEIGHT, 1));
    lens_paint_kinds(&h.f.scene);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < 2 * TILE; x++) {
            float *pixel = lens_pixel(&h.f.scene, x, y);
            pixel[0] = x % 3 ? -INFINITY : NAN;
            pixel[3] = 0.25f;
        }
    run(&h);
    const uint16_t *halves = h.f.download.mapped;
    for (uint32_t i = 0; i < WIDTH * HEIGHT * 4; i++)
        if (i / 4 % WIDTH < 2 * TILE)
            assert_int_equal(halves[i], half_of(h.f.scene.color[i]));
    assert_true(isfinite(h.f.result[4 * (HEIGHT / 2 * WIDTH + 2 * TILE)]));
    close_host(&h);
}

/* Nothing at all is drawn, or every tile. */
static void all_in_focus_and_all_out_of_focus(void **state)
{
    (void)state;
    host h;
    REQUIRE(open_host(&h, VIRGA_TARGET_RENDER_PASS, WIDTH, HEIGHT, 1));
    uint32_t hash = 9;
    for (int frame = 0; frame < 4; frame++) {
        for (uint32_t y = 0; y < HEIGHT; y++)
            for (uint32_t x = 0; x < WIDTH; x++)
                lens_paint(&h.f.scene, x, y, frame & 1 ? 0.5f : lens_gray(&hash), frame & 1 ? frame == 1 ? 0 : 0.6 : 1);
        lens_paint(&h.f.scene, WIDTH / 2, HEIGHT / 2, 1000, frame & 1 ? frame == 1 ? 0 : 0.6 : 1);
        run(&h);
        for (uint32_t i = 0; i < WIDTH * HEIGHT * 4 && !(frame & 1); i++)
            assert_float_equal(h.f.result[i], h.f.scene.color[i], 0);
        if (frame & 1) {
            const double added = lens_light(h.f.result, &h.f) - 0.5 * WIDTH * HEIGHT;
            assert_float_equal(added, 999.5, 5);
            assert_true(lens_result(&h.f, WIDTH / 2, HEIGHT / 2) < 20);
        }
    }
    close_host(&h);
}

static void a_picture_of_one_pixel_is_itself(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        host h;
        if (!open_host(&h, target_kinds[k], 1, 1, 1))
            continue;
        lens_paint_all(&h.f.scene, 3, 0.2);
        run(&h);
        assert_float_equal(lens_result(&h.f, 0, 0), 3, 4e-3);
        close_host(&h);
    }
}

/* Something in front of the focus in the middle of what is in focus. */
static void paint_patch(const lens_picture *scene)
{
    lens_paint_all(scene, 0.25f, 1);
    for (uint32_t i = 0; i < 64; i++)
        lens_paint(scene, 108 + i % 8, 44 + i / 8, 20, 1 / 1.5);
}

/* Fields are computed for tiles that something reaches only. What is left beside them of a picture before it, of which
 * all was bright and out of focus, changes nothing: in passes for discs of any width, and in that for narrow ones. */
static void nothing_is_left_of_the_picture_before(void **state)
{
    (void)state;
    static float alone[4 * WIDTH * HEIGHT];
    for (int i = 0; i < 4; i++) {
        host h;
        effect_fixture_variants = i < 2 ? VIRGA_VARIANTS_SOFTWARE : VIRGA_VARIANTS_GPU;
        REQUIRE(open_host(&h, VIRGA_TARGET_RENDER_PASS, WIDTH, HEIGHT, 1));
        h.f.settings.max_radius_px = 16;
        if (i & 1) {
            lens_paint_all(&h.f.scene, 60000, 0.5);
            run(&h);
        }
        paint_patch(&h.f.scene);
        run(&h);
        if (i & 1)
            assert_memory_equal(h.f.result, alone, sizeof alone);
        memcpy(alone, h.f.result, sizeof alone);
        close_host(&h);
    }
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
}

/* Each draw has the tiles of its own view, although the other one was prepared before or after it. */
static void views_of_a_frame_keep_their_tiles(void **state)
{
    (void)state;
    host h;
    virga_prepared views[2];
    REQUIRE(open_host(&h, VIRGA_TARGET_RENDER_PASS, WIDTH, HEIGHT, 2));
    REQUIRE(virga_lens_set(h.f.lens, &h.f.settings) == VIRGA_OK);
    for (int drawn = 0; drawn < 2; drawn++) {
        virga_image depths[2];
        drop_images(&h);
        for (int i = 0; i < 2; i++) {
            lens_paint_all(&h.f.scene, 0.25f, i ? 0.5 : 1);
            lens_paint(&h.f.scene, WIDTH / 2, HEIGHT / 2, 1000, i ? 0.5 : 1);
            depths[i] = lens_upload(&h.f, &h.f.scene, true, &h.depths[i]);
        }
        upload_color(&h);
        const VkCommandBuffer cmd = effect_fixture_begin(&h.f.gpu, h.f.context);
        for (int i = 0; i < 2; i++) {
            h.f.view.depth = depths[i];
            REQUIRE(virga_lens_prepare_view(h.f.lens, cmd, &h.f.view, NULL, 0, 0, &views[i]) == VIRGA_OK);
        }
        begin(&h, cmd);
        REQUIRE(virga_lens_draw_view(h.f.lens, cmd, h.target, views[drawn]) == VIRGA_OK);
        end(&h, cmd);
        assert_true(drawn ? lens_result(&h.f, WIDTH / 2, HEIGHT / 2) < 20
                          : lens_result(&h.f, WIDTH / 2, HEIGHT / 2) >= 1000);
        assert_true((lens_result(&h.f, WIDTH / 2 + 6, HEIGHT / 2) > 1) == (drawn == 1));
    }
    close_host(&h);
}

static void what_it_cannot_do_is_refused_with_a_line(void **state)
{
    (void)state;
    host h;
    virga_lens_image picture;
    virga_lens *wrong;
    virga_target *encoded;
    virga_lens_def def = virga_default_lens_def();
    REQUIRE(open_host(&h, VIRGA_TARGET_RENDER_PASS, 32, 32, 1));
    lens_paint_all(&h.f.scene, 0.5f, 1);
    run(&h);
    const uint32_t lines = h.f.log_lines;
    def.in_place = 1;
    assert_int_equal(virga_lens_create(h.f.context, &def, &wrong), VIRGA_ERROR_INVALID);
    def.half_resolution = def.circles = 1;
    assert_int_equal(virga_lens_create(h.f.context, &def, &wrong), VIRGA_ERROR_INVALID);
    h.f.settings.style = VIRGA_LENS_STYLE_PAPER;
    assert_int_equal(virga_lens_set(h.f.lens, &h.f.settings), VIRGA_ERROR_INVALID);
    virga_lens_picture(h.f.lens, &picture);
    assert_true(!picture.image && !picture.view);
    REQUIRE(create_target(&h, VIRGA_ENCODING_SRGB, &encoded) == VIRGA_OK);
    REQUIRE(virga_lens_attach(h.f.lens, encoded) == VIRGA_OK);
    h.f.settings.style = VIRGA_LENS_STYLE_PHYSICAL;
    upload(&h, NULL);
    const VkCommandBuffer cmd = effect_fixture_begin(&h.f.gpu, h.f.context);
    REQUIRE(virga_lens_prepare(h.f.lens, cmd, &h.f.view, NULL, 0, 0) == VIRGA_OK);
    begin(&h, cmd);
    assert_int_equal(virga_lens_draw_part(h.f.lens, cmd, h.target, 0), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_lens_draw(h.f.lens, cmd, encoded), VIRGA_ERROR_INVALID);
    assert_int_equal(h.f.log_lines - lines, 5);
    end(&h, cmd);
    virga_target_destroy(&encoded);
    close_host(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_picture_is_that_of_an_image_of_its_own),
        cmocka_unit_test(so_is_that_of_one_pass_for_narrow_discs),
        cmocka_unit_test(noise_at_one_depth_is_the_same_from_one_pass),
        cmocka_unit_test(what_nothing_out_of_focus_reaches_is_not_touched),
        cmocka_unit_test(all_in_focus_and_all_out_of_focus),
        cmocka_unit_test(a_picture_of_one_pixel_is_itself),
        cmocka_unit_test(nothing_is_left_of_the_picture_before),
        cmocka_unit_test(views_of_a_frame_keep_their_tiles),
        cmocka_unit_test(what_it_cannot_do_is_refused_with_a_line),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
