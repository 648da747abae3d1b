/* test_rain_order.c - streaks are drawn in the order of areas of the picture, each of them once. */
#include "rain_picture_fixture.h"

enum { AREAS_ACROSS = 16 };

static bool has_lines(const shot *s)
{
    return s->f.context->lines;
}

/* As shaders/rain/draw/order.glsl has it, in doubles. A streak on a border between areas may be counted to either. */
static uint32_t area_of(const virga_streak_gpu *streak, uint32_t down, double shift)
{
    const uint32_t areas[2] = {AREAS_ACROSS, down};
    double at[2];
    for (int i = 0; i < 2; i++) {
        const double middle = 0.5 * ((double)streak->head[i] + (double)streak->tail[i]);
        at[i] = fmin(fmax((0.5 * middle + 0.5) * areas[i] + shift, 0), areas[i] - 0.5);
    }
    return (uint32_t)at[1] * AREAS_ACROSS + (uint32_t)at[0];
}

static bool is_in_area(const shot *s, const virga_streak_gpu *streak, uint32_t area)
{
    const uint32_t down = has_lines(s) ? AREAS_ACROSS / 2 : AREAS_ACROSS;
    return area_of(streak, down, -1e-4) == area || area_of(streak, down, 1e-4) == area ||
           area_of(streak, down, 0) == area;
}

static const virga_prepared_gpu *prepared_of(const shot *s)
{
    return s->prepared.mapped;
}

/* The streak whose triangles or line are at a slot of a draw. */
static uint32_t streak_at(const shot *s, const virga_draw_gpu *draw, uint32_t slot)
{
    static const uint32_t corners[6] = {0, 1, 2, 2, 1, 3}, ends[2] = {0, 2};
    const bool line = draw == &prepared_of(s)->lines;
    const uint32_t *indices = (const uint32_t *)s->order.mapped + draw->first_index + (size_t)slot * (line ? 2 : 6);
    const uint32_t streak = indices[0] / 4;
    for (uint32_t i = 0; i < (line ? 2 : 6); i++)
        assert_int_equal(indices[i], 4 * streak + (line ? ends : corners)[i]);
    assert_true(streak < streak_count(s));
    return streak;
}

static uint32_t count_of(const shot *s, const virga_draw_gpu *draw)
{
    return draw->index_count / (draw == &prepared_of(s)->lines ? 2 : 6);
}

static bool covers(const virga_streak_gpu *streak)
{
    return high_half(streak->width_alpha) > 0;
}

/* As thin as the thinnest and whole on the picture, by a margin either way. */
static bool is_line_by(const shot *s, const virga_streak_gpu *streak, double margin)
{
    const double width = low_half(streak->width_alpha), body = low_half(streak->body_wave);
    const double sizes[2] = {s->picture.width, s->picture.height};
    bool inside = true;
    for (int i = 0; i < 2; i++)
        inside = inside && fmax(fabs((double)streak->head[i]), fabs((double)streak->tail[i])) + (body + 2) / sizes[i] <
                               1 + margin;
    return inside && width < ((double)s->f.settings.min_width_px + 0.001) * (1 + margin);
}

/* Heavy rain before a camera that sees much of it: near by big drops are wide. */
static void aim_shot(shot *s)
{
    add_picture(s, 640, 480);
    s->f.settings.streak_min_mm = 0.2F;
    s->f.settings.streak_gain = 4;
    apply_settings(s);
    const host_camera_key key = {0, {0, 1.7, 0}, {0, 1.7, -5}, 0, false};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 70, .near_m = 0.02, .far_m = 100};
    host_camera_at(&path, 0, 640, 480, NULL, &s->camera);
    s->open = s->camera;
    draw_frame(s, 0.2);
}

static void prepare_shot(shot *s, float rate_mm_h)
{
    open_shot(s, rate_mm_h);
    aim_shot(s);
}

static void each_streak_is_drawn_once(void **state)
{
    (void)state;
    shot s;
    prepare_shot(&s, 100);
    const virga_prepared_gpu *prepared = prepared_of(&s);
    const virga_draw_gpu *draws[3] = {&prepared->wide_quads, &prepared->lines, &prepared->thin_quads};
    const uint32_t count = streak_count(&s);
    bool *drawn = calloc(count, sizeof *drawn);
    for (int i = 0; i < 3; i++)
        for (uint32_t slot = 0; slot < count_of(&s, draws[i]); slot++) {
            const uint32_t streak = streak_at(&s, draws[i], slot);
            assert_false(drawn[streak]);
            drawn[streak] = true;
        }
    uint32_t nothing = 0;
    for (uint32_t i = 0; i < count; i++) {
        assert_true(drawn[i] == covers(&streak_list(&s)[i]) || i < count_of(&s, &prepared->wide_quads));
        nothing += !drawn[i];
    }
    printf("%u streaks, %u of them cover nothing\n", count, nothing);
    assert_true(count > 2 * VIRGA_RAIN_GROUP && count % VIRGA_RAIN_GROUP);
    free(drawn);
    close_shot(&s);
}

static void wide_streaks_keep_their_order(void **state)
{
    (void)state;
    shot s;
    prepare_shot(&s, 100);
    const virga_draw_gpu *wide = &prepared_of(&s)->wide_quads;
    printf("%u of %u streaks are wide\n", count_of(&s, wide), streak_count(&s));
    assert_true(count_of(&s, wide) > 0);
    for (uint32_t slot = 0; slot < count_of(&s, wide); slot++)
        assert_int_equal(streak_at(&s, wide, slot), slot);
    close_shot(&s);
}

/* Areas one after another, and within one the streaks in the order of the list, whatever ran first. Returns in how many
 * areas there are any. */
static uint32_t check_order(const shot *s, const virga_draw_gpu *draw, uint32_t first_bucket)
{
    uint32_t area = 0, before = 0, areas = 0;
    for (uint32_t slot = 0; slot < count_of(s, draw); slot++) {
        const uint32_t streak = streak_at(s, draw, slot);
        const virga_streak_gpu *here = &streak_list(s)[streak];
        const uint32_t own = here->order / VIRGA_RAIN_GROUP - first_bucket;
        assert_true(is_in_area(s, here, own));
        assert_true(slot == 0 || own > area || (own == area && streak > before));
        areas += slot == 0 || own != area;
        area = own;
        before = streak;
    }
    return areas;
}

static void thin_streaks_follow_the_picture(void **state)
{
    (void)state;
    shot s;
    prepare_shot(&s, 100);
    const virga_prepared_gpu *prepared = prepared_of(&s);
    const uint32_t lines = check_order(&s, &prepared->lines, 0);
    const uint32_t quads = check_order(&s, &prepared->thin_quads, has_lines(&s) ? VIRGA_RAIN_BUCKETS / 2 : 0);
    assert_true(quads > VIRGA_RAIN_BUCKETS / 4);
    assert_true(!has_lines(&s) || lines > VIRGA_RAIN_BUCKETS / 4);
    close_shot(&s);
}

static void the_thinnest_are_lines_where_the_device_has_them(void **state)
{
    (void)state;
    shot s;
    prepare_shot(&s, 100);
    const virga_prepared_gpu *prepared = prepared_of(&s);
    const uint32_t lines = count_of(&s, &prepared->lines), quads = count_of(&s, &prepared->thin_quads);
    printf("%u lines, %u thin streaks of two triangles\n", lines, quads);
    assert_true(quads > 0 && (lines > 0) == has_lines(&s));
    for (uint32_t slot = 0; slot < lines; slot++)
        assert_true(is_line_by(&s, &streak_list(&s)[streak_at(&s, &prepared->lines, slot)], 1e-4));
    for (uint32_t slot = 0; has_lines(&s) && slot < quads; slot++)
        assert_false(is_line_by(&s, &streak_list(&s)[streak_at(&s, &prepared->thin_quads, slot)], -1e-4));
    close_shot(&s);
}

/* Of the streaks, the indices and the draws. Without lines, which only one of the variants has. */
static uint64_t hash_of_order(virga_pass_variants variants, uint32_t max_streaks, uint32_t *dropped)
{
    shot s;
    virga_rain_def def = shot_def();
    def.max_streaks = max_streaks;
    effect_fixture_variants = variants;
    open_shot_of(&s, &def, 100);
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
    s.f.context->lines = false;
    aim_shot(&s);
    const virga_prepared_gpu *prepared = prepared_of(&s);
    const virga_draw_gpu *thin = &prepared->thin_quads;
    uint64_t hash = rain_fixture_hash(prepared, sizeof *prepared, HASH_START);
    hash = rain_fixture_hash(streak_list(&s), streak_count(&s) * sizeof(virga_streak_gpu), hash);
    hash = rain_fixture_hash(s.order.mapped, (thin->first_index + thin->index_count) * sizeof(uint32_t), hash);
    *dropped = prepared->dropped;
    close_shot(&s);
    return hash;
}

/* With room for all streaks, and for some. */
static void passes_for_software_and_for_a_gpu_give_the_same_order(void **state)
{
    (void)state;
    const uint32_t rooms[2] = {0, 300}; /* 0: for all */
    uint32_t dropped[2];
    for (int i = 0; i < 2; i++) {
        const uint64_t software = hash_of_order(VIRGA_VARIANTS_SOFTWARE, rooms[i], &dropped[0]);
        assert_true(hash_of_order(VIRGA_VARIANTS_GPU, rooms[i], &dropped[1]) == software);
        assert_int_equal(dropped[0], dropped[1]);
        assert_int_equal(dropped[0] > 0, i);
    }
}

static uint64_t sum_of_streaks(const shot *s)
{
    const virga_prepared_gpu *prepared = prepared_of(s);
    const virga_draw_gpu *draws[3] = {&prepared->wide_quads, &prepared->lines, &prepared->thin_quads};
    uint64_t sum = 0;
    for (int i = 0; i < 3; i++)
        for (uint32_t slot = 0; slot < count_of(s, draws[i]); slot++)
            sum += 1 + streak_at(s, draws[i], slot);
    return sum;
}

/* What a view has left must not be counted in the next. */
static void a_view_without_rain_draws_nothing_in_order(void **state)
{
    (void)state;
    shot s;
    prepare_shot(&s, 100);
    const uint64_t before = sum_of_streaks(&s);
    s.f.settings.streak_gain = 0;
    apply_settings(&s);
    draw_frame(&s, 0);
    assert_int_equal(streak_count(&s), 0);
    assert_int_equal(sum_of_streaks(&s), 0);
    s.f.settings.streak_gain = 4;
    apply_settings(&s);
    draw_frame(&s, 0);
    assert_int_equal(sum_of_streaks(&s), before);
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_streak_is_drawn_once),
        cmocka_unit_test(wide_streaks_keep_their_order),
        cmocka_unit_test(thin_streaks_follow_the_picture),
        cmocka_unit_test(the_thinnest_are_lines_where_the_device_has_them),
        cmocka_unit_test(passes_for_software_and_for_a_gpu_give_the_same_order),
        cmocka_unit_test(a_view_without_rain_draws_nothing_in_order),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
