/* call_times.c - see call_times.h. */
#include "bench/model/call_times.h"

bool call_times_open(call_times *times, host_device *device, char *error, size_t error_size)
{
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = 2 * CALL_TIMES_MAX};
    times->device = device;
    times->count = 0;
    return vkCreateQueryPool(device->device, &info, NULL, &times->pool) == VK_SUCCESS ||
           host_fail(error, error_size, "no timestamps");
}

void call_times_close(call_times *times)
{
    if (times->pool)
        vkDestroyQueryPool(times->device->device, times->pool, NULL);
    times->pool = VK_NULL_HANDLE;
}

static void wait_for_all(VkCommandBuffer cmd)
{
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    host_memory_barrier(cmd, all, VK_ACCESS_MEMORY_WRITE_BIT, all, VK_ACCESS_MEMORY_READ_BIT);
}

static void write_time(const call_times *times, VkCommandBuffer cmd, uint32_t query)
{
    wait_for_all(cmd);
    vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, times->pool, query);
    wait_for_all(cmd);
}

uint32_t call_times_begin(call_times *times, VkCommandBuffer cmd)
{
    if (!times->pool || times->count == CALL_TIMES_MAX)
        return CALL_TIMES_MAX;
    vkCmdResetQueryPool(cmd, times->pool, 2 * times->count, 2);
    write_time(times, cmd, 2 * times->count);
    return times->count++;
}

void call_times_end(call_times *times, VkCommandBuffer cmd, uint32_t call)
{
    if (call < CALL_TIMES_MAX)
        write_time(times, cmd, 2 * call + 1);
}

uint32_t call_times_read(call_times *times)
{
    const uint32_t count = times->count;
    const double second = 1e-9 * (double)times->device->properties.limits.timestampPeriod;
    for (uint32_t i = 0; i < count; i++) {
        uint64_t at[2];
        const VkResult result = vkGetQueryPoolResults(times->device->device, times->pool, 2 * i, 2, sizeof at, at,
                                                      sizeof at[0], VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        times->seconds[i] = result == VK_SUCCESS ? (double)(at[1] - at[0]) * second : 0;
    }
    times->count = 0;
    return count;
}
