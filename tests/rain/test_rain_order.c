/* test_rain_order.c - streaks are drawn in the order of areas of the picture, each of them once. */
#include "rain_picture_fixture.h"

enum { AREAS_ACROSS = 16 };

/* As shaders/rain/order.glsl has it, in doubles. A streak on a border between areas may be counted to either. */
static uint32_t area_of(const virga_streak_gpu *streak, double shift)
{
    double at[2];
    for (int i = 0; i < 2; i++) {
        const double middle = 0.5 * ((double)streak->head[i] + (double)streak->tail[i]);
        at[i] = fmin(fmax((0.5 * middle + 0.5) * AREAS_ACROSS + shift, 0), AREAS_ACROSS - 0.5);
    }
    return (uint32_t)at[1] * AREAS_ACROSS + (uint32_t)at[0];
}

static bool is_in_area(const virga_streak_gpu *streak, uint32_t area)
{
    return area_of(streak, -1e-4) == area || area_of(streak, 1e-4) == area || area_of(streak, 0) == area;
}

/* The streak whose two triangles lie at a place of the index buffer. */
static uint32_t streak_at(const shot *s, uint32_t place)
{
    static const uint32_t corners[6] = {0, 1, 2, 2, 1, 3};
    const uint32_t *indices = (const uint32_t *)s->order.mapped + (size_t)place * 6;
    const uint32_t streak = indices[0] / 4;
    for (uint32_t i = 0; i < 6; i++)
        assert_int_equal(indices[i], 4 * streak + corners[i]);
    return streak;
}

/* Heavy rain before a camera that sees much of it: near by big drops are wide. */
static void prepare_shot(shot *s, float rate_mm_h)
{
    open_shot(s, rate_mm_h);
    add_picture(s, 640, 480);
    s->f.settings.bodies_min_mm = 0.2F;
    s->f.settings.streak_gain = 4;
    apply_settings(s);
    const host_camera_key key = {0, {0, 1.7, 0}, {0, 1.7, -5}, 0, false};
    const host_camera_path path = {&key, 1, 70, 0.02, 100};
    host_camera_at(&path, 0, 640, 480, NULL, &s->camera);
    s->open = s->camera;
    draw_frame(s, 0.2);
}

static uint32_t wide_count(const shot *s)
{
    return ((const virga_prepared_gpu *)s->prepared.mapped)->wide.index_count / 6;
}

static void each_streak_is_drawn_once(void **state)
{
    (void)state;
    shot s;
    prepare_shot(&s, 100);
    const uint32_t count = streak_count(&s);
    printf("%u streaks\n", count);
    assert_true(count > 2 * VIRGA_RAIN_GROUP && count % VIRGA_RAIN_GROUP);
    bool *drawn = calloc(count, sizeof *drawn);
    for (uint32_t place = 0; place < count; place++) {
        const uint32_t streak = streak_at(&s, place);
        assert_true(streak < count && !drawn[streak]);
        drawn[streak] = true;
    }
    free(drawn);
    close_shot(&s);
}

static void wide_streaks_keep_their_places(void **state)
{
    (void)state;
    shot s;
    prepare_shot(&s, 100);
    printf("%u of %u streaks are wide\n", wide_count(&s), streak_count(&s));
    assert_true(wide_count(&s) > 0);
    for (uint32_t place = 0; place < wide_count(&s); place++)
        assert_int_equal(streak_at(&s, place), place);
    close_shot(&s);
}

/* Areas one after another, and within one the streaks in the order of the list, whatever ran first. */
static void thin_streaks_follow_the_picture(void **state)
{
    (void)state;
    shot s;
    prepare_shot(&s, 100);
    uint32_t area = 0, before = 0, areas = 0;
    for (uint32_t place = wide_count(&s); place < streak_count(&s); place++) {
        const uint32_t streak = streak_at(&s, place);
        const virga_streak_gpu *here = &streak_list(&s)[streak];
        const uint32_t own = here->order / VIRGA_RAIN_GROUP;
        assert_true(is_in_area(here, own));
        assert_true(place == wide_count(&s) || own > area || (own == area && streak > before));
        areas += own != area;
        area = own;
        before = streak;
    }
    assert_true(areas > AREAS_ACROSS * AREAS_ACROSS / 2);
    close_shot(&s);
}

/* What a view has left must not be counted in the next. */
static void a_view_without_rain_draws_nothing_in_order(void **state)
{
    (void)state;
    shot s;
    prepare_shot(&s, 100);
    const uint32_t before = streak_count(&s);
    s.f.settings.streak_gain = 0;
    apply_settings(&s);
    draw_frame(&s, 0);
    assert_int_equal(streak_count(&s), 0);
    s.f.settings.streak_gain = 4;
    apply_settings(&s);
    draw_frame(&s, 0);
    assert_int_equal(streak_count(&s), before);
    uint64_t sum = 0;
    for (uint32_t place = 0; place < before; place++)
        sum += streak_at(&s, place);
    assert_int_equal(sum, (uint64_t)before * (before - 1) / 2);
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_streak_is_drawn_once),
        cmocka_unit_test(wide_streaks_keep_their_places),
        cmocka_unit_test(thin_streaks_follow_the_picture),
        cmocka_unit_test(a_view_without_rain_draws_nothing_in_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
