/* test_lens_drops.c - a lamp that is seen in a drop on a pane, through a lens: the drop's layer, as the pane draws it,
 * is out of focus by the distance of the pane, not by that of the lamp. */
#include "../glass/glass_ball_fixture.h"
#include "lens_fixture.h"

#define PANE_M 0.8 /* from the camera */
#define LAMP_M 4.0
#define LAMP   1000.0f

enum { LAMP_X = 70, LAMP_Y = 60 };

/* What is behind the pane: dark, with a lamp. */
static void paint_lamp(float *pixels)
{
    memset(pixels, 0, 16 * WIDTH * HEIGHT);
    for (int y = LAMP_Y; y < LAMP_Y + 3; y++)
        for (int x = LAMP_X; x < LAMP_X + 3; x++)
            for (int c = 0; c < 3; c++)
                pixels[4 * (y * WIDTH + x) + c] = LAMP;
}

/* A pane with one drop in the middle of the picture, without light but the lamp's: the layer, premultiplied. */
static void draw_drop(float *layer)
{
    shot s;
    float *pixels = malloc(16 * WIDTH * HEIGHT);
    REQUIRE(pixels);
    open_small(&s);
    s.settings.style = VIRGA_GLASS_STYLE_PHYSICAL;
    memset(&s.settings.lighting.environment_sh, 0, sizeof s.settings.lighting.environment_sh);
    paint_lamp(pixels);
    shot_plate(&s, pixels);
    shot_drop(&s, 0.048, 0.032, shot_water(&s, 4e-3));
    memcpy(layer, shot_draw(&s, false), 16 * WIDTH * HEIGHT);
    free(pixels);
    shot_close(&s);
}

static void open_lens(lens_fixture *f, const float *layer)
{
    lens_fixture_open(f, WIDTH, HEIGHT, false);
    lens_paint_all(&f->scene, 0, LAMP_M);
    paint_lamp(f->scene.color);
    memcpy(lens_fixture_layer(f, (float)PANE_M)->color, layer, 16 * WIDTH * HEIGHT);
}

/* A channel of the layer at a pixel, spread over discs of this radius (px), in double precision. */
static double spread_layer(const float *layer, int x, int y, int channel, double radius)
{
    const int around = (int)radius + 1;
    double sum = 0, area = 0;
    for (int down = -around; down <= around; down++)
        for (int right = -around; right <= around; right++) {
            const double covered = fmin(fmax(radius - hypot(right, down) + 0.5, 0), 1);
            const int from_x = x + right, from_y = y + down;
            area += covered;
            if (from_x >= 0 && from_x < WIDTH && from_y >= 0 && from_y < HEIGHT)
                sum += covered * (double)layer[4 * (from_y * WIDTH + from_x) + channel];
        }
    return sum / area;
}

/* Focus on the lamp: what the drop shows of it is a disc around the drop, with all its light; the lamp itself is sharp
 * where it is, and the drop's soft edge covers it. */
static void a_lamp_seen_in_a_drop_before_the_focus_is_a_disc(void **state)
{
    const float *layer = *state;
    const double radius = 10 * fabs(1 / LAMP_M - 1 / PANE_M);
    double light = 0, disc = 0, peak = 0, worst = 0;
    lens_fixture f;
    open_lens(&f, layer);
    f.settings.focus_m = (float)LAMP_M;
    lens_fixture_run(&f);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double behind = (double)lens_pixel(&f.scene, (uint32_t)x, (uint32_t)y)[0];
            const double drop = spread_layer(layer, x, y, 0, radius), covered = spread_layer(layer, x, y, 3, radius);
            const double expected = drop + (1 - covered) * behind, found = lens_result(&f, (uint32_t)x, (uint32_t)y);
            worst = fmax(worst, fabs(found - expected) - 2e-3 * expected);
            light += (double)layer[4 * (y * WIDTH + x)];
            disc += found - (1 - covered) * behind;
            peak = fmax(peak, (double)layer[4 * (y * WIDTH + x)]);
        }
    print_message("the drop shows %g of the lamp's light, at most %g a pixel, as discs of %g px\n", light, peak,
                  radius);
    /* The drop's light comes from blocks of 2 x 2 texels: at the rim of its disc by a tenth of what the disc has. */
    print_message("at most %g beside what is expected\n", worst);
    assert_true(worst < 0.1 * light / (M_PI * radius * radius));
    assert_true(light > 10 && peak > 10);
    assert_float_equal(disc, light, 1e-3 * light);
    lens_fixture_close(&f);
}

/* Focus on the pane: the lamp is a disc, beside which the drop shows it as sharp as the pane has drawn it. */
static void in_focus_a_drop_shows_a_sharp_lamp_beside_its_disc(void **state)
{
    const float *layer = *state;
    lens_fixture f;
    open_lens(&f, layer);
    f.settings.focus_m = (float)PANE_M;
    lens_fixture_run(&f);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const float *drop = layer + 4 * (y * WIDTH + x);
            if (drop[3] > 0.9999f)
                assert_float_equal(lens_result(&f, (uint32_t)x, (uint32_t)y), (double)drop[0],
                                   2e-3 * (double)drop[0] + 0.2);
        }
    const double radius = 10 * fabs(1 / LAMP_M - 1 / PANE_M), disc = 9 * (double)LAMP / (M_PI * radius * radius);
    assert_float_equal(lens_result(&f, LAMP_X + 1, LAMP_Y + 1), disc, 0.05 * disc);
    assert_float_equal(lens_result(&f, LAMP_X + 7, LAMP_Y + 1), disc, 0.05 * disc);
    lens_fixture_close(&f);
}

int main(void)
{
    static float layer[4 * WIDTH * HEIGHT];
    draw_drop(layer);
    struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(a_lamp_seen_in_a_drop_before_the_focus_is_a_disc, layer),
        cmocka_unit_test_prestate(in_focus_a_drop_shows_a_sharp_lamp_beside_its_disc, layer),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
