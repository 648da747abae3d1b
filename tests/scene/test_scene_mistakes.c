/* test_scene_mistakes.c - what a host forgets or mixes up: one line that says so with its id, and a result, where there
 * would be no rain and no reason. */
#include "../gpu/gpu_fixture.h"
#include "../gpu/small_scene.h"

#include <math.h>

typedef struct mistaken {
    gpu_fixture *f;
    virga_context *context;
    virga_scene *scene;
    gpu_picture picture;
    virga_scene_frame frame;
    virga_scene_pane panes[SMALL_PANES];
    virga_view view;
    VkCommandBuffer cmd;
} mistaken;

#define SIZE(table) (sizeof(table) / sizeof(table)[0])

static void open_scene(mistaken *m, void **state)
{
    virga_glass_def panes[SMALL_PANES];
    const virga_scene_def def = small_scene_def(panes);
    memset(m, 0, sizeof *m);
    m->f = *state;
    virga_context_def context_def = gpu_context_def(m->f);
    context_def.log_repeats = false;
    REQUIRE(virga_context_create(&context_def, &m->context) == VIRGA_OK);
    gpu_picture_open(m->f, m->context, &m->picture);
    REQUIRE(virga_scene_create(m->context, &def, &m->scene) == VIRGA_OK);
    small_panes_lay(m->panes);
    m->view = gpu_view(&m->picture);
    m->frame = (virga_scene_frame){.dt_s = 1.0 / 60, .camera_m = {0, 1.7, 0}, .view = &m->view, .panes = m->panes};
}

static void close_scene(mistaken *m)
{
    gpu_wait(m->f);
    virga_scene_destroy(&m->scene);
    gpu_picture_close(m->f, &m->picture);
    virga_context_destroy(&m->context);
}

static virga_result record(mistaken *m)
{
    m->cmd = gpu_begin_frame(m->f, m->context);
    return virga_scene_record(m->scene, m->cmd, &m->frame);
}

static virga_result draw(mistaken *m)
{
    host_target_begin_layer(&m->picture.images, m->cmd);
    const virga_result result = virga_scene_draw(m->scene, m->cmd, m->picture.target);
    host_target_end_layer(&m->picture.images, m->cmd);
    gpu_submit(m->f);
    return result;
}

/* Each effect says it once, until a draw has all that it needs. */
static void a_draw_of_nothing_says_why(void **state)
{
    mistaken m;
    open_scene(&m, state);
    gpu_forget_log(m.f);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(record(&m), VIRGA_OK);
        assert_int_equal(draw(&m), VIRGA_NOT_READY); /* no virga_scene_attach */
    }
    const uint32_t effects = 2 + SMALL_PANES; /* rain, splashes and panes */
    assert_int_equal(m.f->lines[VIRGA_LOG_NOT_DRAWN], effects);
    REQUIRE(virga_scene_attach(m.scene, m.picture.target) == VIRGA_OK);
    assert_int_equal(record(&m), VIRGA_OK);
    assert_int_equal(draw(&m), VIRGA_OK);
    assert_int_equal(m.f->lines[VIRGA_LOG_NOT_DRAWN], effects);
    m.frame.view = NULL; /* nothing is prepared */
    assert_int_equal(record(&m), VIRGA_OK);
    assert_int_equal(draw(&m), VIRGA_NOT_READY);
    assert_int_equal(m.f->lines[VIRGA_LOG_NOT_DRAWN], 2 * effects);
    close_scene(&m);
}

static void panes_that_nobody_prepared_are_logged(void **state)
{
    mistaken m;
    open_scene(&m, state);
    REQUIRE(virga_scene_attach(m.scene, m.picture.target) == VIRGA_OK);
    gpu_forget_log(m.f);
    m.frame.defer_panes = true;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(record(&m), VIRGA_OK);
        assert_int_equal(draw(&m), VIRGA_NOT_READY);
    }
    assert_int_equal(m.f->lines[VIRGA_LOG_NOT_DRAWN], SMALL_PANES);
    assert_int_equal(record(&m), VIRGA_OK);
    assert_int_equal(virga_scene_prepare_panes(m.scene, m.cmd, &m.view, m.panes), VIRGA_OK);
    assert_int_equal(draw(&m), VIRGA_OK);
    assert_int_equal(m.f->lines[VIRGA_LOG_NOT_DRAWN], SMALL_PANES);
    close_scene(&m);
}

/* A camera_m that was forgotten. The rain of small scenes reaches less than 100 m. */
static void a_view_beyond_the_rain_is_logged(void **state)
{
    mistaken m;
    open_scene(&m, state);
    gpu_forget_log(m.f);
    m.view.position_m[0] = m.view.open_position_m[0] = 1000;
    for (int i = 0; i < 2; i++) {
        assert_int_equal(record(&m), VIRGA_OK);
        gpu_submit(m.f);
    }
    assert_int_equal(m.f->lines[VIRGA_LOG_NOT_DRAWN], 1);
    assert_int_equal(m.f->errors, 0);
    close_scene(&m);
}

static void refused(mistaken *m, const char *part)
{
    gpu_forget_log(m->f);
    assert_int_equal(record(m), VIRGA_ERROR_INVALID);
    gpu_submit(m->f);
    assert_one_error(m->f, VIRGA_LOG_ARGUMENT);
    if (!strstr(m->f->last, part))
        fail_msg("'%s' says nothing of %s", m->f->last, part);
    m->view = gpu_view(&m->picture);
}

/* Only the depth test would have said so, by drawing nothing. */
static void a_target_whose_depth_runs_the_other_way_is_refused(void **state)
{
    mistaken m;
    open_scene(&m, state);
    virga_target_def def = virga_default_target_def();
    host_target_describe_layer(&m.picture.images, &def);
    def.depth_attached = def.reversed_depth = true;
    virga_target_destroy(&m.picture.target);
    REQUIRE(virga_target_create(m.context, &def, &m.picture.target) == VIRGA_OK);
    for (int i = 0; i < 9; i++) {
        assert_int_equal(record(&m), VIRGA_OK);
        gpu_forget_log(m.f);
        REQUIRE(virga_rain_attach(virga_scene_rain(m.scene), m.picture.target) == VIRGA_OK);
        assert_int_equal(virga_rain_draw(virga_scene_rain(m.scene), m.cmd, m.picture.target), VIRGA_ERROR_INVALID);
        assert_int_equal(m.f->errors, i ? 0 : 1); /* once, not in every frame */
        gpu_submit(m.f);
    }
    close_scene(&m);
}

/* Split screen with both halves prepared first: the second one would be drawn twice. */
static void a_view_that_is_replaced_before_it_is_drawn_is_told(void **state)
{
    mistaken m;
    open_scene(&m, state);
    virga_rain *rain = virga_scene_rain(m.scene);
    REQUIRE(virga_rain_attach(rain, m.picture.target) == VIRGA_OK);
    for (int in_turn = 1; in_turn >= 0; in_turn--) {
        assert_int_equal(record(&m), VIRGA_OK);
        gpu_forget_log(m.f);
        for (int i = 0; i < 3; i++) {
            if (in_turn) {
                host_target_begin_layer(&m.picture.images, m.cmd);
                assert_int_equal(virga_rain_draw(rain, m.cmd, m.picture.target), VIRGA_OK);
                host_target_end_layer(&m.picture.images, m.cmd);
            }
            assert_int_equal(virga_rain_prepare(rain, m.cmd, &m.view, virga_rain_time(rain)), VIRGA_OK);
        }
        assert_int_equal(m.f->lines[VIRGA_LOG_NOT_DRAWN], in_turn ? 0 : 1);
        gpu_submit(m.f);
    }
    close_scene(&m);
}

/* Nothing may step a second time: rain would, and the ground would not. */
static void a_scene_that_is_recorded_twice_is_refused(void **state)
{
    mistaken m;
    open_scene(&m, state);
    assert_int_equal(record(&m), VIRGA_OK);
    const double time_s = virga_rain_time(virga_scene_rain(m.scene));
    gpu_forget_log(m.f);
    for (int i = 0; i < 10; i++)
        assert_int_equal(virga_scene_record(m.scene, m.cmd, &m.frame), VIRGA_ERROR_INVALID);
    assert_one_error(m.f, VIRGA_LOG_ARGUMENT);
    assert_true(virga_rain_time(virga_scene_rain(m.scene)) == time_s);
    gpu_submit(m.f);
    assert_int_equal(record(&m), VIRGA_OK);
    gpu_submit(m.f);
    close_scene(&m);
}

/* What is wrong in 40 frames is said in the first and in the tenth. */
static void a_mistake_of_every_frame_is_counted(void **state)
{
    mistaken m;
    open_scene(&m, state);
    const virga_view good = m.view;
    const double fine = m.frame.dt_s;
    static const virga_log_id ids[3] = {VIRGA_LOG_TICKS_DROPPED, VIRGA_LOG_ARGUMENT, VIRGA_LOG_ARGUMENT};
    for (int mistake = 0; mistake < 3; mistake++) {
        gpu_forget_log(m.f);
        for (int i = 0; i < 40; i++) {
            m.view = good;
            m.frame.dt_s = mistake == 0 ? 0.5 + 0.01 * i : fine; /* more than four ticks */
            m.view.viewport[2] = mistake == 1 ? 0.01f * (float)i : good.viewport[2];
            m.view.position_m[0] = mistake == 2 ? (double)NAN : 0;
            record(&m);
            gpu_submit(m.f);
        }
        if (m.f->lines[ids[mistake]] != 2)
            fail_msg("mistake %d: %u lines, the last: %s", mistake, m.f->lines[ids[mistake]], m.f->last);
        assert_non_null(strstr(m.f->last, "(10 times so far)"));
    }
    close_scene(&m);
}

static void views_that_contradict_themselves_are_refused(void **state)
{
    mistaken m;
    open_scene(&m, state);
    m.view.reversed_depth = true;
    refused(&m, "reversed_depth");
    m.view.viewport[3] =
        -m.view.viewport[3]; /* as to flip the picture: refused like a view of no pixels, with a hint */
    gpu_forget_log(m.f);
    assert_int_equal(record(&m), VIRGA_NOT_READY);
    gpu_submit(m.f);
    assert_int_equal(m.f->lines[VIRGA_LOG_ARGUMENT], 1);
    assert_non_null(strstr(m.f->last, "negate clip_from_view[5]"));
    m.view = gpu_view(&m.picture);
    m.view.depth = (virga_image){.image = m.picture.images.images[0].image};
    refused(&m, "view.depth: expected an image and its view");
    m.view.depth = (virga_image){.image = m.picture.images.images[0].image,
                                 .view = m.picture.images.images[0].view,
                                 .format = VK_FORMAT_R32_UINT,
                                 .before = {.layout = VK_IMAGE_LAYOUT_GENERAL}};
    refused(&m, "view.depth.format");
    m.view.color.view = m.picture.images.images[0].view;
    refused(&m, "view.color: expected an image and its view");
    m.view.color.image = m.picture.images.images[0].image;
    m.view.color.view = m.picture.images.images[0].view;
    refused(&m, "view.color.before.layout");
    close_scene(&m);
}

static void lists_and_pointers_that_are_missing_are_named(void **state)
{
    mistaken m;
    open_scene(&m, state);
    m.frame.occluder_count = 1;
    refused(&m, "scene_frame.occluders");
    virga_occluder mesh = small_occluder((VkBuffer)(uintptr_t)1, (VkBuffer)(uintptr_t)1);
    memset(mesh.world_from_mesh, 0, sizeof mesh.world_from_mesh);
    m.frame.occluders = &mesh; /* refused before a buffer is looked at */
    refused(&m, "world_from_mesh");
    gpu_forget_log(m.f);
    assert_int_equal(virga_scene_lighting_set(m.scene, NULL), VIRGA_ERROR_INVALID);
    assert_one_error(m.f, VIRGA_LOG_ARGUMENT);
    close_scene(&m);
}

/* Targets of two contexts may have the same number. */
static void targets_of_other_contexts_are_refused(void **state)
{
    mistaken m;
    open_scene(&m, state);
    virga_context *other = gpu_context(m.f);
    virga_target *target = NULL, *own = m.picture.target;
    virga_target_def def = virga_default_target_def();
    def.kind = VIRGA_TARGET_DYNAMIC;
    def.color_formats[0] = VK_FORMAT_R16G16B16A16_SFLOAT;
    def.depth_attached = false;
    REQUIRE(virga_target_create(other, &def, &target) == VIRGA_OK);
    REQUIRE(virga_scene_attach(m.scene, own) == VIRGA_OK);
    assert_int_equal(record(&m), VIRGA_OK);
    gpu_forget_log(m.f);
    m.picture.target = target;
    assert_int_equal(draw(&m), VIRGA_ERROR_INVALID);
    assert_one_error(m.f, VIRGA_LOG_ARGUMENT);
    gpu_forget_log(m.f);
    assert_int_equal(virga_glass_draw(virga_scene_glass(m.scene, 0), m.cmd, target), VIRGA_ERROR_INVALID);
    assert_one_error(m.f, VIRGA_LOG_ARGUMENT);
    gpu_forget_log(m.f);
    assert_int_equal(virga_rain_draw_haze(virga_scene_rain(m.scene), m.cmd, &m.view, NULL, target),
                     VIRGA_ERROR_INVALID);
    assert_one_error(m.f, VIRGA_LOG_ARGUMENT);
    m.picture.target = own;
    close_scene(&m);
    virga_target_destroy(&target);
    virga_context_destroy(&other);
}

static void ground_tells_its_settings(void **state)
{
    mistaken m;
    open_scene(&m, state);
    virga_ground *ground = virga_scene_ground(m.scene);
    virga_ground_settings settings = virga_default_ground_settings(), got;
    settings.evaporation_mm_h = 3;
    assert_int_equal(virga_ground_set(ground, &settings), VIRGA_OK);
    virga_ground_get(ground, &got);
    assert_memory_equal(&got, &settings, sizeof got);
    virga_ground_get(ground, NULL);
    virga_ground_get(NULL, &got);
    close_scene(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(a_draw_of_nothing_says_why),
        gpu_kept_test(panes_that_nobody_prepared_are_logged),
        gpu_kept_test(a_view_beyond_the_rain_is_logged),
        gpu_kept_test(views_that_contradict_themselves_are_refused),
        gpu_kept_test(a_target_whose_depth_runs_the_other_way_is_refused),
        gpu_kept_test(a_view_that_is_replaced_before_it_is_drawn_is_told),
        gpu_kept_test(a_scene_that_is_recorded_twice_is_refused),
        gpu_kept_test(a_mistake_of_every_frame_is_counted),
        gpu_kept_test(lists_and_pointers_that_are_missing_are_named),
        gpu_kept_test(targets_of_other_contexts_are_refused),
        gpu_kept_test(ground_tells_its_settings),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("scene mistakes", tests, NULL, NULL));
}
