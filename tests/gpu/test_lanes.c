/* test_lanes.c - lanes of commands, without a device: the order in which they are recorded, what they share, and what
 * is bound again. The functions of the device write a letter or a word each. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "gpu/context.h"
#include "gpu/lanes.h"
#include "gpu/record.h"

static char trace[1024];

static void say(const char *format, ...)
{
    va_list arguments;
    const size_t used = strlen(trace);
    va_start(arguments, format);
    vsnprintf(trace + used, sizeof trace - used, format, arguments);
    va_end(arguments);
}

static VKAPI_ATTR void VKAPI_CALL on_dispatch(VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z)
{
    assert_ptr_equal(cmd, (VkCommandBuffer)trace);
    assert_int_equal(y + z, 2);
    say("%c", (char)x);
}

static VKAPI_ATTR void VKAPI_CALL on_barrier(VkCommandBuffer cmd, VkPipelineStageFlags from, VkPipelineStageFlags to,
                                             VkDependencyFlags flags, uint32_t n, const VkMemoryBarrier *memory,
                                             uint32_t buffer_count, const VkBufferMemoryBarrier *buffers,
                                             uint32_t image_count, const VkImageMemoryBarrier *images)
{
    (void)cmd, (void)flags, (void)buffer_count, (void)buffers;
    say("|%s%s", from & VK_PIPELINE_STAGE_TRANSFER_BIT ? "t" : "", to & VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT ? "i" : "");
    assert_int_equal(n, 1);
    assert_true(!(from & VK_PIPELINE_STAGE_TRANSFER_BIT) || (memory->srcAccessMask & VK_ACCESS_TRANSFER_WRITE_BIT));
    for (uint32_t i = 0; i < image_count; i++)
        say("%d", (int)(size_t)images[i].image);
}

static VKAPI_ATTR void VKAPI_CALL on_sets(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout,
                                          uint32_t first, uint32_t set_count, const VkDescriptorSet *sets,
                                          uint32_t offset_count, const uint32_t *offsets)
{
    (void)cmd, (void)point, (void)layout, (void)first;
    assert_int_equal(set_count, 1);
    say("<%d", (int)(size_t)sets[0]);
    for (uint32_t i = 0; i < offset_count; i++)
        say("+%u", offsets[i]);
    say(">");
}

static VKAPI_ATTR void VKAPI_CALL on_push(VkCommandBuffer cmd, VkPipelineLayout layout, VkShaderStageFlags stages,
                                          uint32_t offset, uint32_t size, const void *values)
{
    (void)cmd, (void)layout, (void)stages;
    assert_int_equal(size, 4);
    say("(%u:%u)", offset, *(const uint32_t *)values);
}

static VKAPI_ATTR void VKAPI_CALL on_label(VkCommandBuffer cmd, const VkDebugUtilsLabelEXT *label)
{
    (void)cmd;
    say("[%s ", label->pLabelName);
}

static VKAPI_ATTR void VKAPI_CALL on_label_end(VkCommandBuffer cmd)
{
    (void)cmd;
    say("]");
}

/* A context of which lanes use the functions, the heap, and what it says of the device. */
static virga_context *context_of(void)
{
    static virga_context context;
    memset(&context, 0, sizeof context);
    trace[0] = 0;
    virga_host_heap_init(&context.heap, NULL);
    context.vk.CmdDispatch = on_dispatch;
    context.vk.CmdPipelineBarrier = on_barrier;
    context.vk.CmdBindDescriptorSets = on_sets;
    context.vk.CmdPushConstants = on_push;
    context.vk.CmdBeginDebugUtilsLabelEXT = on_label;
    context.vk.CmdEndDebugUtilsLabelEXT = on_label_end;
    return &context;
}

#define CMD ((VkCommandBuffer)trace)

/* Dispatches a letter for each letter, and a barrier for each bar. */
static void record(virga_context *context, VkCommandBuffer cmd, const char *letters)
{
    for (; *letters; letters++)
        if (*letters == '|')
            virga_compute_barrier(context, cmd);
        else
            context->vk.CmdDispatch(cmd, (uint32_t)*letters, 1, 1);
}

static void finish(virga_context *context, const char *expected)
{
    virga_lanes_join(context, CMD);
    assert_string_equal(trace, expected);
    virga_lanes_destroy(context);
    assert_int_equal(context->heap.live_count, 0);
}

static void two_chains_share_their_barriers(void **state)
{
    (void)state;
    virga_context *context = context_of();
    record(context, virga_lane(context, CMD, 0), "a|b|c|");
    record(context, virga_lane(context, CMD, 1), "A|B|C|D|E|");
    assert_string_equal(trace, ""); /* nothing is recorded yet */
    finish(context, "aA|bB|cC|D|E|");
}

static void a_lane_goes_on_where_it_was(void **state)
{
    (void)state;
    virga_context *context = context_of();
    record(context, virga_lane(context, CMD, 0), "a|");
    record(context, virga_lane(context, CMD, 2), "A|B");
    record(context, virga_lane(context, CMD, 0), "b|c");
    finish(context, "aA|bB|c");
}

static void after_the_join_commands_are_recorded_at_once(void **state)
{
    (void)state;
    virga_context *context = context_of();
    for (int i = 0; i < 2; i++) { /* and lanes can begin again */
        trace[0] = 0;
        record(context, CMD, "x|");
        record(context, virga_lane(context, CMD, 1), "a");
        virga_lanes_join(context, CMD);
        record(context, CMD, "y");
        assert_string_equal(trace, "x|ay");
    }
    finish(context, "x|ay");
}

static void a_shared_barrier_waits_for_what_each_waits_for(void **state)
{
    (void)state;
    virga_context *context = context_of();
    VkCommandBuffer lane = virga_lane(context, CMD, 0);
    record(context, lane, "a");
    virga_wait(context, lane, VIRGA_COPIES, VIRGA_PASSES);
    record(context, lane, "b");
    lane = virga_lane(context, CMD, 1);
    record(context, lane, "A");
    virga_indirect_barrier(context, lane);
    record(context, lane, "B");
    finish(context, "aA|tibB");
}

static void image_barriers_of_all_lanes_are_in_it(void **state)
{
    (void)state;
    virga_context *context = context_of();
    const virga_image_state state_of = {VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0};
    for (uint32_t i = 0; i < 2; i++) {
        VkCommandBuffer lane = virga_lane(context, CMD, i);
        record(context, lane, "a");
        virga_image_barrier(context, lane, (VkImage)(size_t)(i + 1), VK_IMAGE_ASPECT_COLOR_BIT, state_of, state_of);
        record(context, lane, "b");
    }
    finish(context, "aa|12bb");
}

static void more_image_barriers_than_fit_are_more_barriers(void **state)
{
    (void)state;
    virga_context *context = context_of();
    VkImageMemoryBarrier images[12] = {{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER}};
    const VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    for (uint32_t i = 0; i < 12; i++)
        images[i].image = (VkImage)(size_t)(i % 2);
    for (uint32_t i = 0; i < 2; i++)
        context->vk.CmdPipelineBarrier(virga_lane(context, CMD, i), 1, 1, 0, 1, &memory, 0, NULL, 12, images);
    finish(context, "|010101010101|010101010101");
}

static void bind(virga_context *context, VkCommandBuffer cmd, int set, uint32_t offset)
{
    const VkDescriptorSet sets[] = {(VkDescriptorSet)(size_t)set};
    context->vk.CmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, VK_NULL_HANDLE, 0, 1, sets, 1, &offset);
}

static void push_by(virga_context *context, VkCommandBuffer cmd, uint64_t layout, uint32_t offset, uint32_t value)
{
    VkPipelineLayout handle;
    memcpy(&handle, &layout, sizeof handle);
    context->vk.CmdPushConstants(cmd, handle, VK_SHADER_STAGE_COMPUTE_BIT, offset, 4, &value);
}

static void push(virga_context *context, VkCommandBuffer cmd, uint32_t offset, uint32_t value)
{
    push_by(context, cmd, 0, offset, value);
}

static void what_a_lane_has_bound_is_bound_again(void **state)
{
    (void)state;
    virga_context *context = context_of();
    VkCommandBuffer lane = virga_lane(context, CMD, 0);
    bind(context, lane, 1, 64);
    push(context, lane, 0, 5);
    push(context, lane, 4, 6);
    push(context, lane, 0, 7);
    record(context, lane, "a|b|c");
    lane = virga_lane(context, CMD, 1);
    bind(context, lane, 2, 0);
    record(context, lane, "A|B");
    finish(context, "<1+64>(0:5)(4:6)(0:7)a<2+0>A|<1+64>(4:6)(0:7)b<2+0>B|<1+64>(4:6)(0:7)c");
}

/* As layouts share the room of their constants. */
static void what_was_pushed_last_is_pushed_last_again(void **state)
{
    (void)state;
    virga_context *context = context_of();
    VkCommandBuffer lane = virga_lane(context, CMD, 0);
    push_by(context, lane, 1, 0, 5);
    record(context, lane, "a|");
    push_by(context, lane, 2, 0, 6);
    record(context, lane, "b|");
    push_by(context, lane, 1, 0, 7);
    record(context, lane, "c|d");
    lane = virga_lane(context, CMD, 1);
    bind(context, lane, 2, 0);
    record(context, lane, "A|B|C|D");
    finish(context, "(0:5)a<2+0>A|(0:5)(0:6)b<2+0>B|(0:5)(0:6)(0:7)c<2+0>C|(0:6)(0:7)d<2+0>D");
}

static void a_lane_alone_binds_once(void **state)
{
    (void)state;
    virga_context *context = context_of();
    VkCommandBuffer lane = virga_lane(context, CMD, 3);
    bind(context, lane, 1, 0);
    record(context, lane, "a|b|c");
    finish(context, "<1+0>a|b|c");
}

static void labels_are_around_the_commands_of_their_lane(void **state)
{
    (void)state;
    virga_context *context = context_of();
    const VkDebugUtilsLabelEXT ground = {.pLabelName = "ground"}, pane = {.pLabelName = "pane"};
    VkCommandBuffer lane = virga_lane(context, CMD, 0);
    context->vk.CmdBeginDebugUtilsLabelEXT(lane, &ground);
    record(context, lane, "a|b");
    context->vk.CmdEndDebugUtilsLabelEXT(lane);
    lane = virga_lane(context, CMD, 1);
    context->vk.CmdBeginDebugUtilsLabelEXT(lane, &pane);
    record(context, lane, "A|B");
    context->vk.CmdEndDebugUtilsLabelEXT(lane);
    finish(context, "[ground a][pane A|][ground b][pane B]");
}

static void there_are_none_for_software_or_with_timings(void **state)
{
    (void)state;
    virga_context *context = context_of();
    context->for_software = true;
    assert_ptr_equal(virga_lane(context, CMD, 1), CMD);
    context->for_software = false;
    context->timers.enabled = true;
    assert_ptr_equal(virga_lane(context, CMD, 1), CMD);
    finish(context, "");
}

static void *no_alloc(void *user, size_t size)
{
    uint32_t *left = user;
    return *left && (*left)-- ? calloc(1, size) : NULL;
}

static void no_free(void *user, void *block)
{
    (void)user;
    free(block);
}

static void without_memory_nothing_is_recorded(void **state)
{
    (void)state;
    uint32_t left = 1; /* for the lanes, and none for commands */
    const virga_host_memory memory = {.alloc = no_alloc, .free = no_free, .user = &left};
    virga_context *context = context_of();
    virga_host_heap_init(&context->heap, &memory);
    record(context, virga_lane(context, CMD, 0), "a|b");
    virga_lanes_join(context, CMD);
    assert_int_equal(context->recording_failed, VIRGA_ERROR_HOST_MEMORY);
    finish(context, "");
}

/* Every function that records is kept, or a lane would reach the driver. The two of timestamps are never called, as
 * there are no lanes with timings. */
static void all_commands_are_kept(void **state)
{
    (void)state;
    virga_context *context = context_of();
    memset(&context->vk, 1, sizeof context->vk); /* none is called */
    const virga_functions before = context->vk;
    virga_lane(context, CMD, 0);
#define KEPT(name)                                                                                               \
    if (!strncmp(#name, "Cmd", 3) && strcmp(#name, "CmdResetQueryPool") && strcmp(#name, "CmdWriteTimestamp") && \
        memcmp(&context->vk.name, &before.name, sizeof before.name) == 0)                                        \
        fail_msg("vk%s", #name);
    VIRGA_DEVICE_FUNCTIONS(KEPT)
    VIRGA_OPTIONAL_FUNCTIONS(KEPT)
    finish(context, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_chains_share_their_barriers),
        cmocka_unit_test(a_lane_goes_on_where_it_was),
        cmocka_unit_test(after_the_join_commands_are_recorded_at_once),
        cmocka_unit_test(a_shared_barrier_waits_for_what_each_waits_for),
        cmocka_unit_test(image_barriers_of_all_lanes_are_in_it),
        cmocka_unit_test(more_image_barriers_than_fit_are_more_barriers),
        cmocka_unit_test(what_a_lane_has_bound_is_bound_again),
        cmocka_unit_test(what_was_pushed_last_is_pushed_last_again),
        cmocka_unit_test(a_lane_alone_binds_once),
        cmocka_unit_test(labels_are_around_the_commands_of_their_lane),
        cmocka_unit_test(there_are_none_for_software_or_with_timings),
        cmocka_unit_test(without_memory_nothing_is_recorded),
        cmocka_unit_test(all_commands_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
