/* rain_one_streak.h - a prepared draw, reduced to one of its streaks. */
#ifndef VIRGA_TESTS_RAIN_ONE_STREAK_H
#define VIRGA_TESTS_RAIN_ONE_STREAK_H

#include "memory.h"
#include "rain/rain_internal.h"

/* Call it between prepare and draw: only the streak at an index of the list is drawn, as a thin or as a wide one. */
static inline void record_only(const virga_rain *rain, VkCommandBuffer cmd, uint32_t streak, bool wide)
{
    const virga_draw_gpu none = {0, 1, 0, 0, 0}, one = {6, 1, 0, 0, 0};
    const virga_draw_gpu draws[3] = {wide ? one : none, none, wide ? none : one};
    const uint32_t first = 4 * streak, corners[6] = {first, first + 1, first + 2, first + 2, first + 1, first + 3};
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                        VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdUpdateBuffer(cmd, rain->prepared_buffer->buffer, 0, sizeof draws, draws);
    vkCmdUpdateBuffer(cmd, rain->order_buffer->buffer, 0, sizeof corners, corners);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_VERTEX_INPUT_BIT,
                        VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_INDEX_READ_BIT);
}

#endif
