/* test_glass_shared.c - panes that are prepared by one call share the copies of the picture that they show, and are
 * drawn as if each had its own. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "glass_picture_fixture.h"

enum { WIDTH = 96, HEIGHT = 64, PANES = 4, TICKS = 16 };

typedef struct wall {
    shot shot; /* its own pane is the first */
    virga_glass *panes[PANES];
    virga_glass_pane shown[PANES];
    float *plate, *pixels; /* RGBA of WIDTH x HEIGHT */
} wall;

static const virga_glass_style styles[PANES] = {VIRGA_GLASS_STYLE_TEXTURES, VIRGA_GLASS_STYLE_PHYSICAL,
                                                VIRGA_GLASS_STYLE_PAPER, VIRGA_GLASS_STYLE_TEXTURES};

static void set_style(wall *w, int pane, bool still_behind)
{
    virga_glass_settings settings = virga_default_glass_settings();
    settings.style = styles[pane];
    settings.still_behind = still_behind;
    REQUIRE(virga_glass_set(w->panes[pane], &settings) == VIRGA_OK);
}

static void rain(wall *w)
{
    VkCommandBuffer cmd;
    shot_begin(&w->shot, &cmd);
    for (int i = 0; i < PANES; i++) {
        const virga_glass_step_info info = {.first_tick = w->panes[i]->last_tick + 1,
                                            .ticks = TICKS,
                                            .rate_mm_h = 200,
                                            .wind_m_s = {0, 0, -10},
                                            .air_density = 1.2f};
        REQUIRE(virga_glass_step(w->panes[i], cmd, &info) == VIRGA_OK);
    }
    shot_submit(&w->shot);
}

/* A picture with a bright lamp at column `at`. */
static void make_plate(wall *w, int at)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            float *pixel = w->plate + 4 * (y * WIDTH + x);
            pixel[0] = 0.2f + 0.8f * (float)x / WIDTH;
            pixel[1] = x / 8 == at / 8 ? 40.0f : 0.1f;
            pixel[2] = (float)y / HEIGHT;
            pixel[3] = 1;
        }
    shot_plate(&w->shot, w->plate);
}

/* Panes beside each other. The first has two views, the others one. */
static int open_wall(void **state)
{
    static wall all;
    wall *w = *state = &all;
    virga_glass_def def = shot_def();
    def.max_views = 2;
    w->plate = malloc(16 * WIDTH * HEIGHT);
    w->pixels = malloc(16 * WIDTH * HEIGHT);
    REQUIRE(w->plate && w->pixels);
    shot_open(&w->shot, &def, WIDTH, HEIGHT, true);
    for (int i = 0; i < PANES; i++) {
        def.max_views = 1;
        def.seed = (uint32_t)i + 1;
        w->panes[i] = w->shot.glass;
        if (i)
            REQUIRE(virga_glass_create(w->shot.context, &def, &w->panes[i]) == VIRGA_OK);
        set_style(w, i, false);
        REQUIRE(virga_glass_attach(w->panes[i], w->shot.layer) == VIRGA_OK);
        w->shown[i].glass = w->panes[i];
        w->shown[i].pose.position_m[0] = 0.1 * (i % 2);
        w->shown[i].pose.position_m[1] = 0.07 * (i / 2);
    }
    shot_aim(&w->shot, (const double[3]){0.1, 0.07, -0.2}, (const double[3]){0.1, 0.07, 0}, 50);
    make_plate(w, 40);
    for (int i = 0; i < 3; i++)
        rain(w);
    for (int i = 0; i < PANES; i++)
        w->shown[i].time_s = virga_glass_time(w->panes[i]);
    return 0;
}

static int close_wall(void **state)
{
    wall *w = *state;
    for (int i = 1; i < PANES; i++)
        virga_glass_destroy(&w->panes[i]);
    shot_close(&w->shot);
    free(w->plate);
    free(w->pixels);
    return 0;
}

/* How often the frame being recorded made copies. */
static uint32_t count_copies(const virga_context *context)
{
    const virga_timer_slot *slot = &context->timers.slots[context->ring_slot];
    uint32_t count = 0;
    for (uint32_t i = 0; i < slot->count / 2; i++)
        count += !strcmp(context->timers.pass_times[slot->names[i]].name, "glass.plate_copy");
    return count;
}

/* Prepares in calls of `together` panes, and draws them all. Returns how often copies were made. */
static uint32_t draw_wall(wall *w, uint32_t together)
{
    shot *s = &w->shot;
    VkCommandBuffer cmd;
    const virga_view view = shot_view(s);
    shot_begin(s, &cmd);
    shot_record_plate(s, cmd);
    for (uint32_t i = 0; i < PANES; i += together)
        REQUIRE(virga_glass_prepare_panes(cmd, &view, w->shown + i, together) == VIRGA_OK);
    const uint32_t copies = count_copies(s->context);
    host_target_begin_layer(&s->picture, cmd);
    for (int i = 0; i < PANES; i++)
        REQUIRE(virga_glass_draw(w->panes[i], cmd, s->layer) == VIRGA_OK);
    host_target_end_layer(&s->picture, cmd);
    host_target_copy_out(&s->picture, cmd, 1u << HOST_LAYER);
    shot_submit(s);
    const float *pixels = host_target_floats(&s->gpu.device, &s->picture, HOST_LAYER);
    memcpy(w->pixels, pixels, 16 * WIDTH * HEIGHT);
    return copies;
}

static float *keep_pixels(const wall *w)
{
    float *copy = malloc(16 * WIDTH * HEIGHT);
    REQUIRE(copy);
    memcpy(copy, w->pixels, 16 * WIDTH * HEIGHT);
    return copy;
}

static void expect_same(const wall *w, const float *before, bool same)
{
    if (!memcmp(w->pixels, before, 16 * WIDTH * HEIGHT) != same)
        fail_msg("the pictures are %s", same ? "not the same" : "the same");
}

/* Also after the picture behind has changed: nothing of the last frame is left. */
static void one_call_makes_one_copy_and_the_same_picture(void **state)
{
    wall *w = *state;
    assert_int_equal(draw_wall(w, 1), PANES);
    float *first = keep_pixels(w), covered = 0;
    for (int i = 3; i < 4 * WIDTH * HEIGHT; i += 4)
        covered += first[i];
    assert_true(covered > 0.01f * WIDTH * HEIGHT);
    assert_int_equal(draw_wall(w, PANES), 1);
    expect_same(w, first, true);
    make_plate(w, 64);
    assert_int_equal(draw_wall(w, PANES), 1);
    expect_same(w, first, false);
    float *second = keep_pixels(w);
    assert_int_equal(draw_wall(w, 1), PANES);
    expect_same(w, second, true);
    free(first);
    free(second);
}

/* Near panes that are to show the drops of far ones are prepared by another call, which copies the picture anew. */
static void each_call_copies_the_picture_as_it_is_then(void **state)
{
    wall *w = *state;
    assert_int_equal(draw_wall(w, PANES / 2), 2);
    float *two = keep_pixels(w);
    assert_int_equal(draw_wall(w, 1), PANES);
    expect_same(w, two, true);
    free(two);
}

/* The copies of a pane with one view may be replaced while a view of a pane with two still shows them. */
static void copies_live_as_long_as_the_views_that_show_them(void **state)
{
    wall *w = *state;
    draw_wall(w, 1);
    float *before = keep_pixels(w);
    const virga_glass_pane first = w->shown[0], second = w->shown[1];
    w->shown[0] = second;
    w->shown[1] = first;
    assert_int_equal(draw_wall(w, PANES), 2);
    expect_same(w, before, true);
    w->shown[0] = first;
    w->shown[1] = second;
    free(before);
}

/* A pane that begins to keep its textures has shown another's copies until then: it goes on so, or makes its own. */
static void panes_that_keep_textures_need_copies_too(void **state)
{
    wall *w = *state;
    assert_int_equal(draw_wall(w, PANES), 1);
    float *before = keep_pixels(w);
    set_style(w, 0, true);
    set_style(w, 3, true);
    /* The first keeps its own, so that the second makes those of the others. */
    assert_int_equal(draw_wall(w, PANES), 1);
    expect_same(w, before, true);
    /* Alone, the last makes its own, and then keeps them. */
    assert_int_equal(draw_wall(w, 1), 3);
    expect_same(w, before, true);
    assert_int_equal(draw_wall(w, 1), 2);
    expect_same(w, before, true);
    set_style(w, 0, false);
    set_style(w, 3, false);
    free(before);
}

static void wrong_panes_are_refused(void **state)
{
    wall *w = *state;
    VkCommandBuffer cmd;
    const virga_view view = shot_view(&w->shot);
    shot_begin(&w->shot, &cmd);
    assert_int_equal(virga_glass_prepare_panes(cmd, &view, NULL, 0), VIRGA_OK);
    assert_int_equal(virga_glass_prepare_panes(cmd, &view, NULL, 1), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_glass_prepare_panes(cmd, NULL, w->shown, PANES), VIRGA_ERROR_INVALID);
    w->shown[2].glass = NULL;
    virga_glass *third = w->panes[2];
    w->shown[0].prepared = 1;
    assert_int_equal(virga_glass_prepare_panes(cmd, &view, w->shown, PANES), VIRGA_ERROR_INVALID);
    assert_int_equal(w->shown[0].prepared, 0);
    w->shown[2].glass = third;
    assert_int_equal(count_copies(w->shot.context), 0);
    shot_submit(&w->shot);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_call_makes_one_copy_and_the_same_picture),
        cmocka_unit_test(each_call_copies_the_picture_as_it_is_then),
        cmocka_unit_test(copies_live_as_long_as_the_views_that_show_them),
        cmocka_unit_test(panes_that_keep_textures_need_copies_too),
        cmocka_unit_test(wrong_panes_are_refused),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, open_wall, close_wall));
}
