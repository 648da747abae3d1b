/* test_rain_streaks.c - streaks lie where doubles put them, and have the light that their drops give. */
#include "rain_expected_streak.h"

static void check_record(const shot *s, const virga_streak_gpu *streak, const expected *e)
{
    const double half = 1.5 / 1024; /* half floats may be rounded towards zero */
    for (int i = 0; i < 2; i++) {
        /* Float positions of a few metres over the distance, in half pictures. */
        const double tolerance =
            2e-5 + 4e-6 / fmin(e->distance[0], e->distance[1]) * (1 + fabs(e->tail[i]) + fabs(e->head[i]));
        assert_true(fabs((double)streak->head[i] - e->head[i]) < tolerance);
        assert_true(fabs((double)streak->tail[i] - e->tail[i]) < tolerance);
        assert_true(fabs((double)streak->depth[i] - e->depth[i]) < 1e-5);
        assert_true(fabs((double)streak->distance[i] - e->distance[i]) < 1e-5 * (1 + e->distance[i]));
    }
    const double drawn_width = fmax(e->width_px, (double)s->f.settings.min_width_px);
    assert_true(fabs(low_half(streak->width_alpha) - drawn_width) < half * drawn_width + 1e-5);
    assert_true(fabs(low_half(streak->body_wave) - e->body_px) < half * e->body_px + 1e-5);
    assert_true(fabs(high_half(streak->width_alpha) - e->alpha) < 3 * half * e->alpha + 1e-5);
}

/* All that prepare wrote is what doubles give, and what doubles give is there. */
static void check_records(const shot *s)
{
    const virga_streak_gpu *list = streak_list(s);
    bool *there = calloc(s->f.slots, sizeof *there);
    uint32_t checked = 0, missing = 0, due = 0;
    double missing_alpha = 0;
    expected e;
    for (uint32_t i = 0; i < streak_count(s); i++) {
        const uint32_t slot = slot_of(&list[i]);
        if (list[i].id == 0 && list[i].width_alpha == 0)
            continue; /* cut away behind the camera */
        assert_int_equal(list[i].id, rain_fixture_drops(&s->f)[slot].id);
        there[slot] = true;
        if (!expect_streak(s, slot, &e))
            continue;
        check_record(s, &list[i], &e);
        checked++;
    }
    for (uint32_t slot = 0; slot < s->f.slots; slot++) {
        if (!expect_streak(s, slot, &e) || !inside(e.head) || !inside(e.tail) || e.alpha < 1e-4 ||
            e.diameter_m < (double)s->f.settings.streak_min_mm * 1e-3)
            continue;
        due++;
        missing += !there[slot];
        missing_alpha = fmax(missing_alpha, there[slot] ? 0 : e.alpha);
    }
    printf("%u of %u streaks checked, %u of %u due are missing, the densest covers %.4f\n", checked, streak_count(s),
           missing, due, missing_alpha);
    assert_true(checked > 300);
    assert_int_equal(missing, 0);
    free(there);
}

static void streaks_lie_where_doubles_put_them(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    s.f.settings.wind_m_s[0] = 3;
    s.f.settings.wind_m_s[2] = 1;
    apply_settings(&s);
    s.f.camera[0] = 1000.25;
    aim(&s, &s.camera, s.f.camera, (const double[3]){1001, 1.5, -5});
    s.open = s.camera;
    draw_frame(&s, 0.2 + 0.007); /* between ticks */
    check_records(&s);
    close_shot(&s);
}

/* The camera walks and turns while the shutter is open. */
static void streaks_follow_a_moving_camera(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    s.f.settings.wind_m_s[0] = 3;
    s.f.settings.wind_m_s[2] = 1;
    apply_settings(&s);
    aim(&s, &s.camera, s.f.camera, (const double[3]){1, 1.5, -5});
    aim(&s, &s.open, (const double[3]){-0.05, 1.68, 0.1}, (const double[3]){0.6, 1.6, -5});
    draw_frame(&s, 0.2 + 0.007);
    check_records(&s);
    close_shot(&s);
}

/* Seen along its fall a drop hardly moves in the picture, and covers more of it. */
static void no_streak_is_missing_when_one_looks_up(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    apply_settings(&s);
    aim(&s, &s.camera, s.f.camera, (const double[3]){0.2, 10, -2});
    s.open = s.camera;
    draw_frame(&s, 0.2);
    check_records(&s);
    close_shot(&s);
}

/* Streaks that pass the camera's plane end there, all of them: what is cut at the plane lies on it, however the cut is
 * rounded. */
static void no_streak_that_passes_the_camera_is_missing(void **state)
{
    (void)state;
    shot s;
    uint32_t cut = 0, missing = 0;
    open_shot(&s, 200);
    add_picture(&s, 320, 240);
    s.shutter_s = 0.1;
    s.f.settings.streak_min_mm = 0.2f;
    apply_settings(&s);
    aim(&s, &s.camera, s.f.camera, (const double[3]){0.2, 10, -2});
    s.open = s.camera;
    draw_frame(&s, 0.2);
    for (uint32_t i = 0; i < streak_count(&s); i++) {
        const virga_streak_gpu *streak = &streak_list(&s)[i];
        missing += streak->id == 0 && streak->width_alpha == 0;
        cut += fabs((double)streak->distance[0] - 0.01) < 1e-6 || fabs((double)streak->distance[1] - 0.01) < 1e-6;
    }
    printf("%u streaks of %u are cut at the camera's plane, %u are missing\n", cut, streak_count(&s), missing);
    assert_true(cut > 3);
    assert_int_equal(missing, 0);
    close_shot(&s);
}

/* ---- waves */

/* Where drops are in their oscillation at the tails of streaks, by slot; -1: no streak. */
static void phases_at_tails(shot *s, double frame_interval_s, double *phases)
{
    for (uint32_t slot = 0; slot < s->f.slots; slot++)
        phases[slot] = -1;
    s->frame_interval_s = frame_interval_s;
    draw_frame(s, 0);
    for (uint32_t i = 0; i < streak_count(s); i++)
        if (streak_list(s)[i].width_alpha)
            phases[slot_of(&streak_list(s)[i])] = high_half(streak_list(s)[i].oscillations);
}

/* Rayleigh's second mode. */
static double oscillation_hz(double diameter_m)
{
    return sqrt(8 * 0.0728 / (998.2 * pow(0.5 * diameter_m, 3))) / (2 * M_PI);
}

/* As between the frames of a film, or the parts of one: each drop goes on by what it oscillates in the time between. */
static void drops_oscillate_alike_after_a_day_of_rain(void **state)
{
    (void)state;
    const double between_s = 1.0 / 384;
    shot s;
    uint32_t checked = 0;
    double max_error = 0;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    s.f.rain->ticks += 24 * 3600 * 60;
    double *before = calloc(s.f.slots, sizeof *before), *now = calloc(s.f.slots, sizeof *now);
    phases_at_tails(&s, between_s, before);
    phases_at_tails(&s, 0, now);
    for (uint32_t slot = 0; slot < s.f.slots; slot++) {
        if (before[slot] < 0 || now[slot] < 0)
            continue;
        const uint32_t k = ((const virga_slot_gpu *)s.slots.mapped)[slot].class_rank & 0xffff;
        const double diameter =
            VIRGA_DROP_MIN_M * pow(VIRGA_DROP_MAX_M / VIRGA_DROP_MIN_M, (k + 0.5) / VIRGA_RAIN_CLASSES);
        const double off = now[slot] - before[slot] - oscillation_hz(diameter) * between_s;
        max_error = fmax(max_error, fabs(off - round(off)));
        checked++;
    }
    printf("%u drops, off by up to %.4f of a period\n", checked, max_error);
    assert_true(checked > 300);
    assert_true(max_error < 0.005);
    free(before);
    free(now);
    close_shot(&s);
}

/* ---- light */

/* Radiant intensity over the square of the distance, times the drop's phase function: 1 / sr. */
static void lamp_at(const shot *s, const virga_light *light, const double p[3], const double d[3], double radiance[3])
{
    double way[3], distance2 = 0, along = 0, axis = 0, length2 = 0;
    for (int i = 0; i < 3; i++) {
        way[i] = light->position_m[i] - s->camera.position_m[i] - p[i];
        distance2 += way[i] * way[i];
        length2 += (double)light->direction[i] * (double)light->direction[i];
    }
    for (int i = 0; i < 3; i++) {
        along += way[i] * d[i] / sqrt(distance2);
        axis -= length2 > 0 ? way[i] * (double)light->direction[i] / sqrt(distance2 * length2) : 0;
    }
    const double range = (double)light->range_m, x = range > 0 ? distance2 / (range * range) : 0;
    const double outer = (double)light->cos_outer, inner = (double)light->cos_inner;
    const double cone = length2 > 0 ? clamp01((axis - outer) / (inner - outer)) : 1, ends = clamp01(1 - x * x);
    for (int c = 0; c < 3; c++)
        radiance[c] += (double)light->intensity[c] * ends * ends * cone * cone / distance2 * virga_drop_phase(along) *
                       (double)s->f.settings.light_gain;
}

/* The middle line shows the world through nearly straight rays, the edge through bent ones. */
static void light_of(const shot *s, const expected *e, double center[3], double rim[3])
{
    double moments[3], d[3], glitter[3] = {0};
    const double *m = e->middle, length = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    for (int i = 0; i < 3; i++)
        d[i] = m[i] / length;
    for (uint32_t i = 0; i < s->f.settings.lighting.light_count; i++)
        lamp_at(s, &s->f.settings.lighting.lights[i], m, d, glitter);
    virga_drop_phase_moments(moments);
    environment_at(s, d, (const double[3]){1, 0.97, 0.90}, center);
    environment_at(s, d, (const double[3]){1, 0.75 * moments[1], 0.3 * moments[2]}, rim);
    for (int c = 0; c < 3; c++) {
        center[c] += glitter[c];
        rim[c] += 0.6 * glitter[c];
    }
}

static void check_lights(const shot *s)
{
    uint32_t checked = 0;
    for (uint32_t i = 0; i < streak_count(s); i++) {
        const virga_streak_gpu *streak = &streak_list(s)[i];
        expected e;
        double center[3], rim[3];
        if (!streak->width_alpha || !expect_streak(s, slot_of(streak), &e))
            continue;
        light_of(s, &e, center, rim);
        const double got[6] = {low_half(streak->light[0]),  high_half(streak->light[0]), low_half(streak->light[1]),
                               high_half(streak->light[1]), low_half(streak->light[2]),  high_half(streak->light[2])};
        for (int c = 0; c < 3; c++) {
            assert_true(fabs(got[c] - center[c]) < 0.01 * center[c] + 1e-4);
            assert_true(fabs(got[3 + c] - rim[c]) < 0.01 * rim[c] + 1e-4);
        }
        checked++;
    }
    assert_true(checked > 300);
}

static void streaks_show_the_environment(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            s.f.settings.lighting.environment_sh[i][c] =
                (i ? 0.2f : 3) + 0.05f * (float)((i * 5 + c * 3) % 7) * (i % 2 ? 1 : -1);
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    check_lights(&s);
    close_shot(&s);
}

static void streaks_glitter_by_the_phase_function(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    s.f.settings.lighting.lights[0] =
        (virga_light){.position_m = {0.5, 2.2, -6}, .intensity = {90, 60, 30}, .range_m = 11};
    s.f.settings.lighting.lights[1] = (virga_light){.position_m = {-1, 4, -4},
                                                    .intensity = {20, 80, 160},
                                                    .direction = {0.4f, -2, 0.3f},
                                                    .cos_inner = 0.95f,
                                                    .cos_outer = 0.6f};
    s.f.settings.lighting.light_count = 2;
    s.f.settings.light_gain = 1.5f;
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    check_lights(&s);
    close_shot(&s);
}

/* Distance in pixels of a pixel from the picture of a place. */
static double pixels_from(const shot *s, size_t pixel, const double position[3])
{
    double from_camera[3], clip[4];
    for (int i = 0; i < 3; i++)
        from_camera[i] = position[i] - s->camera.position_m[i];
    to_clip(&s->camera, false, from_camera, clip);
    const double x = (clip[0] / clip[3] * 0.5 + 0.5) * s->picture.width,
                 y = (clip[1] / clip[3] * 0.5 + 0.5) * s->picture.height;
    return hypot((double)(pixel % s->picture.width) + 0.5 - x, (double)(pixel / s->picture.width) + 0.5 - y);
}

static void a_lamp_behind_the_rain_brightens_it_and_most_near_the_lamp(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 80);
    add_picture(&s, 320, 240);
    const double lamp[3] = {0.4, 1.9, -7};
    s.f.settings.lighting.lights[0] =
        (virga_light){.position_m = {lamp[0], lamp[1], lamp[2]}, .intensity = {50, 50, 50}};
    s.f.settings.oscillation = 0;
    apply_settings(&s);
    aim_level(&s);
    float *dark = draw_copy(&s, 0.2);
    s.f.settings.lighting.light_count = 1;
    apply_settings(&s);
    float *lit = draw_copy(&s, 0);
    double near = 0, near_covered = 0, far = 0, far_covered = 0;
    for (size_t i = 0; i < (size_t)s.picture.width * s.picture.height; i++) {
        const double more = (double)lit[i * 4] - (double)dark[i * 4], covered = (double)dark[i * 4 + 3];
        const double away = pixels_from(&s, i, lamp);
        assert_true(more >= -1e-6);
        assert_true(dark[i * 4 + 3] == lit[i * 4 + 3]);
        near += away < 40 ? more : 0;
        near_covered += away < 40 ? covered : 0;
        far += away > 110 ? more : 0;
        far_covered += away > 110 ? covered : 0;
    }
    printf("the lamp adds %.3f to what is covered near it, %.3f far from it\n", near / near_covered, far / far_covered);
    assert_true(near_covered > 1 && near > 0.1 * near_covered);
    assert_true(near / near_covered > 2 * far / far_covered);
    free(dark);
    free(lit);
    close_shot(&s);
}

static void without_lamps_nothing_glitters(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 80);
    add_picture(&s, 160, 120);
    memset(s.f.settings.lighting.environment_sh, 0, sizeof s.f.settings.lighting.environment_sh);
    s.f.settings.lighting.lights[0] = (virga_light){.position_m = {0.4, 1.9, -7}, .intensity = {50, 50, 50}};
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    for (int run = 0; run < 2; run++) {
        s.f.settings.lighting.light_count = run ? 1 : 0;
        s.f.settings.light_gain = 0;
        apply_settings(&s);
        const float *pixels = draw_frame(&s, 0);
        for (int c = 0; c < 3; c++)
            assert_true(sum_of(&s, pixels, c) == 0);
        assert_true(sum_of(&s, pixels, 3) > 1);
    }
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(streaks_lie_where_doubles_put_them),
        cmocka_unit_test(streaks_follow_a_moving_camera),
        cmocka_unit_test(no_streak_is_missing_when_one_looks_up),
        cmocka_unit_test(no_streak_that_passes_the_camera_is_missing),
        cmocka_unit_test(drops_oscillate_alike_after_a_day_of_rain),
        cmocka_unit_test(streaks_show_the_environment),
        cmocka_unit_test(streaks_glitter_by_the_phase_function),
        cmocka_unit_test(a_lamp_behind_the_rain_brightens_it_and_most_near_the_lamp),
        cmocka_unit_test(without_lamps_nothing_glitters),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
