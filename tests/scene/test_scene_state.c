/* test_scene_state.c - saved states: a scene that loads one goes on bit for bit as the scene that saved it, whatever it
 * did before; anything else is refused with one line that says what differs. */
#include "../gpu/gpu_fixture.h"
#include "../gpu/small_scene.h"

#include <virga/shared/random.h>

enum { SAVED_AT = 7, FRAMES = 16, HEADER = 64 };

typedef struct state_run {
    gpu_fixture *f;
    virga_context *context;
    virga_scene *scene;
    gpu_picture picture;
    host_buffer vertices, indices, blob;
    bool walk; /* the ground's window follows */
    bool in_turns;
} state_run;

/* ---- a scene that is saved and loaded */

static void set_weather(state_run *run)
{
    virga_rain_settings rain;
    REQUIRE(small_shapes_set(run->scene) == VIRGA_OK && small_weather_set(run->scene) == VIRGA_OK);
    virga_rain_get(virga_scene_rain(run->scene), &rain);
    rain.occlusion_interval = run->in_turns ? 3 : 1;
    REQUIRE(virga_rain_set(virga_scene_rain(run->scene), &rain) == VIRGA_OK);
}

static void open_buffer(state_run *run, const void *data, VkDeviceSize size, VkBufferUsageFlags usage,
                        host_buffer *buffer)
{
    REQUIRE(host_buffer_create_with(&run->f->gpu.device, data, size, usage, "buffer", buffer, run->f->gpu.error,
                                    sizeof run->f->gpu.error));
}

/* A buffer that a state can be saved to, and loaded from. */
static void open_blob(state_run *run, VkDeviceSize size, host_buffer *blob)
{
    REQUIRE(host_buffer_create(&run->f->gpu.device, size,
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                               HOST_BUFFER_READBACK, "state", blob, run->f->gpu.error, sizeof run->f->gpu.error));
}

static void open_scene(state_run *run, uint32_t seed)
{
    virga_glass_def panes[SMALL_PANES];
    virga_scene_def def = small_scene_def(panes);
    def.rain.seed = seed;
    def.rain.occlusion_slants = 2;
    run->context = gpu_context(run->f);
    gpu_picture_open(run->f, run->context, &run->picture);
    REQUIRE(virga_scene_create(run->context, &def, &run->scene) == VIRGA_OK);
    set_weather(run);
    REQUIRE(virga_scene_attach(run->scene, run->picture.target) == VIRGA_OK);
    open_buffer(run, small_square, sizeof small_square, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, &run->vertices);
    open_buffer(run, small_square_indices, sizeof small_square_indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                &run->indices);
    open_blob(run, virga_scene_state_bytes(run->scene), &run->blob);
    gpu_forget_log(run->f);
}

static void close_scene(state_run *run)
{
    host_buffer_destroy(&run->f->gpu.device, &run->vertices);
    host_buffer_destroy(&run->f->gpu.device, &run->indices);
    host_buffer_destroy(&run->f->gpu.device, &run->blob);
    virga_scene_destroy(&run->scene);
    gpu_picture_close(run->f, &run->picture);
    virga_context_destroy(&run->context);
}

static void record(state_run *run, VkCommandBuffer cmd, uint32_t number)
{
    const virga_occluder square = small_occluder(run->vertices.buffer, run->indices.buffer);
    virga_scene_pane panes[SMALL_PANES];
    virga_view view = gpu_view(&run->picture);
    const double ahead = run->walk ? 0.7 * number : 0;
    const virga_scene_frame frame = {.dt_s = 0.021, /* not a whole number of ticks */
                                     .camera_m = {0, 1.7, -ahead},
                                     .ripple_center_m = {0, 0, -ahead},
                                     .occluders = &square,
                                     .occluder_count = 1,
                                     .view = &view,
                                     .panes = panes};
    small_panes_lay(panes);
    view.position_m[1] = view.open_position_m[1] = 1.7;
    view.position_m[2] = view.open_position_m[2] = -ahead;
    assert_int_equal(virga_scene_record(run->scene, cmd, &frame), VIRGA_OK);
    host_target_begin_layer(&run->picture.images, cmd);
    assert_int_equal(virga_scene_draw(run->scene, cmd, run->picture.target), VIRGA_OK);
    host_target_end_layer(&run->picture.images, cmd);
}

static void save(state_run *run, VkCommandBuffer cmd)
{
    const virga_state_range range = {run->blob.buffer, 0, run->blob.size};
    assert_int_equal(virga_scene_save(run->scene, cmd, &range), VIRGA_OK);
}

/* Plays frames and saves the last one. `load` (may be NULL) is loaded before the first one. */
static void play(state_run *run, const host_buffer *load, uint32_t first, uint32_t last)
{
    virga_state_info info;
    for (uint32_t number = first; number <= last; number++) {
        VkCommandBuffer cmd = gpu_begin_frame(run->f, run->context);
        if (load && number == first) {
            const virga_state_source source = {load->mapped, load->size, load->buffer, 0};
            if (virga_scene_load(run->scene, cmd, &source) != VIRGA_OK)
                fail_msg("%s", run->f->last);
        }
        record(run, cmd, number);
        if (number == last)
            save(run, cmd);
        gpu_submit(run->f);
    }
    gpu_wait(run->f);
    assert_int_equal(virga_frame_completed(run->context, run->f->gpu.device.completed), VIRGA_OK);
    host_buffer_invalidate(&run->f->gpu.device, &run->blob);
    assert_int_equal(virga_state_seal(run->blob.mapped, run->blob.size, run->f->gpu.device.frame, &info), VIRGA_OK);
    assert_int_equal(info.bytes, virga_scene_state_bytes(run->scene));
}

static void keep(state_run *run, const host_buffer *blob, host_buffer *copy)
{
    open_blob(run, blob->size, copy);
    memcpy(copy->mapped, blob->mapped, blob->size);
}

/* The states are the same but for the frame's number and the hash. */
static void assert_same_state(const void *a, const void *b, VkDeviceSize size)
{
    const unsigned char *x = a, *y = b;
    for (VkDeviceSize i = HEADER; i < size; i++)
        if (x[i] != y[i])
            fail_msg("byte %llu of %llu differs: %u and %u", (unsigned long long)i, (unsigned long long)size, x[i],
                     y[i]);
}

/* ---- what goes on */

/* The same frames twice: through, and from a state on. `dirty`: frames that the loading scene plays before. */
static void check_goes_on(void **state, state_run kind, uint32_t dirty)
{
    state_run whole = kind, part = kind;
    host_buffer middle, end;
    whole.f = part.f = *state;
    open_scene(&whole, 5);
    play(&whole, NULL, 1, SAVED_AT);
    keep(&whole, &whole.blob, &middle);
    play(&whole, NULL, SAVED_AT + 1, FRAMES);
    keep(&whole, &whole.blob, &end);
    open_scene(&part, 5);
    if (dirty)
        play(&part, NULL, 100, 100 + dirty);
    play(&part, &middle, SAVED_AT + 1, FRAMES);
    assert_same_state(end.mapped, part.blob.mapped, end.size);
    virga_rain_stats stats[2];
    virga_rain_stats_get(virga_scene_rain(whole.scene), &stats[0]);
    virga_rain_stats_get(virga_scene_rain(part.scene), &stats[1]);
    assert_true(stats[0].total_water_nl > 0);
    assert_int_equal(stats[0].total_water_nl, stats[1].total_water_nl);
    host_buffer_destroy(&whole.f->gpu.device, &middle);
    host_buffer_destroy(&whole.f->gpu.device, &end);
    close_scene(&part);
    close_scene(&whole);
}

static void a_new_scene_goes_on(void **state)
{
    check_goes_on(state, (state_run){.walk = false}, 0);
}

static void a_scene_with_a_moving_camera_goes_on(void **state)
{
    check_goes_on(state, (state_run){.walk = true}, 0);
}

static void a_scene_that_ran_before_goes_on(void **state)
{
    check_goes_on(state, (state_run){.walk = true}, 9);
}

static void occlusion_maps_in_turns_go_on(void **state)
{
    check_goes_on(state, (state_run){.walk = true, .in_turns = true}, 3);
}

/* A seek: the same scene goes back and does the same again. */
static void a_scene_goes_back(void **state)
{
    state_run run = {.f = *state, .walk = true};
    host_buffer middle, end;
    open_scene(&run, 5);
    play(&run, NULL, 1, SAVED_AT);
    keep(&run, &run.blob, &middle);
    play(&run, NULL, SAVED_AT + 1, FRAMES);
    keep(&run, &run.blob, &end);
    play(&run, &middle, SAVED_AT + 1, FRAMES);
    assert_same_state(end.mapped, run.blob.mapped, end.size);
    host_buffer_destroy(&run.f->gpu.device, &middle);
    host_buffer_destroy(&run.f->gpu.device, &end);
    close_scene(&run);
}

/* ---- what is refused */

static void assert_refused(state_run *run, const host_buffer *blob, VkDeviceSize size, const char *line)
{
    const virga_state_source source = {blob->mapped, size, blob->buffer, 0};
    VkCommandBuffer cmd = gpu_begin_frame(run->f, run->context);
    gpu_forget_log(run->f);
    assert_int_equal(virga_scene_load(run->scene, cmd, &source), VIRGA_ERROR_INVALID);
    assert_one_error(run->f, VIRGA_LOG_ARGUMENT);
    if (!strstr(run->f->last, line))
        fail_msg("expected \"%s\" in: %s", line, run->f->last);
    gpu_submit(run->f);
    gpu_wait(run->f);
}

static void another_definition_is_named(void **state)
{
    state_run run = {.f = *state}, other = {.f = *state};
    open_scene(&run, 5);
    play(&run, NULL, 1, 2);
    open_scene(&other, 6);
    assert_refused(&other, &run.blob, run.blob.size, "rain_def.seed: the state has 5, this scene 6");
    close_scene(&other);
    close_scene(&run);
}

static void another_setting_is_named(void **state)
{
    state_run run = {.f = *state};
    virga_rain_settings rain;
    open_scene(&run, 5);
    play(&run, NULL, 1, 2);
    virga_rain_get(virga_scene_rain(run.scene), &rain);
    rain.streak_gain = 2; /* a look: allowed */
    rain.rate_mm_h = 20;
    assert_int_equal(virga_rain_set(virga_scene_rain(run.scene), &rain), VIRGA_OK);
    assert_refused(&run, &run.blob, run.blob.size, "rain.rate_mm_h: the state has 150, this scene 20");
    close_scene(&run);
}

static void a_damaged_or_cut_state_is_refused(void **state)
{
    state_run run = {.f = *state};
    open_scene(&run, 5);
    play(&run, NULL, 1, 2);
    unsigned char *bytes = run.blob.mapped;
    assert_refused(&run, &run.blob, run.blob.size - 16, "of which");
    assert_refused(&run, &run.blob, 40, "not a saved state");
    for (uint32_t i = 0; i < 20; i++) {
        const uint32_t at = HEADER + virga_hash2(7, i) % (uint32_t)(run.blob.size - HEADER);
        bytes[at] ^= 1u << i % 8;
        assert_refused(&run, &run.blob, run.blob.size, "is damaged");
        bytes[at] ^= 1u << i % 8;
    }
    bytes[0]++;
    assert_refused(&run, &run.blob, run.blob.size, "not a saved state");
    close_scene(&run);
}

/* A frame that is thrown away saves nothing, and the host learns it. */
static void the_state_of_a_lost_frame_is_not_sealed(void **state)
{
    state_run run = {.f = *state};
    open_scene(&run, 5);
    memset(run.blob.mapped, 0, run.blob.size);
    VkCommandBuffer cmd = gpu_begin_frame(run.f, run.context);
    host_device *device = &run.f->gpu.device;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    record(&run, cmd, 1);
    save(&run, cmd);
    REQUIRE(vkEndCommandBuffer(cmd) == VK_SUCCESS);
    REQUIRE(vkResetCommandPool(device->device, device->frames[device->frame % HOST_FRAMES].pool, 0) == VK_SUCCESS);
    REQUIRE(vkBeginCommandBuffer(cmd, &begin) == VK_SUCCESS);
    gpu_submit(run.f);
    gpu_wait(run.f);
    assert_int_equal(virga_state_seal(run.blob.mapped, run.blob.size, device->frame, NULL), VIRGA_NOT_READY);
    play(&run, NULL, 2, 3); /* seals the state of frame 3 */
    assert_int_equal(virga_state_seal(run.blob.mapped, run.blob.size, device->frame - 1, NULL), VIRGA_NOT_READY);
    close_scene(&run);
}

static void a_load_after_the_step_is_refused(void **state)
{
    state_run run = {.f = *state};
    open_scene(&run, 5);
    play(&run, NULL, 1, 2);
    const virga_state_source source = {run.blob.mapped, run.blob.size, run.blob.buffer, 0};
    VkCommandBuffer cmd = gpu_begin_frame(run.f, run.context);
    record(&run, cmd, 3);
    gpu_forget_log(run.f);
    assert_int_equal(virga_scene_load(run.scene, cmd, &source), VIRGA_ERROR_INVALID);
    assert_one_error(run.f, VIRGA_LOG_ARGUMENT);
    gpu_submit(run.f);
    gpu_wait(run.f);
    close_scene(&run);
}

static void wrong_ranges_are_refused(void **state)
{
    state_run run = {.f = *state};
    open_scene(&run, 5);
    const VkDeviceSize bytes = virga_scene_state_bytes(run.scene);
    const virga_state_range ranges[3] = {{run.blob.buffer, 8, bytes}, {run.blob.buffer, 0, bytes - 1}, {0}};
    VkCommandBuffer cmd = gpu_begin_frame(run.f, run.context);
    const virga_state_range whole = {run.blob.buffer, 0, bytes};
    assert_int_equal(virga_scene_save(run.scene, cmd, &whole), VIRGA_NOT_READY); /* nothing was stepped yet */
    record(&run, cmd, 1);
    for (int i = 0; i < 3; i++) {
        gpu_forget_log(run.f);
        assert_int_equal(virga_scene_save(run.scene, cmd, &ranges[i]), VIRGA_ERROR_INVALID);
        assert_one_error(run.f, VIRGA_LOG_ARGUMENT);
    }
    gpu_submit(run.f);
    gpu_wait(run.f);
    close_scene(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(a_new_scene_goes_on),
        gpu_kept_test(a_scene_with_a_moving_camera_goes_on),
        gpu_kept_test(a_scene_that_ran_before_goes_on),
        gpu_kept_test(occlusion_maps_in_turns_go_on),
        gpu_kept_test(a_scene_goes_back),
        gpu_kept_test(another_definition_is_named),
        gpu_kept_test(another_setting_is_named),
        gpu_kept_test(a_damaged_or_cut_state_is_refused),
        gpu_kept_test(the_state_of_a_lost_frame_is_not_sealed),
        gpu_kept_test(a_load_after_the_step_is_refused),
        gpu_kept_test(wrong_ranges_are_refused),
    };
    if (getenv("ONLY"))
        cmocka_set_test_filter(getenv("ONLY"));
    return effect_fixture_close(cmocka_run_group_tests_name("states", tests, NULL, NULL));
}
