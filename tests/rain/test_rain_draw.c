/* test_rain_draw.c - ways to render the rain: an attached depth, dynamic rendering and reversed depth give the same
 * picture. */
#include "rain_expected_streak.h"

/* ---- ways to render */

/* Another kind of target for the same rain. */
static void change_target(shot *s, virga_target_kind kind, bool depth_attached)
{
    virga_target_destroy(&s->layer);
    if (depth_attached && !s->tested.pass)
        tested_pass_create(&s->f.gpu.device, &s->picture, layer_image(s)->view, &s->tested);
    s->layer_def.kind = kind;
    s->layer_def.depth_attached = depth_attached;
    s->layer_def.depth_format = depth_attached ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED;
    s->layer_def.reversed_depth = s->reversed;
    s->layer_def.render_pass = kind == VIRGA_TARGET_DYNAMIC ? VK_NULL_HANDLE : s->tested.pass;
    REQUIRE(virga_target_create(s->f.context, &s->layer_def, &s->layer) == VIRGA_OK);
    REQUIRE(virga_rain_attach(s->f.rain, s->layer) == VIRGA_OK);
}

/* A small picture in rain, looking level. */
static void open_level(shot *s)
{
    open_shot(s, 80);
    add_picture(s, 160, 120);
    apply_settings(s);
    aim_level(s);
}

static void an_attached_depth_hides_what_is_behind_it(void **state)
{
    (void)state;
    shot s;
    double distance = 0;
    open_level(&s);
    draw_frame(&s, 0.2);
    s.only = choose_streak(&s, &distance);
    const double whole = sum_of(&s, draw_frame(&s, 0), 3);
    change_target(&s, VIRGA_TARGET_RENDER_PASS, true);
    assert_true(sum_of(&s, draw_frame(&s, 0), 3) == whole);
    s.scene_depth = stored_depth(&s, distance + 0.01);
    assert_true(sum_of(&s, draw_frame(&s, 0), 3) == whole);
    s.scene_depth = stored_depth(&s, distance - 0.01);
    assert_true(sum_of(&s, draw_frame(&s, 0), 3) == 0);
    close_shot(&s);
}

static void assert_same_pixels(const shot *s, const float *a, const float *b)
{
    assert_true(sum_of(s, a, 3) > 1);
    assert_memory_equal(a, b, (size_t)s->picture.width * s->picture.height * 4 * sizeof(float));
}

static void require_dynamic_rendering(void)
{
    if (dynamic_rendering_there)
        return;
    printf("skipped: the device has no VK_KHR_dynamic_rendering\n");
    skip();
}

static void dynamic_rendering_gives_the_pixels_of_a_render_pass(void **state)
{
    (void)state;
    shot s;
    open_level(&s);
    if (!dynamic_rendering_there) {
        close_shot(&s);
        require_dynamic_rendering();
    }
    s.give_depth = true;
    s.scene_depth = stored_depth(&s, 3);
    float *pass = draw_copy(&s, 0.2);
    change_target(&s, VIRGA_TARGET_DYNAMIC, false);
    assert_same_pixels(&s, pass, draw_frame(&s, 0));
    free(pass);
    s.give_depth = false;
    change_target(&s, VIRGA_TARGET_RENDER_PASS, true);
    pass = draw_copy(&s, 0);
    change_target(&s, VIRGA_TARGET_DYNAMIC, true);
    assert_same_pixels(&s, pass, draw_frame(&s, 0));
    free(pass);
    close_shot(&s);
}

static void assert_near_pixels(const shot *s, const float *a, const float *b)
{
    assert_true(sum_of(s, a, 3) > 1);
    for (size_t i = 0; i < (size_t)s->picture.width * s->picture.height * 4; i++)
        assert_true(fabsf(a[i] - b[i]) < 1e-3f * fabsf(a[i]) + 1e-5f);
}

/* Depth sampled (soft edges, haze) and depth attached. */
static void reversed_depth_gives_the_same_picture(void **state)
{
    (void)state;
    shot s;
    float *pictures[2][2];
    open_shot(&s, 80);
    s.f.settings.haze = 4;
    apply_settings(&s);
    for (int reversed = 0; reversed < 2; reversed++) {
        add_picture(&s, 160, 120);
        s.reversed = reversed;
        aim_level(&s);
        s.scene_depth = stored_depth(&s, 3);
        s.give_depth = true;
        pictures[reversed][0] = draw_copy(&s, reversed ? 0 : 0.2);
        s.give_depth = false;
        change_target(&s, VIRGA_TARGET_RENDER_PASS, true);
        pictures[reversed][1] = draw_copy(&s, 0);
        if (!reversed)
            remove_picture(&s);
    }
    assert_near_pixels(&s, pictures[0][0], pictures[1][0]);
    assert_near_pixels(&s, pictures[0][1], pictures[1][1]);
    for (int i = 0; i < 4; i++)
        free(pictures[i / 2][i % 2]);
    close_shot(&s);
}

static void where_nothing_is_the_sky_also_in_reversed_depth(void **state)
{
    (void)state;
    shot s;
    open_level(&s);
    s.give_depth = true;
    float *normal = draw_copy(&s, 0.2);
    s.reversed = true;
    s.scene_depth = 0;
    assert_near_pixels(&s, normal, draw_frame(&s, 0));
    free(normal);
    close_shot(&s);
}

/* ---- frames that do not do everything */

/* What a frame reads lies in its own part of the ring: the parts of those before may be written by frames to come while
 * the device still reads them. */
static void frames_without_a_step_show_the_newest_one(void **state)
{
    (void)state;
    shot s;
    open_level(&s);
    float *stepped = draw_copy(&s, 0.2);
    const VkDeviceSize per_frame = s.f.rain->tick_ring.buffer->size / s.f.context->frames_in_flight;
    for (uint32_t i = 0; i < 2 * s.f.context->frames_in_flight + 1; i++) {
        assert_same_pixels(&s, stepped, draw_without_step(&s, rain_fixture_begin_frame(&s.f)));
        assert_int_equal(s.f.rain->tick_offset / per_frame, s.f.context->ring_slot);
    }
    free(stepped);
    close_shot(&s);
}

static void a_step_after_a_prepare_has_all_of_its_ticks(void **state)
{
    (void)state;
    shot s;
    open_level(&s);
    draw_frame(&s, 0.2);
    const VkCommandBuffer cmd = rain_fixture_begin_frame(&s.f);
    const virga_view view = view_of(&s);
    assert_int_equal(virga_rain_prepare(s.f.rain, cmd, &view, virga_rain_time(s.f.rain)), VIRGA_OK);
    rain_fixture_record_step(&s.f, cmd, s.f.rain->def.max_ticks_per_step * s.f.rain->def.tick_s);
    rain_fixture_end_frame(&s.f);
    uint32_t ticks = 0;
    virga_rain_ticks(s.f.rain, NULL, &ticks);
    assert_int_equal(ticks, s.f.rain->def.max_ticks_per_step);
    close_shot(&s);
}

static void a_frame_without_a_prepare_draws_nothing(void **state)
{
    (void)state;
    shot s;
    open_level(&s);
    draw_frame(&s, 0.2);
    for (int stepped = 0; stepped < 2; stepped++) {
        const VkCommandBuffer cmd = rain_fixture_begin_frame(&s.f);
        if (stepped)
            rain_fixture_record_step(&s.f, cmd, 1.0 / 60);
        assert_int_equal(virga_rain_draw(s.f.rain, cmd, s.layer), VIRGA_NOT_READY);
        rain_fixture_end_frame(&s.f);
    }
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_attached_depth_hides_what_is_behind_it),
        cmocka_unit_test(dynamic_rendering_gives_the_pixels_of_a_render_pass),
        cmocka_unit_test(reversed_depth_gives_the_same_picture),
        cmocka_unit_test(where_nothing_is_the_sky_also_in_reversed_depth),
        cmocka_unit_test(frames_without_a_step_show_the_newest_one),
        cmocka_unit_test(a_step_after_a_prepare_has_all_of_its_ticks),
        cmocka_unit_test(a_frame_without_a_prepare_draws_nothing),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
