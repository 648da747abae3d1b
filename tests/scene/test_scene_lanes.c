/* test_scene_lanes.c - on GPUs effects that have nothing to do with each other share barriers (gpu/lanes.h). A scene
 * has the same bits with them, and far fewer barriers. */
#include "state_run.h"

#include "gpu/context.h"

enum { FRAMES = 12 };

static uint32_t barriers;
static PFN_vkCmdPipelineBarrier record_barrier;

static VKAPI_ATTR void VKAPI_CALL count_barrier(VkCommandBuffer cmd, VkPipelineStageFlags from, VkPipelineStageFlags to,
                                                VkDependencyFlags flags, uint32_t n, const VkMemoryBarrier *memory,
                                                uint32_t buffer_count, const VkBufferMemoryBarrier *buffers,
                                                uint32_t image_count, const VkImageMemoryBarrier *images)
{
    barriers++;
    record_barrier(cmd, from, to, flags, n, memory, buffer_count, buffers, image_count, images);
}

/* Plays frames with the passes of GPUs, and saves the last one. Returns the barriers of a frame. */
static uint32_t play_with(state_run *run, bool lanes, host_buffer *end)
{
    effect_fixture_variants = VIRGA_VARIANTS_GPU;
    open_scene(run, 5);
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
    record_barrier = run->context->vk.CmdPipelineBarrier;
    run->context->vk.CmdPipelineBarrier = count_barrier;
    run->context->timers.enabled = !lanes; /* there are none with timings ... */
    run->context->software = false;        /* ... which have barriers of their own on software alone */
    play(run, NULL, 1, FRAMES - 1);
    barriers = 0;
    play(run, NULL, FRAMES, FRAMES);
    keep(run, &run->blob, end);
    return barriers;
}

static void check_lanes(void **state, state_run kind, double most)
{
    host_buffer ends[2];
    uint32_t counts[2];
    for (int i = 0; i < 2; i++) {
        state_run run = kind;
        run.f = *state;
        counts[i] = play_with(&run, i, &ends[i]);
        close_scene(&run);
    }
    VkDeviceSize same = STATE_HEADER;
    while (same < ends[0].size && ((const char *)ends[0].mapped)[same] == ((const char *)ends[1].mapped)[same])
        same++;
    printf("%u barriers in one lane, %u in lanes; %llu of %llu bytes are the same\n", counts[0], counts[1],
           (unsigned long long)same, (unsigned long long)ends[0].size);
    const bool all = same == ends[0].size;
    for (int i = 0; i < 2; i++)
        host_buffer_destroy(&((gpu_fixture *)*state)->gpu.device, &ends[i]);
    assert_true(all && counts[1] < most * counts[0]);
}

static void a_scene_has_the_same_bits_in_lanes(void **state)
{
    check_lanes(state, (state_run){.sheltered = true}, 0.6);
}

/* They are stepped after the splashes. */
static void panes_that_catch_spray_too(void **state)
{
    check_lanes(state, (state_run){.walk = true, .in_turns = true}, 0.9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(a_scene_has_the_same_bits_in_lanes),
        gpu_kept_test(panes_that_catch_spray_too),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
