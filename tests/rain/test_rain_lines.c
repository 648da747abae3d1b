/* test_rain_lines.c - streaks that are drawn as lines look as those of two triangles do. */
#include "rain_picture_fixture.h"

typedef struct look {
    uint32_t width, height;
    float min_width_px;
    bool depth;
} look;

/* Light rain of small drops, so that hardly any streak lies over another: which of them is in front differs. */
static float *draw_look(const look *of, bool lines, uint32_t *line_count)
{
    shot s;
    open_shot(&s, 2);
    if (lines && !s.f.context->lines)
        effect_fixture_skip("no lines on this device");
    s.f.context->lines = lines;
    add_picture(&s, of->width, of->height);
    s.f.settings.min_width_px = of->min_width_px;
    s.f.settings.wind_m_s[0] = 5;
    s.f.settings.haze = 0;
    apply_settings(&s);
    s.give_depth = of->depth;
    aim(&s, &s.camera, s.f.camera, (const double[3]){2, s.f.camera[1] - 1, -5});
    s.open = s.camera;
    s.scene_depth = stored_depth(&s, 4);
    float *pixels = draw_copy(&s, 0.2);
    *line_count = ((const virga_prepared_gpu *)s.prepared.mapped)->lines.index_count / 2;
    close_shot(&s);
    return pixels;
}

static void compare(const look *of)
{
    uint32_t lines, none;
    float *with = draw_look(of, true, &lines), *without = draw_look(of, false, &none);
    double max_difference = 0, max = 0, sum = 0, off = 0;
    for (size_t i = 0; i < (size_t)of->width * of->height * 4; i++) {
        const double one = (double)with[i], other = (double)without[i];
        max_difference = fmax(max_difference, fabs(one - other));
        max = fmax(max, other);
        sum += other;
        off += one - other;
    }
    printf("%u lines; a pixel differs by up to %.3g of %.3g, sum by %.3g\n", lines, max_difference, max, off / sum);
    assert_true(lines > 100 && none == 0);
    assert_true(max > 0 && max_difference < 1e-3 * max && fabs(off) < 1e-5 * sum);
    free(with);
    free(without);
}

static void lines_look_as_two_triangles_do(void **state)
{
    (void)state;
    compare(&(look){320, 240, 1, false});
}

static void wider_lines_too(void **state)
{
    (void)state;
    compare(&(look){320, 240, 2.3F, false});
}

static void and_where_the_scene_hides_them(void **state)
{
    (void)state;
    compare(&(look){320, 240, 1, true});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_look_as_two_triangles_do),
        cmocka_unit_test(wider_lines_too),
        cmocka_unit_test(and_where_the_scene_hides_them),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
