/* test_splash_lines.c - droplets as thin as they are drawn are lines, and look as those of two triangles do. */
#include "splash_picture_fixture.h"

enum { DROPLETS = 60, BORDER = 2 /* of them fly out of the picture */ };

static double unit(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) * (1.0 / 16777216);
}

/* In a plane half a metre away, where a pixel is 2.8 mm wide: from half of that to twice as much, each where none lies
 * over it, so that it does not matter in which order they are drawn. */
static void put_cloud(shot *s)
{
    virga_droplet_gpu droplets[DROPLETS];
    uint32_t random = 7;
    for (int i = 0; i < DROPLETS; i++) {
        const double pixel = pixel_m(s, 0.5), cell = pixel * SIDE / 8;
        const double position[3] = {(i % 8 - 3.5) * cell, (i / 8 - 3.5) * cell, 0};
        const double border[3] = {-4.05 * cell, position[1] + i * cell, 0};
        const double beside[3] = {unit(&random) - 0.5, unit(&random) - 0.5, 0}, out[3] = {-6, 0, 0};
        const double diameter = (0.5 + 1.5 * unit(&random)) * pixel;
        droplets[i] = i < BORDER ? flying(0.6 * pixel, border, out) : flying(diameter, position, beside);
    }
    splash_fixture_put(&s->f, droplets, DROPLETS);
    splash_fixture_step(&s->f, 1);
    REQUIRE(s->f.state->staying == DROPLETS);
}

static void open_cloud(shot *s, virga_splash_style style)
{
    open_shot(s);
    if (!s->f.context->lines)
        effect_fixture_skip("no lines on this device");
    s->f.settings.style = style;
    apply_settings(s);
    aim_from(s, 0.5);
    s->shutter_s = 1.0 / 96;
    put_cloud(s);
}

static const virga_sprite_gpu *sprites(const shot *s)
{
    return s->sprites.mapped;
}

static double half_value(uint32_t bits)
{
    return ldexp(1024 + (bits & 1023), (int)(bits >> 10 & 31) - 25);
}

/* As thin as the thinnest, and whole on the picture, by a margin either way. */
static bool is_line(const shot *s, const virga_sprite_gpu *sprite, double margin)
{
    const double width = fmax(half_value(sprite->widths & 0xffff), half_value(sprite->widths >> 16));
    const double min = (double)s->f.settings.min_width_px;
    double furthest = 0;
    for (int i = 0; i < 2; i++)
        furthest = fmax(furthest, fmax(fabs((double)sprite->head[i]), fabs((double)sprite->tail[i])));
    return width < (min + 1e-6) * (1 + margin) && furthest + (min + 2) / SIDE < 1 + margin;
}

static void the_thinnest_droplets_are_lines(void **state)
{
    (void)state;
    shot s;
    open_cloud(&s, VIRGA_SPLASH_STYLE_FILM);
    draw_frame(&s);
    const uint32_t wide = prepared(&s)->wide_quads.index_count / 6, lines = prepared(&s)->lines.index_count / 2,
                   thin = prepared(&s)->thin_quads.index_count / 6;
    printf("%u wide, %u lines, %u thin of two triangles\n", wide, lines, thin);
    assert_true(lines > 10 && thin > 10);
    assert_int_equal(wide + lines + thin, prepared(&s)->sprites);
    assert_int_equal(prepared(&s)->thin_quads.first_index, 6 * (wide + lines));
    for (uint32_t i = 0; i < lines; i++)
        assert_true(is_line(&s, &sprites(&s)[wide + i], 1e-3));
    for (uint32_t i = 0; i < thin; i++)
        assert_false(is_line(&s, &sprites(&s)[wide + lines + i], -1e-3));
    close_shot(&s);
}

static void compare(virga_splash_style style, bool depth)
{
    shot s;
    open_cloud(&s, style);
    s.give_depth = depth;
    s.f.settings.soft_m = depth ? 0.05F : 0;
    s.scene_depth = stored_depth(&s, depth ? 0.51 : 100);
    apply_settings(&s);
    float *with = copy_of(&s, draw_frame(&s));
    const uint32_t lines = prepared(&s)->lines.index_count / 2, all = prepared(&s)->sprites;
    s.f.context->lines = false;
    const float *without = draw_frame(&s);
    double max_difference = 0, max = 0;
    for (size_t i = 0; i < pixel_count(&s) * 4; i++) {
        max_difference = fmax(max_difference, fabs((double)with[i] - (double)without[i]));
        max = fmax(max, (double)without[i]);
    }
    printf("%u of %u are lines; a pixel differs by up to %.3g of %.3g\n", lines, all, max_difference, max);
    assert_true(lines > 10 && prepared(&s)->lines.index_count == 0 && prepared(&s)->sprites == all);
    assert_true(max > 0 && max_difference < 1e-3 * max);
    free(with);
    close_shot(&s);
}

static void lines_look_as_two_triangles_do(void **state)
{
    (void)state;
    compare(VIRGA_SPLASH_STYLE_FILM, false);
}

static void and_where_the_scene_is_close_behind(void **state)
{
    (void)state;
    compare(VIRGA_SPLASH_STYLE_FILM, true);
}

static void and_in_the_papers_style(void **state)
{
    (void)state;
    compare(VIRGA_SPLASH_STYLE_PAPER, false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_thinnest_droplets_are_lines),
        cmocka_unit_test(lines_look_as_two_triangles_do),
        cmocka_unit_test(and_where_the_scene_is_close_behind),
        cmocka_unit_test(and_in_the_papers_style),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
