/* test_rain_temporal.c - motion vectors of streaks against doubles, their pixels and masks, and what a temporal resolve
 * makes of rain with and without them. */
#include "rain_fixture.h"
#include "rain_one_streak.h"

#include "../host/resolve.h"

#include "rain/rain_internal.h"

enum { WIDTH = 160, HEIGHT = 90 };

#define FRAME_S (1.0 / 60)

typedef struct shot {
    rain_fixture f;
    temporal_picture picture;
    virga_target *target;
    virga_view view;
    host_buffer streaks, prepared, slots;
    int only; /* index of the only streak that is drawn; -1: all */
} shot;

/* Rain in the open and no haze; nothing fades for being near. */
static void open_shot(shot *s, float rate_mm_h)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 16384;
    def.range_m = 8;
    def.occlusion_size = 0;
    memset(s, 0, sizeof *s);
    rain_fixture_open(&s->f);
    rain_fixture_rain(&s->f, &def);
    rain_fixture_readback(&s->f, s->f.rain->streak_buffer->size, &s->streaks);
    rain_fixture_readback(&s->f, s->f.rain->prepared_buffer->size, &s->prepared);
    rain_fixture_readback(&s->f, s->f.rain->slot_buffer->size, &s->slots);
    s->f.settings.rate_mm_h = rate_mm_h;
    s->f.settings.wind_m_s[0] = 2;
    REQUIRE(virga_rain_set(s->f.rain, &s->f.settings) == VIRGA_OK);
    picture_open(&s->f.gpu.device, WIDTH, HEIGHT, &s->picture);
    const virga_target_def target = picture_target(&s->picture);
    REQUIRE(virga_target_create(s->f.context, &target, &s->target) == VIRGA_OK);
    REQUIRE(virga_rain_attach(s->f.rain, s->target) == VIRGA_OK);
    s->only = -1;
}

static void close_shot(shot *s)
{
    host_buffer *buffers[] = {&s->streaks, &s->prepared, &s->slots};
    virga_target_destroy(&s->target);
    picture_close(&s->f.gpu.device, &s->picture);
    for (size_t i = 0; i < 3; i++)
        host_buffer_destroy(&s->f.gpu.device, buffers[i]);
    rain_fixture_close(&s->f);
}

static void aim(host_camera *camera, double x, double z, double to_x, const float jitter_px[2])
{
    const host_camera_key key = {0, {x, 1.5, z}, {to_x, 1.5, z - 5}, 0, false};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 45, .near_m = 0.05, .far_m = 100};
    host_camera_at(&path, 0, WIDTH, HEIGHT, jitter_px, camera);
}

/* A game's previous camera, apart from the shutter's. */
static void set_previous(virga_view *view, const host_camera *before, double frame_interval_s)
{
    memcpy(view->temporal.position_m, before->position_m, sizeof before->position_m);
    memcpy(view->temporal.view_from_world, before->view_from_world, sizeof before->view_from_world);
    memcpy(view->temporal.clip_from_view, before->clip_from_view, sizeof before->clip_from_view);
    view->temporal.frame_interval_s = frame_interval_s;
}

static void draw_frame(shot *s, double dt_s)
{
    const VkCommandBuffer cmd = rain_fixture_begin_frame(&s->f);
    rain_fixture_record_step(&s->f, cmd, dt_s);
    REQUIRE(virga_rain_prepare(s->f.rain, cmd, &s->view, virga_rain_time(s->f.rain)) == VIRGA_OK);
    const virga_rain *rain = s->f.rain;
    const virga_buffer *from[] = {rain->streak_buffer, rain->prepared_buffer, rain->slot_buffer, rain->drop_buffer};
    const host_buffer *to[] = {&s->streaks, &s->prepared, &s->slots, &s->f.drops};
    for (size_t i = 0; i < 4; i++)
        rain_fixture_copy(cmd, &(virga_rain_buffer){from[i]->buffer, 0, from[i]->size}, to[i]);
    if (s->only >= 0)
        record_only(s->f.rain, cmd, (uint32_t)s->only, false);
    picture_begin(&s->picture, cmd);
    REQUIRE(virga_rain_draw(s->f.rain, cmd, s->target) == VIRGA_OK);
    picture_end(&s->picture, cmd);
    rain_fixture_end_frame(&s->f);
    for (size_t i = 0; i < 4; i++)
        host_buffer_invalidate(&s->f.gpu.device, to[i]);
    picture_read(&s->f.gpu.device, &s->picture);
}

/* ---- vectors in doubles */

/* Where a drop was `frame_interval_s` before the time drawn, in the world. */
static void drop_at(const shot *s, uint32_t slot, double frame_interval_s, double position[3])
{
    const virga_rain *rain = s->f.rain;
    const uint32_t k = ((const virga_slot_gpu *)s->slots.mapped)[slot].class_rank & 0xffff;
    const double diameter = VIRGA_DROP_MIN_M * pow(VIRGA_DROP_MAX_M / VIRGA_DROP_MIN_M, (k + 0.5) / VIRGA_RAIN_CLASSES);
    const double since = virga_rain_time(rain) - (double)rain->ticks * rain->def.tick_s - frame_interval_s;
    for (int i = 0; i < 3; i++) {
        const double velocity =
            (double)s->f.settings.wind_m_s[i] - (i == 1 ? virga_drop_terminal_speed(diameter, 0) : 0);
        position[i] = (double)rain_fixture_drops(&s->f)[slot].position[i] + s->f.origin[i] + velocity * since;
    }
}

static uint32_t slot_of(const virga_streak_gpu *streak)
{
    return streak->id & ((1u << VIRGA_RAIN_ID_SLOT_BITS) - 1);
}

/* From where a drop is to where it was, at the head (open_s 0) or the tail of its streak. False: too near. */
static bool expect_motion(const shot *s, uint32_t slot, double open_s, const host_camera *now,
                          const host_camera *before, double motion[2])
{
    double here[3], there[3], pixel[2], was[2];
    drop_at(s, slot, open_s, here);
    drop_at(s, slot, open_s + s->view.temporal.frame_interval_s, there);
    if (camera_pixel(now, here, pixel) < 0.3 || camera_pixel(before, there, was) < 0.3)
        return false;
    motion[0] = was[0] - pixel[0];
    motion[1] = was[1] - pixel[1];
    return true;
}

static const float (*motions_of(const shot *s))[4]
{
    return (const float(*)[4])((const char *)s->streaks.mapped + s->f.rain->def.max_streaks * sizeof(virga_streak_gpu));
}

static uint32_t streak_count(const shot *s)
{
    return ((const virga_prepared_gpu *)s->prepared.mapped)->streaks;
}

/* A walking, turning camera with a jitter that must not show, and rain in wind. Floats of some metres: 0.02 px. */
static void streaks_come_from_where_doubles_put_their_drops(void **state)
{
    (void)state;
    const float jitter[2] = {0.3f, -0.4f};
    shot s;
    host_camera now, before;
    uint32_t checked = 0;
    open_shot(&s, 40);
    aim(&now, 0.1, 0, 0.3, jitter);
    aim(&before, 0, 0.05, 0.1, jitter);
    s.view = virga_default_view();
    host_camera_view(&now, &now, 1.0 / 96, &s.view);
    set_previous(&s.view, &before, FRAME_S);
    draw_frame(&s, 0.2 + 0.007); /* between ticks */
    for (uint32_t i = 0; i < streak_count(&s); i++) {
        const virga_streak_gpu *streak = (const virga_streak_gpu *)s.streaks.mapped + i;
        for (int end = 0; end < 2 && streak->width_alpha; end++) {
            double expected[2];
            if (!expect_motion(&s, slot_of(streak), end * s.view.shutter_s, &now, &before, expected))
                continue;
            for (int axis = 0; axis < 2; axis++)
                if (!(fabs((double)motions_of(&s)[i][2 * end + axis] - expected[axis]) <
                      0.02 + 1e-4 * fabs(expected[axis])))
                    fail_msg("streak %u, end %d: %g px, expected %g", i, end, (double)motions_of(&s)[i][2 * end + axis],
                             expected[axis]);
            checked++;
        }
    }
    assert_true(checked > 300);
    close_shot(&s);
}

/* Where the camera of the previous frame is not given it is the open one, a shutter time ago: the streak's own way. */
static void an_open_camera_is_the_previous_one_by_default(void **state)
{
    (void)state;
    shot s;
    host_camera now, open;
    uint32_t checked = 0;
    open_shot(&s, 40);
    aim(&now, 0.1, 0, 0.3, NULL);
    aim(&open, 0, 0, 0.2, NULL);
    s.view = virga_default_view();
    host_camera_view(&now, &open, 1.0 / 96, &s.view);
    draw_frame(&s, 0.2);
    for (uint32_t i = 0; i < streak_count(&s); i++) {
        const virga_streak_gpu *streak = (const virga_streak_gpu *)s.streaks.mapped + i;
        if (!streak->width_alpha || streak->distance[0] < 0.3f || streak->distance[1] < 0.3f)
            continue;
        for (int axis = 0; axis < 2; axis++) {
            const double way = 0.5 * (double)(streak->tail[axis] - streak->head[axis]) * (axis ? HEIGHT : WIDTH);
            assert_true(fabs((double)motions_of(&s)[i][axis] - way) < 0.01 + 1e-4 * fabs(way));
        }
        checked++;
    }
    assert_true(checked > 150);
    close_shot(&s);
}

/* The widest streak that is on the picture with both ends. */
static int widest_streak(const shot *s)
{
    int widest = -1;
    float width = 0;
    for (uint32_t i = 0; i < streak_count(s); i++) {
        const virga_streak_gpu *streak = (const virga_streak_gpu *)s->streaks.mapped + i;
        const bool inside = fabsf(streak->head[0]) < 0.9f && fabsf(streak->head[1]) < 0.9f &&
                            fabsf(streak->tail[0]) < 0.9f && fabsf(streak->tail[1]) < 0.9f;
        const float here = picture_half(streak->width_alpha & 0xffff) * picture_half(streak->width_alpha >> 16);
        if (inside && here > width) {
            width = here;
            widest = (int)i;
        }
    }
    REQUIRE(widest >= 0);
    return widest;
}

/* A pixel of a streak has its motion where the streak covers enough of it, with the scale asked for; else what was
 * there. Half floats: 1/1024 of the value; and between the ends it is taken as even: 0.05 px. */
static void check_pixels(const shot *s, float scale, double min)
{
    const float *ends = motions_of(s)[s->only];
    uint32_t used = 0, left = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        const double alpha = (double)s->picture.color[4 * i + 3];
        if (fabs(alpha - min) < 1e-5)
            continue;
        assert_int_equal(picture_has_motion(&s->picture, i), alpha >= min);
        left += alpha > 0 && alpha < min;
        if (alpha < min)
            continue;
        for (int axis = 0; axis < 2; axis++) {
            const double a = (double)(ends[axis] * scale), b = (double)(ends[2 + axis] * scale), margin = fabs(a - b);
            const double value = (double)s->picture.motion[2 * i + (size_t)axis];
            assert_true(value > fmin(a, b) - margin - 0.05 - fabs(a) / 1024);
            assert_true(value < fmax(a, b) + margin + 0.05 + fabs(a) / 1024);
        }
        used++;
    }
    assert_true(used > 3 && left > 3);
}

static void pixels_that_a_streak_covers_enough_have_its_motion(void **state)
{
    (void)state;
    shot s;
    host_camera now;
    open_shot(&s, 40);
    s.f.settings.streak_gain = 8;
    REQUIRE(virga_rain_set(s.f.rain, &s.f.settings) == VIRGA_OK);
    aim(&now, 0, 0, 0, NULL);
    s.view = virga_default_view();
    host_camera_view(&now, &now, 1.0 / 96, &s.view);
    set_previous(&s.view, &now, FRAME_S);
    draw_frame(&s, 0.2);
    s.only = widest_streak(&s);
    draw_frame(&s, 0);
    float max = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++)
        max = fmaxf(max, s.picture.color[4 * i + 3]);
    s.view.temporal.motion_coverage = 0.5f * max;
    for (int back = 0; back < 2; back++) {
        s.view.temporal.motion_scale[0] = s.view.temporal.motion_scale[1] = back ? -0.5f : 1;
        draw_frame(&s, 0);
        check_pixels(&s, back ? -0.5f : 1, 0.5 * (double)max);
    }
    close_shot(&s);
}

/* 1 - (1 - coverage)^gain, also where streaks lie over one another. Eight bits, rounded once a layer: 3 of them. */
static void the_mask_is_the_coverage_of_so_many_layers(void **state)
{
    (void)state;
    shot s;
    host_camera now;
    open_shot(&s, 150);
    REQUIRE(virga_rain_set(s.f.rain, &s.f.settings) == VIRGA_OK);
    aim(&now, 0, 0, 0, NULL);
    s.view = virga_default_view();
    host_camera_view(&now, &now, 1.0 / 96, &s.view);
    for (int k = 0; k < 3; k++) {
        const double gain = (const double[]){1, 8, 0}[k];
        s.view.temporal.reactive_gain = (float)gain;
        draw_frame(&s, k ? 0 : 0.2);
        double max = 0;
        for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
            const double expected = 1 - pow(1 - (double)s.picture.color[4 * i + 3], gain);
            assert_true(fabs((double)s.picture.reactive[i] - expected) < 3.5 / 255);
            max = fmax(max, expected);
        }
        assert_true(gain > 0 ? max > 0.2 : max == 0);
    }
    close_shot(&s);
}

/* A target may have one of the two: the same pixels, and the other attachment is left alone. */
static void a_target_with_one_of_them_writes_that_alone(void **state)
{
    (void)state;
    enum { PIXELS = WIDTH * HEIGHT };
    shot s;
    host_camera now;
    open_shot(&s, 60);
    aim(&now, 0, 0, 0, NULL);
    s.view = virga_default_view();
    host_camera_view(&now, &now, 1.0 / 96, &s.view);
    s.view.temporal.motion_coverage = 0.02f;
    draw_frame(&s, 0.2);
    float *motion = malloc(PIXELS * 8), *reactive = malloc(PIXELS * 4);
    memcpy(motion, s.picture.motion, PIXELS * 8);
    memcpy(reactive, s.picture.reactive, PIXELS * 4);
    virga_target *both = s.target;
    for (int only_motion = 0; only_motion < 2; only_motion++) {
        virga_target_def def = picture_target(&s.picture);
        *(only_motion ? &def.reactive_attachment : &def.motion_attachment) = 0;
        REQUIRE(virga_target_create(s.f.context, &def, &s.target) == VIRGA_OK);
        REQUIRE(virga_rain_attach(s.f.rain, s.target) == VIRGA_OK);
        draw_frame(&s, 0);
        uint32_t moves = 0, masked = 0;
        for (size_t i = 0; i < PIXELS; i++) {
            moves += picture_has_motion(&s.picture, i);
            masked += s.picture.reactive[i] > 0;
        }
        assert_true(only_motion ? moves > 10 && !masked : masked > 10 && !moves);
        assert_memory_equal(only_motion ? s.picture.motion : s.picture.reactive, only_motion ? motion : reactive,
                            only_motion ? PIXELS * 8 : PIXELS * 4);
        virga_target_destroy(&s.target);
    }
    s.target = both;
    free(motion);
    free(reactive);
    close_shot(&s);
}

/* ---- a resolve */

typedef struct rain_scene {
    resolve_scene scene; /* first */
    shot *shot;
    uint32_t frame;
    double dt_s;
} rain_scene;

/* A walk to the side. */
static void camera_of(uint32_t frame, const float jitter_px[2], host_camera *camera)
{
    aim(camera, 0.005 * frame, 0, 0.005 * frame, jitter_px);
}

static void advance(resolve_scene *scene, uint32_t frame)
{
    rain_scene *r = (rain_scene *)scene;
    r->frame = frame;
    r->dt_s = frame ? FRAME_S : 0.2;
}

static void draw(resolve_scene *scene, const float jitter_px[2])
{
    rain_scene *r = (rain_scene *)scene;
    camera_of(r->frame + 1, jitter_px, &scene->now);
    camera_of(r->frame, jitter_px, &scene->before);
    host_camera_view(&scene->now, &scene->before, 1.0 / 96, &r->shot->view);
    r->shot->view.open_camera_s = FRAME_S; /* the previous frame's camera, as a game has it */
    draw_frame(r->shot, r->dt_s);
    r->dt_s = 0;
}

static void a_resolve_smears_rain_less_with_the_outputs(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 60);
    s.f.settings.streak_gain = 4; /* as games want it */
    REQUIRE(virga_rain_set(s.f.rain, &s.f.settings) == VIRGA_OK);
    s.view = virga_default_view();
    rain_scene scene = {.scene = {.picture = &s.picture, .name = "rain", .advance = advance, .draw = draw}, .shot = &s};
    const resolve_errors errors = resolve_run(&scene.scene);
    for (int clamped = 0; clamped < 2; clamped++)
        assert_true(errors.rms[clamped][1] < 0.9 * errors.rms[clamped][0]); /* measured: 0.81, 0.76 */
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(streaks_come_from_where_doubles_put_their_drops),
        cmocka_unit_test(an_open_camera_is_the_previous_one_by_default),
        cmocka_unit_test(pixels_that_a_streak_covers_enough_have_its_motion),
        cmocka_unit_test(the_mask_is_the_coverage_of_so_many_layers),
        cmocka_unit_test(a_target_with_one_of_them_writes_that_alone),
        cmocka_unit_test(a_resolve_smears_rain_less_with_the_outputs),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
