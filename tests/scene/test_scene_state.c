/* test_scene_state.c - saved states: a scene that loads one goes on bit for bit as the scene that saved it, whatever it
 * did before; anything else is refused with one line that says what differs. */
#include "state_run.h"

#include <virga/shared/random.h>

enum { SAVED_AT = 7, FRAMES = 16 };

/* The states are the same but for the frame's number and the hash. */
static void assert_same_state(const void *a, const void *b, VkDeviceSize size)
{
    const unsigned char *x = a, *y = b;
    for (VkDeviceSize i = STATE_HEADER; i < size; i++)
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
        const uint32_t at = STATE_HEADER + virga_hash2(7, i) % (uint32_t)(run.blob.size - STATE_HEADER);
        bytes[at] ^= 1u << i % 8;
        assert_refused(&run, &run.blob, run.blob.size, "is damaged");
        bytes[at] ^= 1u << i % 8;
    }
    bytes[0]++;
    assert_refused(&run, &run.blob, run.blob.size, "not a saved state");
    close_scene(&run);
}

/* The first word of a part of an effect's section (gpu/state_bytes.h), and the last row of the host's part. */
typedef struct section {
    char name[16];
    uint32_t index, def_values, setting_values, pad;
    uint64_t host_bytes, device_bytes;
} section;

static void find_section(const host_buffer *blob, const char *name, uint32_t **last_row, uint32_t **device)
{
    char *at = (char *)blob->mapped + STATE_HEADER;
    for (const char *end = (char *)blob->mapped + blob->size; at < end;) {
        const section *here = (const section *)at;
        char *host = at + sizeof *here + ((here->def_values + here->setting_values) * sizeof(double) + 15) / 16 * 16;
        *device = (uint32_t *)(host + here->host_bytes);
        *last_row = *device - 4;
        if (!strcmp(here->name, name))
            return;
        at = (char *)*device + here->device_bytes;
    }
    fail_msg("no section %s", name);
}

/* They have the right hash, so it is their values that are looked at. */
static void wrong_contents_are_named(void **state)
{
    state_run run = {.f = *state};
    uint32_t *current = NULL, *end_droplet = NULL;
    open_scene(&run, 5);
    play(&run, NULL, 1, 2);
    const uint64_t frame = run.f->gpu.device.frame;
    find_section(&run.blob, "splash_def", &current, &end_droplet);
    const uint32_t right[2] = {*current, *end_droplet};
    *current = 7;
    REQUIRE(virga_state_seal(run.blob.mapped, run.blob.size, frame, NULL) == VIRGA_OK);
    assert_refused(&run, &run.blob, run.blob.size, "splash.current: the state has 7, expected 0 to 1");
    *current = right[0];
    *end_droplet = 100000;
    REQUIRE(virga_state_seal(run.blob.mapped, run.blob.size, frame, NULL) == VIRGA_OK);
    assert_refused(&run, &run.blob, run.blob.size, "splash.state.end_droplet: the state has 100000, expected 0 to 256");
    *end_droplet = right[1];
    REQUIRE(virga_state_seal(run.blob.mapped, run.blob.size, frame, NULL) == VIRGA_OK);
    play(&run, &run.blob, 3, 3);
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
    record(&run, cmd, 1);
    save(&run, cmd);
    host_parts_throw_away(device, run.context, cmd, false);
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
        gpu_kept_test(wrong_contents_are_named),
        gpu_kept_test(the_state_of_a_lost_frame_is_not_sealed),
        gpu_kept_test(a_load_after_the_step_is_refused),
        gpu_kept_test(wrong_ranges_are_refused),
    };
    if (getenv("ONLY"))
        cmocka_set_test_filter(getenv("ONLY"));
    return effect_fixture_close(cmocka_run_group_tests_name("states", tests, NULL, NULL));
}
