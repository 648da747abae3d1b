/* test_glass_fog_drawn.c - what fog does to light, in closed form, and what is drawn where. */
#include "glass_ball_fixture.h"

static shot s;

static uint32_t *fog_cells(void)
{
    return s.film + (size_t)s.glass->columns * s.glass->rows;
}

/* A pane that can fog, before a plate of one color, in the dark. */
static void open_fog(virga_glass_fog_side side, float grey)
{
    virga_glass_def def = shot_def();
    def.condensation = true;
    shot_open(&s, &def, WIDTH, HEIGHT, false);
    float *plate = malloc(16ull * WIDTH * HEIGHT);
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        plate[i] = grey;
    shot_plate(&s, plate);
    free(plate);
    memset(&s.settings.lighting.environment_sh, 0, sizeof s.settings.lighting.environment_sh);
    s.settings.lighting.light_count = 0;
    s.settings.affinity = 0;
    s.settings.condensation.side = side;
    s.settings.condensation.droplets_per_mm2 = 100000;
    shot_face(&s, -1, 30);
}

static void put_fog(double um)
{
    for (uint32_t i = 0; i < s.glass->columns * s.glass->rows; i++)
        fog_cells()[i] = (uint32_t)(um * 4000);
}

/* The share that fog of this thickness covers, where the glass has its mean affinity. */
static double cover_of_fog(double um)
{
    const double cap = glass_cap_volume(glass_rest_deg(&s.settings)), dense = 1e11, h = um * 1e-6;
    const double alone = cbrt(h / (dense * cap)), cover = dense * M_PI * alone * alone;
    const double merged = M_PI * h / (0.55 * cap);
    return cover < 0.55 ? cover : 1 - 0.45 * cbrt(sqrt(0.55 / (dense * M_PI)) / merged);
}

static double mean_of(const float *pixels, int channel, int from_x, int to_x)
{
    double sum = 0;
    for (int y = 20; y < HEIGHT - 20; y++)
        for (int x = from_x; x < to_x; x++)
            sum += (double)pixels[4 * (y * WIDTH + x) + channel];
    return sum / ((HEIGHT - 40) * (to_x - from_x));
}

/* Of light behind, (1 - c)^2 passes and c (1 - c) is diffracted; of what the droplets refract, 0.95 passes. To 1 % of
 * the light, thin fog and thick. */
static void fog_lets_its_share_of_the_light_pass(void **unused)
{
    static const double um[] = {0.02, 0.1, 0.5, 4};
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE, 0.5f);
    for (int i = 0; i < 4; i++) {
        put_fog(um[i]);
        const float *pixels = shot_draw(&s, false);
        const double c = cover_of_fog(um[i]), alpha = mean_of(pixels, 3, 20, WIDTH - 20);
        assert_float_equal(alpha, c * (2 - c), 0.01);
        for (int y = 20; y < HEIGHT - 20; y++)
            for (int x = 20; x < WIDTH - 20; x++) {
                const float *found = pixels + 4 * (y * WIDTH + x);
                const double here = 1 - sqrt(1 - (double)found[3]); /* its c */
                assert_float_equal(found[1], 0.5 * (0.95 * here + here * (1 - here)), 0.005);
            }
    }
    shot_close(&s);
}

/* Cells without fog show nothing of it, from a cell beside the border on. */
static void wiped_cells_are_clear(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE, 0.5f);
    put_fog(2);
    for (uint32_t row = 0; row < s.glass->rows; row++)
        for (uint32_t column = 20; column < 30; column++)
            fog_cells()[column + row * s.glass->columns] = 0;
    const float *pixels = shot_draw(&s, false);
    const double f = 0.5 * HEIGHT / tan(15 * M_PI / 180), away = fabs(s.camera.position_m[2]);
    int clear = 0, fogged = 0;
    for (int y = 8; y < HEIGHT - 8; y++)
        for (int x = 8; x < WIDTH - 8; x++) {
            const double u = 0.048 - (x + 0.5 - 0.5 * WIDTH) / f * away; /* from behind */
            const float alpha = pixels[4 * (y * WIDTH + x) + 3];
            if (u > 0.0425 && u < 0.0575) {
                assert_true(alpha == 0);
                clear++;
            }
            if (u < 0.0375 || u > 0.0625) {
                assert_true(alpha > 0.5f);
                fogged++;
            }
        }
    assert_true(clear > 500 && fogged > 500);
    shot_close(&s);
}

static void draw_drop(virga_glass_fog_side side, double um, float middle[4])
{
    open_fog(side, 0.5f);
    put_fog(um);
    shot_drop(&s, 0.048, 0.032, shot_water(&s, 15e-3));
    memcpy(middle, shot_draw(&s, false) + 4 * (HEIGHT / 2 * WIDTH + WIDTH / 2), 16);
    shot_close(&s);
}

/* From behind: fog on the far side is hidden by a drop there, and fog on the eye's side lies over it. */
static void fog_is_drawn_on_its_side_of_drops(void **unused)
{
    float dry[4], far_side[4], near_side[4];
    (void)unused;
    draw_drop(VIRGA_GLASS_FOG_NONE, 0, dry);
    draw_drop(VIRGA_GLASS_FOG_OUTSIDE, 2, far_side);
    draw_drop(VIRGA_GLASS_FOG_INSIDE, 2, near_side);
    for (int i = 0; i < 4; i++)
        assert_float_equal(far_side[i], dry[i], 1e-3);
    /* 0.95 of the light of those that cover comes through, of what is 0.5 everywhere */
    assert_float_equal(near_side[3], 1, 1e-3);
    assert_true(near_side[1] < dry[1] - 0.005f);
}

/* Without condensation, and with it where nothing has condensed, nothing is drawn. */
static void a_pane_without_fog_shows_none(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE, 0.5f);
    assert_float_equal(mean_of(shot_draw(&s, false), 3, 20, WIDTH - 20), 0, 0);
    put_fog(2);
    s.settings.condensation.side = VIRGA_GLASS_FOG_NONE;
    assert_float_equal(mean_of(shot_draw(&s, false), 3, 20, WIDTH - 20), 0, 0);
    shot_close(&s);
}

/* A lamp on a black picture has a halo, which fades outwards, and is redder the farther out. */
static void a_lamp_has_a_corona(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE, 0);
    float *plate = calloc(4ull * WIDTH * HEIGHT, sizeof *plate);
    for (int y = -2; y < 2; y++)
        for (int x = -2; x < 2; x++)
            for (int i = 0; i < 4; i++)
                plate[4 * ((HEIGHT / 2 + y) * WIDTH + WIDTH / 2 + x) + i] = 1000;
    shot_plate(&s, plate);
    free(plate);
    s.settings.condensation.droplets_per_mm2 = 1000; /* of 5 um: red 0.026 rad, which are 8 pixels */
    put_fog(0.1);
    const float *pixels = shot_draw(&s, false);
    double rings[3][2] = {{0}};
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double r = hypot(x + 0.5 - 0.5 * WIDTH, y + 0.5 - 0.5 * HEIGHT);
            const int ring = r < 6 ? 0 : r < 14 ? 1 : r < 24 ? 2 : 3;
            for (int i = 0; ring < 3 && i < 2; i++)
                rings[ring][i] += (double)pixels[4 * (y * WIDTH + x) + 2 * i] / (ring == 0   ? 36
                                                                                 : ring == 1 ? 160
                                                                                             : 380);
        }
    assert_true(rings[0][0] > 1.5 * rings[1][0] && rings[1][0] > 1.5 * rings[2][0] && rings[2][0] > 0);
    assert_true(rings[1][0] / rings[1][1] > 1.01 * rings[0][0] / rings[0][1]);
    shot_close(&s);
}

/* Droplets of half a millimetre, seen from near, cover their share of the pixels, and between them is clear glass. */
static void large_droplets_are_seen_as_drops(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE, 0.5f);
    s.settings.condensation.droplets_per_mm2 = 2;
    const double cap = glass_cap_volume(glass_rest_deg(&s.settings)), radius = 0.25e-3;
    put_fog(2e6 * cap * radius * radius * radius * 1e6);
    shot_aim(&s, (const double[3]){0.048, 0.032, -0.03}, (const double[3]){0.048, 0.032, 0}, 30);
    const float *pixels = shot_draw(&s, false);
    int clear = 0, covered = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        clear += pixels[4 * i + 3] < 0.01f;
        covered += pixels[4 * i + 3] > 0.99f;
    }
    const double cover = 2e6 * M_PI * radius * radius;
    assert_float_equal(mean_of(pixels, 3, 20, WIDTH - 20), cover, 0.2 * cover);
    assert_true(clear > WIDTH * HEIGHT / 3 && covered > WIDTH * HEIGHT / 8);
    shot_close(&s);
}

/* Dew on paint with an index of 1.5, under surroundings of 1 all around. Under the share c it lacks its gloss straight
 * on, as a film takes it off, and 0.95 of the rest passes; 0.05 of the surroundings come from the droplets. To 0.5 % of
 * the surroundings. */
static void dew_takes_the_gloss_off_what_is_not_glass(void **unused)
{
    static const double um[] = {0.02, 0.5, 4};
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_OUTSIDE, 0.2f);
    s.settings.opaque = true;
    for (int i = 0; i < 3; i++)
        s.settings.lighting.environment_sh[0][i] = 1 / 0.282095f;
    shot_face(&s, 1, 30);
    const double air = 0.5 / 2.5, coat = (1.5 - WATER) / (1.5 + WATER), color = 0.2 - air * air + coat * coat;
    for (int i = 0; i < 3; i++) {
        put_fog(um[i]);
        const float *pixels = shot_draw(&s, false);
        assert_float_equal(mean_of(pixels, 3, 20, WIDTH - 20), cover_of_fog(um[i]), 0.01);
        for (int x = WIDTH / 2 - 8; x < WIDTH / 2 + 8; x++) {
            const float *found = pixels + 4 * (HEIGHT / 2 * WIDTH + x);
            assert_float_equal(found[1], (double)found[3] * (0.95 * color + 0.05), 0.005);
        }
    }
    shot_close(&s);
}

/* Nor is the far side of metal seen, whatever condenses there. */
static void fog_behind_what_is_not_glass_is_hidden(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_INSIDE, 0.5f);
    s.settings.opaque = true;
    put_fog(2);
    shot_face(&s, 1, 30);
    assert_float_equal(mean_of(shot_draw(&s, false), 3, 20, WIDTH - 20), 0, 0);
    s.settings.condensation.side = VIRGA_GLASS_FOG_OUTSIDE;
    shot_face(&s, -1, 30); /* from behind */
    assert_float_equal(mean_of(shot_draw(&s, false), 3, 20, WIDTH - 20), 0, 0);
    shot_close(&s);
}

static void a_camera_s_front_element_does_not_fog(void **unused)
{
    (void)unused;
    open_fog(VIRGA_GLASS_FOG_OUTSIDE, 0.5f);
    s.settings.style = VIRGA_GLASS_STYLE_FRONT;
    assert_int_equal(virga_glass_set(s.glass, &s.settings), VIRGA_ERROR_INVALID);
    s.settings.condensation.side = VIRGA_GLASS_FOG_NONE;
    assert_int_equal(virga_glass_set(s.glass, &s.settings), VIRGA_OK);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fog_lets_its_share_of_the_light_pass),
        cmocka_unit_test(wiped_cells_are_clear),
        cmocka_unit_test(fog_is_drawn_on_its_side_of_drops),
        cmocka_unit_test(a_pane_without_fog_shows_none),
        cmocka_unit_test(a_lamp_has_a_corona),
        cmocka_unit_test(large_droplets_are_seen_as_drops),
        cmocka_unit_test(dew_takes_the_gloss_off_what_is_not_glass),
        cmocka_unit_test(fog_behind_what_is_not_glass_is_hidden),
        cmocka_unit_test(a_camera_s_front_element_does_not_fog),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
