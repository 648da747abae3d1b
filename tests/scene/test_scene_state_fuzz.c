/* test_scene_state_fuzz.c - states whose contents are wrong, but whose hash is right: they are refused with one line,
 * or the scene goes on from them. It reads nothing out of bounds and comes to an end.
 * Usage: scene-state-fuzz [NUMBER [FIRST]]: so many states, numbered from FIRST on. */
#include "state_run.h"

enum { SAVED_AT = 7 };

static uint32_t number = 10, first_number;

/* Plays two frames from the state that the buffer holds; false: it is refused. A step may refuse what it finds, too. */
static bool go_on(state_run *run, const host_buffer *blob)
{
    const virga_state_source source = {blob->mapped, blob->size, blob->buffer, 0};
    bool loaded = false;
    for (uint32_t i = 0; i < 2; i++) {
        VkCommandBuffer cmd = gpu_begin_frame(run->f, run->context);
        gpu_forget_log(run->f);
        if (!i) {
            loaded = virga_scene_load(run->scene, cmd, &source) == VIRGA_OK;
            if (!loaded)
                assert_one_error(run->f, VIRGA_LOG_ARGUMENT);
        }
        if (loaded)
            try_record(run, cmd, SAVED_AT + 1 + i);
        gpu_submit(run->f);
    }
    gpu_wait(run->f);
    assert_int_equal(virga_frame_completed(run->context, run->f->gpu.device.completed), VIRGA_OK);
    return loaded;
}

static void wrong_contents_do_no_harm(void **state)
{
    state_run run = {.f = *state, .walk = true};
    host_buffer whole, wrong;
    uint32_t refused = 0;
    open_scene(&run, 5);
    play(&run, NULL, 1, SAVED_AT);
    const uint64_t frame = run.f->gpu.device.frame;
    keep(&run, &run.blob, &whole);
    keep(&run, &run.blob, &wrong);
    for (uint32_t i = first_number; i < first_number + number; i++) {
        uint32_t *words = wrong.mapped;
        memcpy(words, whole.mapped, whole.size);
        wrong_words(words, whole.size, i);
        REQUIRE(virga_state_seal(words, wrong.size, frame, NULL) == VIRGA_OK);
        refused += !go_on(&run, &wrong);
    }
    printf("%u states, %u refused\n", number, refused);
    host_buffer_destroy(&run.f->gpu.device, &whole);
    host_buffer_destroy(&run.f->gpu.device, &wrong);
    close_scene(&run);
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {gpu_kept_test(wrong_contents_do_no_harm)};
    number = count > 1 ? (uint32_t)strtoul(arguments[1], NULL, 10) : number;
    first_number = count > 2 ? (uint32_t)strtoul(arguments[2], NULL, 10) : 0;
    return effect_fixture_close(cmocka_run_group_tests_name("wrong states", tests, NULL, NULL));
}
