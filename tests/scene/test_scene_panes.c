/* test_scene_panes.c - panes of a scene: made, stepped with its rain, prepared, drawn, refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "../host/effect_fixture.h"

#include "glass/glass_internal.h"

#include <virga/virga.h>

#define SIDE 32 /* pixels of the picture */

typedef struct scene_fixture {
    fixture gpu;
    virga_context *context;
    char said[256]; /* newest line of the log */
} scene_fixture;

static void keep_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    scene_fixture *f = user;
    (void)level;
    (void)id;
    snprintf(f->said, sizeof f->said, "%s", text);
}

static int set_up(void **state)
{
    static scene_fixture f;
    f.context = effect_fixture_open(&f.gpu, false, keep_line, &f);
    f.said[0] = 0;
    *state = &f;
    return 0;
}

/* Nothing is left, and the layer has nothing to say. */
static int tear_down(void **state)
{
    scene_fixture *f = *state;
    REQUIRE(host_wait(&f->gpu.device, f->gpu.error, sizeof f->gpu.error));
    virga_context_destroy(&f->context);
    return effect_device_give_back(&f->gpu) ? -1 : 0;
}

static virga_scene_def small_scene(virga_glass_def panes[2])
{
    virga_scene_def def = virga_default_scene_def();
    def.rain.seed = 70;
    def.rain.max_drops = 1024;
    def.rain.occlusion_size = 0;
    def.rain.max_ticks_per_step = 32;
    def.panes = panes;
    def.pane_count = 2;
    for (int i = 0; i < 2; i++) {
        panes[i] = virga_default_glass_def();
        panes[i].width_m = 0.2f;
        panes[i].height_m = 0.2f;
        panes[i].max_drops = 2048;
        panes[i].max_texels = 128;
    }
    return def;
}

static virga_scene *make_catching_scene(scene_fixture *f, uint32_t catching)
{
    virga_glass_def panes[2];
    virga_scene_def def = small_scene(panes);
    def.rain.max_panes = catching;
    virga_scene *scene = NULL;
    REQUIRE(virga_scene_create(f->context, &def, &scene) == VIRGA_OK);
    memset(panes, 0xff, sizeof panes); /* copied */
    virga_rain_settings rain;
    virga_rain_get(virga_scene_rain(scene), &rain);
    rain.rate_mm_h = 100;
    rain.transition_s = 0;
    REQUIRE(virga_rain_set(virga_scene_rain(scene), &rain) == VIRGA_OK);
    return scene;
}

static virga_scene *make_scene(scene_fixture *f)
{
    return make_catching_scene(f, 0);
}

static VkCommandBuffer begin(scene_fixture *f)
{
    VkCommandBuffer cmd;
    REQUIRE(host_begin_frame(&f->gpu.device, &cmd, f->gpu.error, sizeof f->gpu.error));
    REQUIRE(virga_frame_begin(f->context, f->gpu.device.frame, f->gpu.device.completed) == VIRGA_OK);
    return cmd;
}

static void finish(scene_fixture *f)
{
    REQUIRE(host_submit(&f->gpu.device, f->gpu.error, sizeof f->gpu.error));
    REQUIRE(host_wait(&f->gpu.device, f->gpu.error, sizeof f->gpu.error));
    REQUIRE(virga_frame_completed(f->context, f->gpu.device.completed) == VIRGA_OK);
}

/* Level, facing up, at half a metre before the camera. */
static void lay_panes(virga_scene_pane panes[2])
{
    static const float up[9] = {1, 0, 0, 0, 0, -1, 0, 1, 0};
    memset(panes, 0, 2 * sizeof *panes);
    for (int i = 0; i < 2; i++) {
        memcpy(panes[i].pose.world_from_pane, up, sizeof up);
        panes[i].pose.position_m[0] = -0.1;
        panes[i].pose.position_m[1] = -0.5;
    }
}

static void definitions_are_checked(void **state)
{
    scene_fixture *f = *state;
    virga_glass_def panes[2];
    virga_scene_def def = small_scene(panes);
    virga_scene *scene = (virga_scene *)f;
    def.pane_count = VIRGA_SCENE_MAX_PANES + 1;
    assert_int_equal(virga_scene_create(f->context, &def, &scene), VIRGA_ERROR_INVALID);
    assert_null(scene);
    REQUIRE(strstr(f->said, "scene_def.pane_count: expected up to 128"));
    def.pane_count = 1;
    def.panes = NULL;
    assert_int_equal(virga_scene_create(f->context, &def, &scene), VIRGA_ERROR_INVALID);
    REQUIRE(strstr(f->said, "panes NULL"));
    def.panes = panes;
    def.pane_count = 2;
    panes[1].cookie ^= 1; /* the first is made, and goes again */
    assert_int_equal(virga_scene_create(f->context, &def, &scene), VIRGA_ERROR_INVALID);
    assert_null(scene);
}

static void panes_take_seeds_and_ticks_from_the_rain(void **state)
{
    scene_fixture *f = *state;
    virga_scene *scene = make_scene(f);
    for (uint32_t i = 0; i < 2; i++) {
        const virga_glass *glass = virga_scene_glass(scene, i);
        assert_non_null(glass);
        assert_int_equal(glass->def.seed, 70 + i);
        assert_int_equal(glass->def.max_ticks_per_step, 32);
        REQUIRE(glass->def.tick_s == virga_default_rain_def().tick_s);
    }
    assert_null(virga_scene_glass(scene, 2));
    assert_null(virga_scene_glass(NULL, 0));
    virga_scene_destroy(&scene);
}

/* Half a second of 100 mm/h on 0.04 m^2 is 556 microlitres, to what a few hundred drops leave to chance. */
static void rain_lands_on_what_is_not_under_cover(void **state)
{
    scene_fixture *f = *state;
    virga_scene *scene = make_scene(f);
    virga_scene_pane panes[2];
    lay_panes(panes);
    panes[1].shelter = 1;
    const virga_scene_frame frame = {.dt_s = 0.5, .panes = panes};
    REQUIRE(virga_scene_record(scene, begin(f), &frame) == VIRGA_OK);
    finish(f);
    virga_glass_stats open, covered;
    virga_glass_stats_get(virga_scene_glass(scene, 0), &open);
    virga_glass_stats_get(virga_scene_glass(scene, 1), &covered);
    assert_int_equal(covered.landed_nl, 0);
    if (open.landed_nl < 350000 || open.landed_nl > 800000)
        fail_msg("%llu nl landed, expected about 556000", (unsigned long long)open.landed_nl);
    assert_int_equal(open.landed_nl, open.drops_nl + open.particles_nl + open.film_nl + open.run_off_nl +
                                         open.wiped_nl + open.evaporated_nl);
    REQUIRE(virga_glass_time(virga_scene_glass(scene, 0)) == virga_rain_time(virga_scene_rain(scene)));
    virga_scene_destroy(&scene);
}

/* The first catches what falls, the second gets as much at the rate; both from the same sky. */
static void panes_catch_the_drops_that_fall(void **state)
{
    scene_fixture *f = *state;
    virga_scene *scene = make_catching_scene(f, 1);
    virga_scene_pane panes[2];
    lay_panes(panes);
    const virga_scene_frame frame = {.dt_s = 0.5, .panes = panes};
    for (int i = 0; i < 8; i++) {
        REQUIRE(virga_scene_record(scene, begin(f), &frame) == VIRGA_OK);
        finish(f);
    }
    virga_glass_stats caught, expected;
    virga_glass_stats_get(virga_scene_glass(scene, 0), &caught);
    virga_glass_stats_get(virga_scene_glass(scene, 1), &expected);
    const double share = (double)caught.landed_nl / (double)expected.landed_nl;
    if (!(share > 0.75 && share < 1.33))
        fail_msg("%llu nl of drops that fall, %llu nl of the rate", (unsigned long long)caught.landed_nl,
                 (unsigned long long)expected.landed_nl);
    assert_int_not_equal(caught.landed_nl, expected.landed_nl);
    virga_scene_destroy(&scene);
}

static void frames_are_checked(void **state)
{
    scene_fixture *f = *state;
    virga_scene *scene = make_scene(f);
    virga_scene_pane panes[2];
    lay_panes(panes);
    virga_scene_frame frame = {.dt_s = 0.1};
    assert_int_equal(virga_scene_record(scene, begin(f), &frame), VIRGA_ERROR_INVALID);
    REQUIRE(strstr(f->said, "scene_frame.panes: expected 2, got NULL"));
    finish(f);
    panes[1].shelter = 1.5f;
    frame.panes = panes;
    assert_int_equal(virga_scene_record(scene, begin(f), &frame), VIRGA_ERROR_INVALID);
    REQUIRE(strstr(f->said, "scene_pane.shelter: expected 0 to 1, got 1.5"));
    finish(f);
    virga_scene_destroy(&scene);
}

static void preparing_later_is_checked(void **state)
{
    scene_fixture *f = *state;
    virga_scene *scene = make_scene(f);
    virga_scene_pane panes[2];
    const virga_view view = virga_default_view();
    lay_panes(panes);
    VkCommandBuffer cmd = begin(f);
    assert_int_equal(virga_scene_prepare_panes(NULL, cmd, &view, panes), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_scene_prepare_panes(scene, cmd, NULL, panes), VIRGA_ERROR_INVALID);
    REQUIRE(strstr(f->said, "virga_scene_prepare_panes: view is NULL"));
    assert_int_equal(virga_scene_prepare_panes(scene, cmd, &view, NULL), VIRGA_ERROR_INVALID);
    REQUIRE(strstr(f->said, "virga_scene_prepare_panes: panes is NULL"));
    finish(f);
    virga_scene_destroy(&scene);
}

/* Rain and panes get it, and keep what else they were set to. */
static void light_is_the_same_for_all_effects(void **state)
{
    scene_fixture *f = *state;
    virga_scene *scene = make_scene(f);
    virga_lighting light = virga_default_lighting();
    virga_rain_settings rain;
    virga_glass_settings glass;
    light.light_count = 1;
    light.lights[0].intensity[1] = 7;
    light.environment_sh[0][2] = 0.25f;
    assert_int_equal(virga_scene_lighting_set(scene, NULL), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_scene_lighting_set(NULL, &light), VIRGA_ERROR_INVALID);
    REQUIRE(virga_scene_lighting_set(scene, &light) == VIRGA_OK);
    virga_rain_get(virga_scene_rain(scene), &rain);
    assert_memory_equal(&rain.lighting, &light, sizeof light);
    REQUIRE(rain.rate_mm_h == 100);
    for (uint32_t i = 0; i < 2; i++) {
        virga_glass_get(virga_scene_glass(scene, i), &glass);
        assert_memory_equal(&glass.lighting, &light, sizeof light);
    }
    light.lights[0].intensity[1] = NAN;
    assert_int_equal(virga_scene_lighting_set(scene, &light), VIRGA_ERROR_INVALID);
    virga_scene_destroy(&scene);
}

/* Looking straight down. */
static virga_view look_down(void)
{
    virga_view view = virga_default_view();
    static const float down[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
    static const float lens[16] = {2, 0, 0, 0, 0, -2, 0, 0, 0, 0, -1.001f, -1, 0, 0, -0.1001f, 0};
    memcpy(view.view_from_world, down, sizeof down);
    memcpy(view.open_view_from_world, down, sizeof down);
    memcpy(view.clip_from_view, lens, sizeof lens);
    memcpy(view.open_clip_from_view, lens, sizeof lens);
    view.viewport[2] = view.viewport[3] = SIDE;
    return view;
}

static void panes_are_drawn_once_they_are_prepared(void **state)
{
    scene_fixture *f = *state;
    host_target target;
    virga_target_def def = virga_default_target_def();
    virga_target *layer = NULL;
    virga_scene *scene = make_scene(f);
    virga_scene_pane panes[2];
    const virga_view view = look_down();
    lay_panes(panes);
    REQUIRE(host_target_create(&f->gpu.device, SIDE, SIDE, &target, f->gpu.error, sizeof f->gpu.error));
    host_target_describe_layer(&target, &def);
    REQUIRE(virga_target_create(f->context, &def, &layer) == VIRGA_OK);
    REQUIRE(virga_scene_attach(scene, layer) == VIRGA_OK);
    for (int later = 0; later < 3; later++) { /* 1: one by one, 2: all in a call */
        const virga_scene_frame frame = {.dt_s = 0.25, .view = &view, .panes = panes, .defer_panes = later};
        VkCommandBuffer cmd = begin(f);
        REQUIRE(virga_scene_record(scene, cmd, &frame) == VIRGA_OK);
        for (uint32_t i = 0; later && i < 2; i++)
            REQUIRE(virga_glass_draw(virga_scene_glass(scene, i), cmd, layer) == VIRGA_NOT_READY);
        for (uint32_t i = 0; later == 1 && i < 2; i++)
            REQUIRE(virga_glass_prepare(virga_scene_glass(scene, i), cmd, &view, &panes[i].pose,
                                        virga_glass_time(virga_scene_glass(scene, i))) == VIRGA_OK);
        if (later == 2)
            REQUIRE(virga_scene_prepare_panes(scene, cmd, &view, panes) == VIRGA_OK);
        host_target_begin_layer(&target, cmd);
        assert_int_equal(virga_scene_draw(scene, cmd, layer), VIRGA_OK);
        host_target_end_layer(&target, cmd);
        host_target_copy_out(&target, cmd, 1u << HOST_LAYER);
        finish(f);
        const float *pixels = host_target_floats(&f->gpu.device, &target, HOST_LAYER);
        float max = 0;
        for (uint32_t i = 3; i < SIDE * SIDE * 4; i += 4)
            max = pixels[i] > max ? pixels[i] : max;
        REQUIRE(max > 0.2f && max <= 1);
    }
    virga_target_destroy(&layer);
    virga_scene_destroy(&scene);
    host_target_destroy(&f->gpu.device, &target);
}

/* ---- a facade */

enum { WINDOWS = 100 };

static virga_scene *make_facade(scene_fixture *f, uint32_t count)
{
    static virga_glass_def panes[WINDOWS];
    virga_scene_def def = small_scene(panes);
    def.pane_count = count;
    for (uint32_t i = 0; i < count; i++) {
        panes[i] = virga_default_glass_def();
        panes[i].width_m = panes[i].height_m = 0.1f;
        panes[i].cell_m = 0.005f;
        panes[i].max_drops = 256;
        panes[i].max_texels = 64;
        panes[i].texture_columns = panes[i].texture_rows = 2;
        panes[i].texture_texels = 8;
    }
    virga_scene *scene = NULL;
    REQUIRE(virga_scene_create(f->context, &def, &scene) == VIRGA_OK);
    virga_glass_settings settings = virga_default_glass_settings();
    settings.style = VIRGA_GLASS_STYLE_TEXTURES;
    for (uint32_t i = 0; i < count; i++)
        REQUIRE(virga_glass_set(virga_scene_glass(scene, i), &settings) == VIRGA_OK);
    virga_rain_settings rain;
    virga_rain_get(virga_scene_rain(scene), &rain);
    rain.rate_mm_h = 100;
    rain.transition_s = 0;
    REQUIRE(virga_rain_set(virga_scene_rain(scene), &rain) == VIRGA_OK);
    return scene;
}

static uint32_t count_pipelines(const virga_context *context)
{
    uint32_t count = 0;
    for (const virga_built *built = context->first_built; built; built = built->next)
        count++;
    return count;
}

/* Ten by ten, level, before the camera. */
static void lay_facade(virga_scene_pane panes[WINDOWS])
{
    for (int i = 0; i < WINDOWS; i += 2)
        lay_panes(&panes[i]);
    for (int i = 0; i < WINDOWS; i++) {
        panes[i].pose.position_m[0] = 0.04 * (i % 10) - 0.2;
        panes[i].pose.position_m[2] = 0.04 * (i / 10) - 0.2;
        panes[i].pose.position_m[1] = -1;
    }
}

/* The panes whose copies of the plate were made in the newest prepare. */
static uint32_t count_copies(virga_scene *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < WINDOWS; i++)
        count += virga_scene_glass(scene, i)->picture.prepared[0].has_copies;
    return count;
}

/* Each has drops of its own, is drawn, and is timed. All show one copy of the plate. */
static void check_facade(scene_fixture *f, virga_scene *scene, const virga_target *layer, host_target *target)
{
    virga_scene_pane panes[WINDOWS];
    virga_view view = look_down();
    view.color = host_target_color(target);
    const virga_scene_frame frame = {.dt_s = 0.06, .view = &view, .panes = panes};
    lay_facade(panes);
    VkCommandBuffer cmd = begin(f);
    host_target_begin_plate(target, cmd);
    host_target_end_plate(target, cmd);
    REQUIRE(virga_scene_record(scene, cmd, &frame) == VIRGA_OK);
    REQUIRE(count_copies(scene) == 1);
    host_target_begin_layer(target, cmd);
    REQUIRE(virga_scene_draw(scene, cmd, layer) == VIRGA_OK);
    host_target_end_layer(target, cmd);
    REQUIRE(f->context->timers.slots[f->context->ring_slot].count < VIRGA_MAX_QUERIES - 2);
    finish(f);
    uint64_t before = 0;
    for (uint32_t i = 0; i < WINDOWS; i++) {
        virga_glass_stats stats;
        virga_glass_stats_get(virga_scene_glass(scene, i), &stats);
        REQUIRE(stats.landed_nl > 0 && stats.landed_nl != before);
        before = stats.landed_nl;
    }
}

/* A start with a hundred windows does not compile a hundred times. */
static void a_facade_builds_as_many_pipelines_as_one_window(void **state)
{
    scene_fixture *f = *state;
    host_target target;
    virga_target_def def = virga_default_target_def();
    virga_target *layer = NULL;
    uint32_t pipelines[2];
    REQUIRE(host_target_create(&f->gpu.device, SIDE, SIDE, &target, f->gpu.error, sizeof f->gpu.error));
    host_target_describe_layer(&target, &def);
    REQUIRE(virga_target_create(f->context, &def, &layer) == VIRGA_OK);
    for (int all = 0; all < 2; all++) {
        virga_scene *scene = make_facade(f, all ? WINDOWS : 1);
        REQUIRE(virga_scene_attach(scene, layer) == VIRGA_OK);
        pipelines[all] = count_pipelines(f->context);
        if (all)
            check_facade(f, scene, layer, &target);
        virga_scene_destroy(&scene);
    }
    assert_int_equal(pipelines[1], pipelines[0]);
    virga_target_destroy(&layer);
    host_target_destroy(&f->gpu.device, &target);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(definitions_are_checked, set_up, tear_down),
        cmocka_unit_test_setup_teardown(panes_take_seeds_and_ticks_from_the_rain, set_up, tear_down),
        cmocka_unit_test_setup_teardown(rain_lands_on_what_is_not_under_cover, set_up, tear_down),
        cmocka_unit_test_setup_teardown(panes_catch_the_drops_that_fall, set_up, tear_down),
        cmocka_unit_test_setup_teardown(frames_are_checked, set_up, tear_down),
        cmocka_unit_test_setup_teardown(preparing_later_is_checked, set_up, tear_down),
        cmocka_unit_test_setup_teardown(light_is_the_same_for_all_effects, set_up, tear_down),
        cmocka_unit_test_setup_teardown(panes_are_drawn_once_they_are_prepared, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_facade_builds_as_many_pipelines_as_one_window, set_up, tear_down),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
