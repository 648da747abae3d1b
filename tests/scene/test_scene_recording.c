/* test_scene_recording.c - a whole scene, frame after frame: what recording it may not do. */
#include "../gpu/gpu_fixture.h"

typedef struct counted_heap {
    bool recording;
    uint32_t calls; /* while recording */
} counted_heap;

static void *heap_alloc(void *user, size_t size)
{
    counted_heap *heap = user;
    heap->calls += heap->recording;
    return aligned_alloc(16, (size + 15) / 16 * 16);
}

static void heap_free(void *user, void *pointer)
{
    counted_heap *heap = user;
    heap->calls += heap->recording;
    free(pointer);
}

/* Rain with all its parts, ground, splashes, and a pane that catches drops. */
static virga_scene *make_scene(virga_context *context)
{
    virga_glass_def pane = virga_default_glass_def();
    virga_scene_def def = virga_default_scene_def();
    virga_scene *scene = NULL;
    pane.width_m = pane.height_m = 0.2f;
    pane.max_drops = 1024;
    pane.max_texels = 128;
    def.rain = gpu_rain_def();
    def.rain.max_panes = 1;
    def.ground.cells = 128;
    def.ground.max_spawns = def.splash.max_spawns = 256;
    def.ground.max_returned_droplets = def.splash.max_returned_droplets = 512;
    def.splash.max_splashes = 256;
    def.splash.max_droplets = 1024;
    def.with_ground = def.with_splash = true;
    def.panes = &pane;
    def.pane_count = 1;
    REQUIRE(virga_scene_create(context, &def, &scene) == VIRGA_OK);
    return scene;
}

static void record(virga_scene *scene, VkCommandBuffer cmd, const gpu_picture *picture, uint32_t number)
{
    const virga_occluder none = {0}; /* an empty list, so that the maps are drawn */
    virga_view view = gpu_view(picture);
    const virga_scene_pane pane = {.pose = {.position_m = {0, 1.7, -0.5}}, .velocity_m_s = {0, 0, -1}};
    const double forward = 0.5 * number; /* the ground's window follows */
    const virga_scene_frame frame = {.dt_s = 1.0 / 30,
                                     .camera_m = {0, 1.7, -forward},
                                     .ripple_center_m = {0, 0, -forward},
                                     .occluders = &none,
                                     .view = &view,
                                     .panes = &pane};
    view.position_m[1] = view.open_position_m[1] = 1.7;
    view.position_m[2] = view.open_position_m[2] = -forward;
    REQUIRE(virga_scene_record(scene, cmd, &frame) >= 0);
    host_target_begin_layer(&picture->images, cmd);
    REQUIRE(virga_scene_draw(scene, cmd, picture->target) >= 0);
    host_target_end_layer(&picture->images, cmd);
}

/* From the first frame on, which uploads what never changes; virga_frame_begin may free, and is not recording. */
static void recording_allocates_and_creates_nothing(void **state)
{
    gpu_fixture *f = *state;
    counted_heap heap = {0};
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    gpu_picture picture;
    def.host_memory = (virga_host_memory){&heap, heap_alloc, heap_free};
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    virga_scene *scene = make_scene(context);
    gpu_picture_open(f, context, &picture);
    REQUIRE(virga_scene_attach(scene, picture.target) == VIRGA_OK);
    const uint32_t made = watch_sum(watch.made);
    for (uint32_t number = 0; number < 8; number++) {
        VkCommandBuffer cmd = gpu_begin_frame(f, context);
        const uint32_t destroyed = watch_sum(watch.destroyed);
        heap.recording = true;
        record(scene, cmd, &picture, number);
        heap.recording = false;
        assert_int_equal(watch_sum(watch.destroyed), destroyed);
        gpu_submit(f);
    }
    assert_int_equal(watch_sum(watch.made), made);
    assert_int_equal(heap.calls, 0);
    gpu_wait(f);
    virga_scene_destroy(&scene);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&context);
}

/* No effect of a scene runs ahead of one whose pipelines are not there. */
static void scene_waits_for_all_of_its_pipelines(void **state)
{
    gpu_fixture *f = *state;
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    gpu_picture picture;
    uint32_t left = 1;
    def.pipeline_build_mode = VIRGA_PIPELINES_DEFERRED;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    virga_scene *scene = make_scene(context);
    gpu_picture_open(f, context, &picture);
    REQUIRE(virga_scene_attach(scene, picture.target) == VIRGA_OK);
    while (virga_scene_ready(scene) == VIRGA_NOT_READY) {
        VkCommandBuffer cmd = gpu_begin_frame(f, context);
        record(scene, cmd, &picture, 0);
        assert_true(virga_rain_time(virga_scene_rain(scene)) == 0);
        gpu_submit(f);
        REQUIRE(virga_pipelines_build(context, 12, &left) >= 0 && left);
    }
    assert_int_equal(virga_pipelines_build(context, UINT32_MAX, &left), VIRGA_OK);
    VkCommandBuffer cmd = gpu_begin_frame(f, context);
    record(scene, cmd, &picture, 0);
    gpu_submit(f);
    gpu_wait(f);
    assert_true(virga_rain_time(virga_scene_rain(scene)) > 0.03);
    virga_scene_destroy(&scene);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(recording_allocates_and_creates_nothing),
        gpu_test(scene_waits_for_all_of_its_pipelines),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("scene recording", tests, NULL, NULL));
}
