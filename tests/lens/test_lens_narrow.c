/* test_lens_narrow.c - on GPUs one pass gathers narrow discs at half resolution. It gives the same picture as the
 * passes for discs of any width. */
#include "lens_kinds.h"

#define WIDTH  LENS_KINDS_WIDTH
#define HEIGHT LENS_KINDS_HEIGHT
#define COUNT  (4u * WIDTH * HEIGHT)

static const lens_kind kinds[] = {{.aperture_scale = 1},
                                  {.aperture_scale = 2, .cats_eye = 0.5f},
                                  {.aperture_scale = 0.7f, .layers = 1},
                                  {.aperture_scale = 1, .layers = 2, .flat = true}};

static void open_kind(lens_fixture *f, virga_pass_variants variants, const lens_kind *kind, bool encoded)
{
    effect_fixture_variants = variants;
    lens_fixture_open(f, WIDTH, HEIGHT, true);
    lens_set_up(f, kind);
    f->settings.max_radius_px = 16;
    f->view.color_encoding = encoded ? VIRGA_ENCODING_SRGB : VIRGA_ENCODING_NOT_GIVEN;
    /* Sides and a corner that are odd. */
    f->view.viewport[0] = 3;
    f->view.viewport[1] = 1;
    f->view.viewport[2] = WIDTH - 5;
    f->view.viewport[3] = HEIGHT - 7;
}

/* Samples are kept as half floats, and fields and pictures are truncated to half floats. */
static void one_pass_gives_the_same_picture_as_many(void **state)
{
    (void)state;
    static float many[COUNT];
    const size_t count = (size_t)(WIDTH - 5) * (HEIGHT - 7) * 4;
    for (size_t i = 0; i < 2 * sizeof kinds / sizeof *kinds; i++) {
        lens_fixture f;
        double worst = 0, light[2] = {0};
        for (int one = 0; one < 2; one++) {
            open_kind(&f, one ? VIRGA_VARIANTS_GPU : VIRGA_VARIANTS_SOFTWARE, &kinds[i / 2], i & 1);
            lens_fixture_run(&f);
            for (size_t k = 0; k < count; k++) {
                light[one] += (double)f.result[k];
                if (one)
                    worst = fmax(worst, fabs((double)f.result[k] - (double)many[k]) / (0.02 + (double)many[k]));
            }
            memcpy(many, f.result, sizeof many);
            lens_fixture_close(&f);
        }
        printf("kind %zu: up to %.2g apart, light %.2g\n", i, worst, light[1] / light[0] - 1);
        assert_true(worst < 4.0 / 1024);
        assert_float_equal(light[1] / light[0], 1, 5e-4);
    }
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
}

static void a_picture_of_one_pixel_is_itself(void **state)
{
    (void)state;
    lens_fixture f;
    effect_fixture_variants = VIRGA_VARIANTS_GPU;
    lens_fixture_open(&f, 1, 1, true);
    f.settings.max_radius_px = 16;
    lens_paint_all(&f.scene, 3, 0.6);
    lens_fixture_run(&f);
    assert_float_equal(lens_result(&f, 0, 0), 3, 4e-3);
    lens_fixture_close(&f);
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_pass_gives_the_same_picture_as_many),
        cmocka_unit_test(a_picture_of_one_pixel_is_itself),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
