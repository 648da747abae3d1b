/* test_lost.c - each Vulkan call that can lose the device does so once. It is logged once; every later call returns
 * VIRGA_ERROR_DEVICE_LOST, calls nothing of the device and records nothing; destroying works. */
#include "gpu_fixture.h"
#include "small_scene.h"

/* Memory that has to be flushed, so that flushes are calls that can fail. */
static void lie_memory(VkPhysicalDeviceMemoryProperties *properties)
{
    for (uint32_t i = 0; i < properties->memoryTypeCount; i++)
        properties->memoryTypes[i].propertyFlags &= ~(VkMemoryPropertyFlags)VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
}

/* What is made and used in one run of a test, as far as it came. */
typedef struct life {
    gpu_fixture *f;
    gpu_picture picture; /* its images live on */
    virga_context *context;
    virga_scene *scene;
    virga_rain *rain; /* from here on: an effect that is made without a scene */
    virga_ground *ground;
    virga_splash *splash;
    virga_glass *glass;
    virga_target *target;
    VkCommandBuffer cmd;
    bool recording;
} life;

#define STEP(call)                      \
    do {                                \
        const virga_result r_ = (call); \
        if (r_)                         \
            return r_;                  \
    } while (0)

static virga_result make_context(life *l)
{
    const virga_context_def context_def = gpu_context_def(l->f);
    virga_target_def target_def = virga_default_target_def();
    host_target_describe_layer(&l->picture.images, &target_def);
    STEP(virga_context_create(&context_def, &l->context));
    return virga_target_create(l->context, &target_def, &l->target);
}

static virga_result make_rain(life *l)
{
    const virga_rain_def def = small_rain_def();
    STEP(make_context(l));
    STEP(virga_rain_create(l->context, &def, &l->rain));
    return virga_rain_attach(l->rain, l->target);
}

static virga_result make_ground(life *l)
{
    const virga_ground_def def = small_ground_def();
    STEP(make_context(l));
    return virga_ground_create(l->context, &def, &l->ground);
}

static virga_result make_splash(life *l)
{
    const virga_splash_def def = small_splash_def();
    STEP(make_context(l));
    STEP(virga_splash_create(l->context, &def, &l->splash));
    return virga_splash_attach(l->splash, l->target);
}

static virga_result make_pane(life *l)
{
    const virga_glass_def def = small_glass_def();
    STEP(make_context(l));
    STEP(virga_glass_create(l->context, &def, &l->glass));
    STEP(small_shape_set(l->glass, 1));
    return virga_glass_attach(l->glass, l->target);
}

static virga_result make_scene(life *l)
{
    virga_glass_def panes[SMALL_PANES];
    virga_scene_def def = small_scene_def(panes);
    size_t size = 0;
    def.pane_count = 1;
    STEP(make_context(l));
    STEP(virga_scene_create(l->context, &def, &l->scene));
    STEP(small_shape_set(virga_scene_glass(l->scene, 0), 1));
    STEP(virga_scene_attach(l->scene, l->target));
    return virga_pipeline_cache_get(l->context, &size, NULL);
}

static void begin(life *l)
{
    REQUIRE(host_begin_frame(&l->f->gpu.device, &l->cmd, l->f->gpu.error, sizeof l->f->gpu.error));
    l->recording = true;
}

static void end(life *l)
{
    if (!l->recording)
        begin(l);
    l->recording = false;
    gpu_submit(l->f);
    gpu_wait(l->f);
}

static void ask(life *l)
{
    virga_rain_stats rain;
    virga_ground_stats ground;
    virga_splash_stats splash;
    virga_glass_stats glass;
    virga_rain_stats_get(virga_scene_rain(l->scene), &rain);
    virga_ground_stats_get(virga_scene_ground(l->scene), &ground);
    virga_splash_stats_get(virga_scene_splash(l->scene), &splash);
    virga_glass_stats_get(virga_scene_glass(l->scene, 0), &glass);
}

static virga_result frame(life *l)
{
    const double camera[3] = {0, 1.7, 0};
    const host_device *device = &l->f->gpu.device;
    virga_scene_pane panes[SMALL_PANES];
    const virga_view view = gpu_view(&l->picture);
    const virga_scene_frame info = {.dt_s = 0.02, .camera_m = {0, 1.7, 0}, .view = &view, .panes = panes};
    small_panes_lay(panes);
    begin(l);
    STEP(virga_frame_begin(l->context, device->frame, device->completed));
    STEP(virga_rain_draw_occlusion(virga_scene_rain(l->scene), l->cmd, camera, NULL, 0));
    STEP(virga_scene_record(l->scene, l->cmd, &info));
    host_target_begin_layer(&l->picture.images, l->cmd);
    const virga_result drawn = virga_scene_draw(l->scene, l->cmd, l->target);
    host_target_end_layer(&l->picture.images, l->cmd);
    STEP(drawn);
    end(l);
    ask(l);
    return virga_frame_completed(l->context, device->completed);
}

/* Four frames: more than are in flight, so that both functions that read timings have some to read. */
static virga_result make_and_use_scene(life *l)
{
    STEP(make_scene(l));
    for (int i = 0; i < 4; i++)
        STEP(frame(l));
    return VIRGA_OK;
}

/* ---- after it */

#define LOST(call) assert_int_equal((call), VIRGA_ERROR_DEVICE_LOST)

static void rain_is_lost(life *l, const virga_view *view)
{
    virga_rain *rain = virga_scene_rain(l->scene);
    const double camera[3] = {0, 0, 0};
    const virga_rain_settings settings = virga_default_rain_settings();
    const virga_rain_step_info step = {.dt_s = 0.02};
    const virga_rain_pane pane = {.along_u = {1, 0, 0}, .along_v = {0, 1, 0}, .width_m = 1, .height_m = 1};
    const virga_image image = {0};
    virga_occlusion_view views[VIRGA_RAIN_MAX_MAPS];
    virga_rain_buffer buffer;
    uint32_t count;
    double origin[3];
    LOST(virga_rain_set(rain, &settings));
    LOST(virga_rain_draw_occlusion(rain, l->cmd, camera, NULL, 0));
    LOST(virga_rain_import_occlusion(rain, l->cmd, &image));
    assert_int_equal(virga_rain_plan_occlusion(rain, camera, views), 0);
    LOST(virga_rain_step(rain, l->cmd, &step));
    LOST(virga_rain_find_hits(rain, l->cmd, &pane, &buffer));
    LOST(virga_rain_write_points(rain, l->cmd, &buffer, &count, origin));
    LOST(virga_rain_prepare(rain, l->cmd, view, 0));
    LOST(virga_rain_attach(rain, l->target));
    LOST(virga_rain_draw(rain, l->cmd, l->target));
    LOST(virga_rain_draw_haze(rain, l->cmd, view, NULL, l->target));
}

static void ground_and_splash_are_lost(life *l, const virga_view *view)
{
    virga_ground *ground = virga_scene_ground(l->scene);
    virga_splash *splash = virga_scene_splash(l->scene);
    const virga_ground_settings ground_settings = virga_default_ground_settings();
    const virga_splash_settings splash_settings = virga_default_splash_settings();
    virga_rain_buffer impacts;
    virga_ground_step_info ground_step = {0};
    virga_splash_step_info splash_step = {0};
    virga_splash_buffer rules;
    virga_rain_impacts(virga_scene_rain(l->scene), &impacts);
    ground_step.impacts = impacts.buffer;
    virga_ground_spawns(ground, &splash_step.spawns, NULL);
    LOST(virga_ground_set(ground, &ground_settings));
    LOST(virga_ground_step(ground, l->cmd, &ground_step));
    LOST(virga_splash_set(splash, &splash_settings));
    LOST(virga_splash_step(splash, l->cmd, &splash_step));
    LOST(virga_splash_prepare(splash, l->cmd, view, 0));
    LOST(virga_splash_attach(splash, l->target));
    LOST(virga_splash_draw(splash, l->cmd, l->target));
    virga_splash_rules(splash, &rules);
    assert_true(rules.buffer == VK_NULL_HANDLE);
}

static void pane_is_lost(life *l, const virga_view *view)
{
    virga_glass *glass = virga_scene_glass(l->scene, 0);
    const virga_glass_settings settings = virga_default_glass_settings();
    const virga_glass_step_info step = {.first_tick = 1};
    const virga_glass_pose pose = {.position_m = {0, 0, 0}};
    LOST(small_shape_set(glass, 0));
    LOST(virga_glass_set(glass, &settings));
    LOST(virga_glass_step(glass, l->cmd, &step));
    LOST(virga_glass_prepare(glass, l->cmd, view, &pose, 0));
    LOST(virga_glass_attach(glass, l->target));
    LOST(virga_glass_draw(glass, l->cmd, l->target));
    LOST(virga_glass_draw_refraction(glass, l->cmd, l->target));
}

static void scene_is_lost(life *l, const virga_view *view)
{
    virga_scene_pane panes[SMALL_PANES];
    const virga_scene_frame info = {.dt_s = 0.02, .view = view, .panes = panes};
    small_panes_lay(panes);
    rain_is_lost(l, view);
    ground_and_splash_are_lost(l, view);
    pane_is_lost(l, view);
    LOST(virga_scene_record(l->scene, l->cmd, &info));
    LOST(virga_scene_attach(l->scene, l->target));
    LOST(virga_scene_draw(l->scene, l->cmd, l->target));
}

static void context_is_lost(life *l)
{
    const virga_rain_def rain_def = small_rain_def();
    const virga_ground_def ground_def = small_ground_def();
    const virga_splash_def splash_def = small_splash_def();
    const virga_glass_def glass_def = small_glass_def();
    virga_glass_def panes[SMALL_PANES];
    const virga_scene_def scene_def = small_scene_def(panes);
    const virga_target_def target_def = virga_default_target_def();
    virga_rain *rain;
    virga_ground *ground;
    virga_splash *splash;
    virga_glass *glass;
    virga_scene *scene;
    virga_target *target;
    size_t size = 0;
    LOST(virga_rain_create(l->context, &rain_def, &rain));
    LOST(virga_ground_create(l->context, &ground_def, &ground));
    LOST(virga_splash_create(l->context, &splash_def, &splash));
    LOST(virga_glass_create(l->context, &glass_def, &glass));
    LOST(virga_scene_create(l->context, &scene_def, &scene));
    LOST(virga_target_create(l->context, &target_def, &target));
    LOST(virga_frame_begin(l->context, UINT64_MAX, UINT64_MAX - 1));
    LOST(virga_frame_completed(l->context, 0));
    LOST(virga_frame_dropped(l->context, 1));
    LOST(virga_pipeline_cache_get(l->context, &size, NULL));
}

/* The command buffer has ended: the validation layer says so of each command that is recorded all the same. */
static void check_lost(life *l)
{
    end(l);
    const uint64_t calls = watch.device_calls;
    const virga_view view = gpu_view(&l->picture);
    if (l->context)
        context_is_lost(l);
    if (l->scene)
        scene_is_lost(l, &view);
    if (l->scene)
        ask(l);
    assert_int_equal(watch.device_calls, calls);
}

static void destroy(life *l)
{
    virga_scene_destroy(&l->scene);
    virga_rain_destroy(&l->rain);
    virga_ground_destroy(&l->ground);
    virga_splash_destroy(&l->splash);
    virga_glass_destroy(&l->glass);
    virga_target_destroy(&l->target);
    virga_context_destroy(&l->context);
    if (watch_sum(watch.live))
        fail_msg("alive are %s", watch_alive());
}

/* Call `number` of a run says that the device is lost. False if the run has fewer calls. */
static bool lose(life *l, virga_result (*run)(life *l), uint32_t number)
{
    gpu_forget_log(l->f);
    watch_fail(number, VK_ERROR_DEVICE_LOST);
    const virga_result result = run(l);
    const bool failed = watch.failed;
    if (result != (failed ? VIRGA_ERROR_DEVICE_LOST : VIRGA_OK))
        fail_msg("call %u, %s, lost the device: the result is %s", number, failed ? watch.failed_call : "none",
                 virga_result_name(result));
    if (failed) {
        check_lost(l);
        if (l->f->errors != 1 || (l->f->lines[VIRGA_LOG_DEVICE_LOST] != 1))
            fail_msg("call %u, %s, lost the device: %u errors, the last line: %s", number, watch.failed_call,
                     l->f->errors, l->f->last);
    }
    destroy(l);
    return failed;
}

/* The number of calls that may say it. */
static uint32_t calls_of(life *l, virga_result (*run)(life *l))
{
    assert_false(lose(l, run, 0));
    return watch.calls;
}

static void lose_each(life *l, virga_result (*run)(life *l), uint32_t first, uint32_t stride)
{
    uint32_t number = first;
    while (lose(l, run, number))
        number += stride;
    assert_true(number >= first + stride);
}

static void open_life(life *l, gpu_fixture *f)
{
    *l = (life){.f = f};
    watch.keep_pipelines = true;
    watch.lie_memory = lie_memory;
    REQUIRE(host_target_create(&f->gpu.device, 16, 16, &l->picture.images, f->gpu.error, sizeof f->gpu.error));
}

static void close_life(life *l)
{
    host_target_destroy(&l->f->gpu.device, &l->picture.images);
}

/* Each call that makes an effect. A scene makes the same ones, so of its calls some of each effect are enough. */
static void device_may_be_lost_while_anything_is_made(void **state)
{
    static life l;
    open_life(&l, *state);
    const uint32_t shared = calls_of(&l, make_context);
    lose_each(&l, make_context, 1, 1);
    lose_each(&l, make_rain, shared + 1, 1);
    lose_each(&l, make_ground, shared + 1, 1);
    lose_each(&l, make_splash, shared + 1, 1);
    lose_each(&l, make_pane, shared + 1, 1);
    lose_each(&l, make_scene, shared + 1, 11);
    close_life(&l);
}

static void device_may_be_lost_at_every_call_of_a_frame(void **state)
{
    static life l;
    open_life(&l, *state);
    const uint32_t made = calls_of(&l, make_scene), all = calls_of(&l, make_and_use_scene);
    printf("%u calls make a scene, %u more use it\n", made, all - made);
    assert_true(made > 400 && all - made > 50);
    lose_each(&l, make_and_use_scene, made + 1, 1);
    close_life(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(device_may_be_lost_while_anything_is_made),
        gpu_test(device_may_be_lost_at_every_call_of_a_frame),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
