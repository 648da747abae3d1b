/* test_order.c - orders of calls that no host should make, and that must do no harm. On a stand-in for a device. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <virga/virga.h>

#include "stand_in.h"

static uint32_t lines[64];

static void count_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)user;
    (void)level;
    (void)text;
    lines[id]++;
}

static virga_context *create_context(virga_pipeline_build_mode mode)
{
    virga_context_def def = virga_default_context_def();
    virga_context *context = NULL;
    memset(lines, 0, sizeof lines);
    def.instance = stand_in_instance();
    def.physical_device = stand_in_physical();
    def.device = stand_in_device(0);
    def.get_instance_proc_addr = stand_in_get;
    def.pipeline_build_mode = mode;
    def.log = count_line;
    assert_int_equal(virga_context_create(&def, &context), VIRGA_OK);
    return context;
}

static virga_context *open_context(virga_pipeline_build_mode mode)
{
    stand_in_open();
    return create_context(mode);
}

static virga_scene *open_scene(virga_context *context)
{
    virga_scene_def def = virga_default_scene_def();
    virga_scene *scene = NULL;
    assert_int_equal(virga_scene_create(context, &def, &scene), VIRGA_OK);
    return scene;
}

static virga_target *open_target(virga_context *context)
{
    virga_target_def def = virga_default_target_def();
    virga_target *target = NULL;
    def.kind = VIRGA_TARGET_DYNAMIC;
    def.color_formats[0] = VK_FORMAT_R16G16B16A16_SFLOAT;
    def.depth_format = VK_FORMAT_D32_SFLOAT;
    assert_int_equal(virga_target_create(context, &def, &target), VIRGA_OK);
    return target;
}

static void a_context_may_go_before_its_objects(void **state)
{
    virga_context *context = open_context(VIRGA_PIPELINES_IMMEDIATE);
    virga_scene *scene = open_scene(context);
    virga_target *target = open_target(context);
    virga_rain_settings settings = virga_default_rain_settings();
    (void)state;
    assert_int_equal(virga_scene_attach(scene, target), VIRGA_OK);
    virga_context_destroy(&context);
    assert_null(context);
    assert_int_equal(lines[VIRGA_LOG_LIVE_OBJECTS], 1);
    assert_int_equal(virga_rain_set(virga_scene_rain(scene), &settings), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_scene_attach(scene, target), VIRGA_ERROR_DEVICE_LOST);
    virga_target_destroy(&target);
    virga_scene_destroy(&scene);
    assert_true(stand_in_close());
}

static void a_part_of_a_scene_is_not_destroyed(void **state)
{
    virga_context *context = open_context(VIRGA_PIPELINES_IMMEDIATE);
    virga_scene *scene = open_scene(context);
    virga_rain *rain = virga_scene_rain(scene);
    (void)state;
    virga_rain_destroy(&rain);
    assert_null(rain);
    assert_int_equal(lines[VIRGA_LOG_ARGUMENT], 1);
    assert_int_equal(virga_scene_ready(scene), VIRGA_OK);
    virga_scene_destroy(&scene);
    virga_context_destroy(&context);
    assert_true(stand_in_close());
}

static void a_target_may_go_before_its_pipelines_are_built(void **state)
{
    virga_context *context = open_context(VIRGA_PIPELINES_DEFERRED);
    virga_scene *scene = open_scene(context);
    virga_target *target = open_target(context);
    (void)state;
    assert_int_equal(virga_scene_attach(scene, target), VIRGA_OK);
    virga_target_destroy(&target);
    assert_int_equal(virga_pipelines_build(context, UINT32_MAX, NULL), VIRGA_OK);
    virga_scene_destroy(&scene);
    virga_context_destroy(&context);
    assert_true(stand_in_close());
}

static void rain_without_panes_finds_no_hits(void **state)
{
    virga_context *context = open_context(VIRGA_PIPELINES_IMMEDIATE);
    virga_scene *scene = open_scene(context);
    const virga_rain_step_info step = {.dt_s = 0.02};
    const virga_rain_pane pane = {.along_u = {1, 0, 0}, .along_v = {0, 1, 0}, .width_m = 1, .height_m = 1};
    virga_rain_buffer hits;
    (void)state;
    VkCommandBuffer cmd = stand_in_begin(VK_NULL_HANDLE);
    assert_int_equal(virga_frame_begin(context, 1, 0), VIRGA_OK);
    assert_int_equal(virga_rain_step(virga_scene_rain(scene), cmd, &step), VIRGA_OK);
    assert_int_equal(virga_rain_find_hits(virga_scene_rain(scene), cmd, &pane, &hits), VIRGA_ERROR_INVALID);
    virga_scene_destroy(&scene);
    virga_context_destroy(&context);
    assert_true(stand_in_close());
}

static void maps_of_the_host_wait_for_pipelines(void **state)
{
    virga_context *context = open_context(VIRGA_PIPELINES_DEFERRED);
    virga_scene *scene = open_scene(context);
    const virga_image maps = {.image = (VkImage)stand_in_object(VK_OBJECT_TYPE_IMAGE),
                              .view = (VkImageView)stand_in_object(VK_OBJECT_TYPE_IMAGE_VIEW),
                              .extent = {64, 64, 1},
                              .layers = VIRGA_RAIN_MAX_MAPS,
                              .before.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    (void)state;
    VkCommandBuffer cmd = stand_in_begin(VK_NULL_HANDLE);
    assert_int_equal(virga_frame_begin(context, 1, 0), VIRGA_OK);
    assert_int_equal(virga_rain_import_occlusion(virga_scene_rain(scene), cmd, &maps), VIRGA_NOT_READY);
    assert_int_equal(stand_in_count(cmd).commands, 0);
    virga_scene_destroy(&scene);
    virga_context_destroy(&context);
    assert_true(stand_in_close());
}

static void a_list_of_a_destroyed_object_is_refused(void **state)
{
    virga_context *context = open_context(VIRGA_PIPELINES_IMMEDIATE);
    const virga_rain_def rain_def = virga_default_rain_def();
    const virga_ground_def ground_def = virga_default_ground_def();
    virga_rain *rain = NULL;
    virga_ground *ground = NULL;
    virga_rain_buffer impacts;
    (void)state;
    assert_int_equal(virga_rain_create(context, &rain_def, &rain), VIRGA_OK);
    assert_int_equal(virga_ground_create(context, &ground_def, &ground), VIRGA_OK);
    VkCommandBuffer cmd = stand_in_begin(VK_NULL_HANDLE);
    assert_int_equal(virga_frame_begin(context, 1, 0), VIRGA_OK);
    virga_rain_impacts(rain, &impacts);
    const virga_ground_step_info step = {.impacts = impacts.buffer, .impacts_size = impacts.size};
    virga_rain_destroy(&rain);
    assert_int_equal(virga_ground_step(ground, cmd, &step), VIRGA_ERROR_INVALID);
    assert_int_equal(lines[VIRGA_LOG_ARGUMENT], 1);
    assert_int_equal(stand_in_count(cmd).commands, 0);
    virga_ground_destroy(&ground);
    virga_context_destroy(&context);
    assert_true(stand_in_close());
}

/* The stand-in stops the program at a dispatch of more workgroups than it allows. */
static void droplets_are_limited_by_indices_and_workgroups(void **state)
{
    const uint32_t index_limits[] = {0, (1 << 24) - 1, UINT32_MAX};
    (void)state;
    for (size_t i = 0; i < sizeof index_limits / sizeof *index_limits; i++) {
        stand_in_open();
        stand_in.properties.limits.maxDrawIndexedIndexValue = index_limits[i];
        virga_context *context = create_context(VIRGA_PIPELINES_IMMEDIATE);
        virga_splash_def def = virga_default_splash_def();
        virga_splash *splash = NULL;
        def.max_droplets = 4194304;
        assert_int_equal(virga_splash_create(context, &def, &splash), VIRGA_DEGRADED);
        assert_int_equal(lines[VIRGA_LOG_CLAMPED], 1);
        VkCommandBuffer cmd = stand_in_begin(VK_NULL_HANDLE);
        for (int frame = 0; frame < 2; frame++) {
            const virga_splash_step_info step = {.first_tick = (uint64_t)frame,
                                                 .ticks = 1,
                                                 .camera_m = {1e4 * frame},
                                                 .spawns = (VkBuffer)stand_in_object(VK_OBJECT_TYPE_BUFFER),
                                                 .spawns_size = 1 << 26};
            assert_int_equal(virga_frame_begin(context, frame + 1, frame), VIRGA_OK);
            assert_int_equal(virga_splash_step(splash, cmd, &step), VIRGA_OK);
        }
        virga_splash_destroy(&splash);
        virga_context_destroy(&context);
        assert_true(stand_in_close());
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_context_may_go_before_its_objects),
        cmocka_unit_test(a_part_of_a_scene_is_not_destroyed),
        cmocka_unit_test(a_target_may_go_before_its_pipelines_are_built),
        cmocka_unit_test(rain_without_panes_finds_no_hits),
        cmocka_unit_test(maps_of_the_host_wait_for_pipelines),
        cmocka_unit_test(a_list_of_a_destroyed_object_is_refused),
        cmocka_unit_test(droplets_are_limited_by_indices_and_workgroups),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
