/* machine_limits.c - copy, bare kernel, dispatch and fill on the device of the bench. */
#include "bench/machine_limits.h"

#include "progress.h"

#include "bare_comp.spv.h"
#include "fill_frag.spv.h"
#include "fill_vert.spv.h"

#include <stdlib.h>
#include <string.h>

#define EMPTY_DISPATCHES 200

struct limits {
    uint32_t groups;
    host_buffer from, to;
    host_bindings bindings;
    VkPipelineLayout fill_layout;
    VkPipeline bare, fill;
};

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

double bench_median(double *values, size_t count)
{
    qsort(values, count, sizeof values[0], by_value);
    return count ? values[count / 2] : 0;
}

static bool create_bare(host_device *device, limits *l, char *error, size_t error_size)
{
    static const VkDescriptorType types[2] = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    const host_bindings_def def = {.shape = {types, 2, VK_SHADER_STAGE_COMPUTE_BIT}, .set_count = 1};
    if (!host_bindings_create(device, &def, &l->bindings, error, error_size))
        return false;
    host_set_write_buffer(device, l->bindings.sets[0], 0, types[0], l->from.buffer);
    host_set_write_buffer(device, l->bindings.sets[0], 1, types[1], l->to.buffer);
    return host_compute_create(device, HOST_CODE(bare_comp), l->bindings.layout, &l->bare, error, error_size);
}

static bool create_fill(host_device *device, limits *l, const host_target *target, char *error, size_t error_size)
{
    return host_pipeline_layout_create(device, NULL, 0, 0, 0, &l->fill_layout, error, error_size) &&
           host_fullscreen_create(device, HOST_CODE(fill_vert), HOST_CODE(fill_frag), l->fill_layout,
                                  target->layer_pass, &l->fill, error, error_size);
}

bool limits_create(host_device *device, const host_target *target, uint32_t drops, limits **made, char *error,
                   size_t error_size)
{
    limits *l = calloc(1, sizeof *l);
    *made = l;
    if (!l)
        return host_fail(error, error_size, "no memory for the bench");
    l->groups = (drops + 255) / 256;
    const VkDeviceSize size = (VkDeviceSize)l->groups * 4096;
    const VkBufferUsageFlags usage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (host_buffer_create(device, size, usage, HOST_BUFFER_DEVICE, "bench from", &l->from, error, error_size) &&
        host_buffer_create(device, size, usage, HOST_BUFFER_DEVICE, "bench to", &l->to, error, error_size) &&
        create_bare(device, l, error, error_size) && create_fill(device, l, target, error, error_size))
        return true;
    limits_destroy(device, made);
    return false;
}

void limits_destroy(host_device *device, limits **made)
{
    limits *l = *made;
    if (!l)
        return;
    vkDestroyPipeline(device->device, l->bare, NULL);
    vkDestroyPipeline(device->device, l->fill, NULL);
    vkDestroyPipelineLayout(device->device, l->fill_layout, NULL);
    host_bindings_destroy(device, &l->bindings);
    host_buffer_destroy(device, &l->from);
    host_buffer_destroy(device, &l->to);
    free(l);
    *made = NULL;
}

/* ---- measuring: wall time of a submission by its fence, less that of an empty one */

typedef void (*record_fn)(VkCommandBuffer cmd, limits *l, const host_target *target);

static double submit_ms(host_device *device, limits *l, const host_target *target, record_fn record)
{
    VkCommandBuffer cmd;
    char error[256];
    if (!host_begin_frame(device, &cmd, error, sizeof error))
        return -1;
    if (record)
        record(cmd, l, target);
    const double start = progress_now();
    if (!host_submit(device, error, sizeof error) || !host_wait(device, error, sizeof error))
        return -1;
    return (progress_now() - start) * 1e3;
}

static double measure(host_device *device, limits *l, const host_target *target, record_fn record)
{
    double times[BENCH_RUNS];
    for (int i = 0; i < BENCH_RUNS; i++) {
        const double empty = submit_ms(device, l, target, NULL);
        times[i] = submit_ms(device, l, target, record) - empty;
    }
    return bench_median(times, BENCH_RUNS);
}

static void record_copy(VkCommandBuffer cmd, limits *l, const host_target *target)
{
    (void)target;
    const VkBufferCopy copy = {0, 0, l->from.size};
    vkCmdCopyBuffer(cmd, l->from.buffer, l->to.buffer, 1, &copy);
}

static void bind_bare(VkCommandBuffer cmd, const limits *l)
{
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, l->bare);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, l->bindings.layout, 0, 1, l->bindings.sets, 0, NULL);
}

static void record_bare(VkCommandBuffer cmd, limits *l, const host_target *target)
{
    (void)target;
    bind_bare(cmd, l);
    vkCmdDispatch(cmd, l->groups, 1, 1);
}

static void record_dispatches(VkCommandBuffer cmd, limits *l, const host_target *target)
{
    (void)target;
    const VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    bind_bare(cmd, l);
    for (int i = 0; i < EMPTY_DISPATCHES; i++) {
        vkCmdDispatch(cmd, 1, 1, 1);
        host_memory_barrier(cmd, compute, VK_ACCESS_SHADER_WRITE_BIT, compute,
                            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    }
}

static void record_fill(VkCommandBuffer cmd, limits *l, const host_target *target)
{
    host_target_begin_layer(target, cmd);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, l->fill);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    host_target_end_layer(target, cmd);
}

double limits_copy_ms(host_device *device, limits *l)
{
    return measure(device, l, NULL, record_copy);
}

double limits_bare_ms(host_device *device, limits *l)
{
    return measure(device, l, NULL, record_bare);
}

double limits_bare_once_ms(host_device *device, limits *l)
{
    return submit_ms(device, l, NULL, record_bare);
}

double limits_dispatch_ms(host_device *device, limits *l)
{
    return measure(device, l, NULL, record_dispatches) / EMPTY_DISPATCHES;
}

double limits_fill_ms(host_device *device, limits *l, const host_target *target)
{
    return measure(device, l, target, record_fill);
}
