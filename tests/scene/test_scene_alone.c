/* test_scene_alone.c - hosts that call effects without a scene, and forget that a frame has begun: each effect
 * refuses what it can not do, and says so once. On a stand-in for a device. */
#include "alone_fixture.h"

#include <math.h>

/* The first one and the tenth. */
static void need_counted_errors(const alone *a, const effect_calls *effect, const char *part)
{
    if (a->errors != 2 || !strstr(a->last, part) || !strstr(a->last, "(10 times so far)"))
        fail_msg("%s: %u errors, the last line: %s", effect->name, a->errors, a->last);
}

static void need_one_error(const alone *a, const effect_calls *effect, const char *part)
{
    if (a->errors != 1 || !strstr(a->last, part))
        fail_msg("%s: %u errors, the last line: %s", effect->name, a->errors, a->last);
}

/* ---- frames that were not begun */

static void an_effect_that_is_recorded_three_times_says_so_once(void **state)
{
    (void)state;
    for (size_t i = 0; i < EFFECTS; i++) {
        const effect_calls *effect = &effects[i];
        alone a;
        if (!effect->step)
            continue;
        open_all(&a);
        begin_frame(&a);
        assert_int_equal(effect->step(&a), VIRGA_OK);
        const uint32_t commands = stand_in_count(a.cmd).commands;
        assert_int_equal(effect->step(&a), VIRGA_ERROR_INVALID);
        assert_int_equal(effect->step(&a), VIRGA_ERROR_INVALID);
        assert_int_equal(stand_in_count(a.cmd).commands, commands);
        need_one_error(&a, effect, "virga_frame_begin");
        begin_frame(&a);
        assert_int_equal(effect->step(&a), VIRGA_OK);
        close_all(&a);
    }
}

/* The host calls it once in its life, or never. */
static void frames_that_were_not_begun_are_counted(void **state)
{
    (void)state;
    for (size_t i = 0; i < EFFECTS; i++)
        for (int begun = 0; begun < 2; begun++) {
            const effect_calls *effect = &effects[i];
            virga_result result = VIRGA_OK;
            alone a;
            open_all(&a);
            if (begun)
                begin_frame(&a);
            for (int frame = 0; frame < 40; frame++)
                result = effect->step ? effect->step(&a) : effect->prepare(&a);
            assert_int_equal(result, VIRGA_ERROR_INVALID);
            need_counted_errors(&a, effect, "virga_frame_begin");
            close_all(&a);
        }
}

/* More than a frame has room for. */
static void views_of_many_frames_in_one_are_counted(void **state)
{
    (void)state;
    for (size_t i = 0; i < EFFECTS; i++) {
        const effect_calls *effect = &effects[i];
        virga_result result = VIRGA_OK;
        alone a;
        if (!effect->prepare)
            continue;
        open_all(&a);
        begin_frame(&a);
        if (effect->step)
            assert_int_equal(effect->step(&a), VIRGA_OK);
        for (int frame = 0; frame < 40; frame++)
            result = effect->prepare(&a);
        if (result != VIRGA_ERROR_INVALID)
            fail_msg("%s: %s, the last line: %s", effect->name, virga_result_name(result), a.last);
        need_counted_errors(&a, effect, "virga_frame_begin");
        close_all(&a);
    }
}

/* ---- mistakes of every frame */

static void spoil(virga_view *view, int mistake, int frame)
{
    if (mistake == 0)
        view->viewport[2] = 0.01f * (float)frame; /* no pixels */
    else if (mistake == 1)
        view->position_m[1] = (double)NAN;
    else
        view->position_m[1] = 2e9 + frame; /* beyond the world */
}

/* In 40 frames it is said at the first time and at the tenth. */
static void a_wrong_view_of_every_frame_is_counted(void **state)
{
    (void)state;
    for (size_t i = 0; i < EFFECTS; i++)
        for (int mistake = 0; mistake < 3; mistake++) {
            const effect_calls *effect = &effects[i];
            alone a;
            if (!effect->prepare && effect->step != step_environment)
                continue;
            open_all(&a);
            for (int frame = 0; frame < 40; frame++) {
                fill_view(&a.view);
                begin_frame(&a);
                if (effect->step && effect->prepare)
                    assert_true(effect->step(&a) >= 0);
                spoil(&a.view, mistake, frame);
                const virga_result result = effect->prepare ? effect->prepare(&a) : effect->step(&a);
                assert_int_equal(result, mistake == 0 ? VIRGA_NOT_READY : VIRGA_ERROR_INVALID);
            }
            if (a.lines != 2 || !strstr(a.last, "(10 times so far)"))
                fail_msg("%s, mistake %d: %u lines, the last: %s", effect->name, mistake, a.lines, a.last);
            close_all(&a);
        }
}

/* All effects with the same wrong camera: one mistake, one line. */
static void one_camera_for_all_effects_is_one_line(void **state)
{
    alone a;
    (void)state;
    open_all(&a);
    begin_frame(&a);
    for (size_t i = 0; i < EFFECTS; i++)
        if (effects[i].step)
            assert_int_equal(effects[i].step(&a), VIRGA_OK);
    a.view.position_m[1] = (double)NAN;
    for (size_t i = 0; i < EFFECTS; i++)
        if (effects[i].prepare)
            assert_int_equal(effects[i].prepare(&a), VIRGA_ERROR_INVALID);
    assert_int_equal(a.lines, 1);
    close_all(&a);
}

static void dropped_ticks_of_every_frame_are_counted(void **state)
{
    alone a;
    (void)state;
    open_all(&a);
    for (int frame = 0; frame < 40; frame++) {
        const virga_rain_step_info info = {.dt_s = 0.5 + 0.01 * frame};
        begin_frame(&a);
        assert_int_equal(virga_rain_step(a.rain, a.cmd, &info), VIRGA_DEGRADED);
    }
    assert_int_equal(a.lines, 2);
    assert_non_null(strstr(a.last, "(10 times so far)"));
    close_all(&a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_effect_that_is_recorded_three_times_says_so_once),
        cmocka_unit_test(frames_that_were_not_begun_are_counted),
        cmocka_unit_test(views_of_many_frames_in_one_are_counted),
        cmocka_unit_test(a_wrong_view_of_every_frame_is_counted),
        cmocka_unit_test(one_camera_for_all_effects_is_one_line),
        cmocka_unit_test(dropped_ticks_of_every_frame_are_counted),
    };
    return cmocka_run_group_tests_name("effects alone", tests, NULL, NULL);
}
