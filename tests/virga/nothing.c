/* nothing.c - an effect that does nothing, with one setting, one layer, one pass and one statistic: all that the
 * program has to know of a new effect. Its pass counts steps in a buffer on the device; its layer stays empty. */
#include "effect.h"
#include "scene_rows.h"

#include <stdio.h>

typedef struct scene_nothing {
    double amount;
} scene_nothing;

static const scene_row nothing_rows[] = {
    NUMBER(scene_nothing, amount, 0, 10, "1", LIVE, "of nothing"),
};
static const scene_group nothing_group = SCENE_GROUP(scene_nothing, nothing_rows);
static const scene_row nothing_section[] = {SECTION_GROUP("nothing", &nothing_group, "an effect without an effect")};

typedef struct nothing_state {
    host_buffer counter;
    uint32_t steps;
    double amount;
} nothing_state;

extern const tool_effect nothing_effect;

static bool open_state(shot *s, void *state, char *error, size_t error_size)
{
    nothing_state *n = state;
    return host_buffer_create(&s->device, 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "steps",
                              &n->counter, error, error_size);
}

static void close_state(shot *s, void *state)
{
    host_buffer_destroy(&s->device, &((nothing_state *)state)->counter);
}

static bool apply(shot *s, void *state, double time_s, char *error, size_t error_size)
{
    (void)time_s, (void)error, (void)error_size;
    ((nothing_state *)state)->amount =
        ((const scene_nothing *)scene_file_section(s->scene, &nothing_effect.scene))->amount;
    return true;
}

static bool step(shot *s, void *state, VkCommandBuffer cmd, double dt_s, char *error, size_t error_size)
{
    nothing_state *n = state;
    const VkPipelineStageFlags copying = VK_PIPELINE_STAGE_TRANSFER_BIT;
    (void)s, (void)dt_s, (void)error, (void)error_size;
    host_memory_barrier(cmd, copying, VK_ACCESS_TRANSFER_WRITE_BIT, copying, VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdFillBuffer(cmd, n->counter.buffer, 0, 4, ++n->steps);
    host_memory_barrier(cmd, copying, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
    return true;
}

static virga_result draw(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    (void)state, (void)cmd, (void)target;
    return VIRGA_OK;
}

static const tool_layer layers[] = {
    {.name = "nothing",
     .channels = {"nothing.R", "nothing.G", "nothing.B", "nothing.A"},
     .type = EXR_SAMPLE_HALF,
     .help = "an empty layer",
     .draw = draw,
     .order = 40},
};

static void write_stats(shot *s, void *state, jsonl *stats)
{
    const nothing_state *n = state;
    host_buffer_invalidate(&s->device, &n->counter);
    jsonl_begin_object(stats, "nothing");
    jsonl_number(stats, "amount", n->amount);
    jsonl_uint64(stats, "steps", *(const uint32_t *)n->counter.mapped);
    jsonl_end(stats);
}

const tool_effect nothing_effect = {
    .name = "nothing",
    .scene = {.group = SCENE_GROUP(scene_nothing, nothing_section)},
    .state_size = sizeof(nothing_state),
    .open = open_state,
    .close = close_state,
    .apply = apply,
    .step = step,
    .layers = layers,
    .layer_count = 1,
    .write_stats = write_stats,
    .title = "Nothing",
};
