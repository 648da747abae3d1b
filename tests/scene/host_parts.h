/* host_parts.h - what hosts of these tests have in common: the square that rain falls on, pictures that views read, and
 * a frame that is thrown away. */
#ifndef VIRGA_TESTS_HOST_PARTS_H
#define VIRGA_TESTS_HOST_PARTS_H

#include "../gpu/small_scene.h"
#include "../host/effect_fixture.h"

#include <string.h>

/* A buffer with `size` bytes of `data`. */
static inline void host_parts_buffer(fixture *gpu, const void *data, size_t size, VkBufferUsageFlags usage,
                                     host_buffer *made)
{
    REQUIRE(host_buffer_create_with(&gpu->device, data, size, usage, "of a test", made, gpu->error, sizeof gpu->error));
}

/* The square of small_occluder. */
static inline void host_parts_square(fixture *gpu, host_buffer *vertices, host_buffer *indices)
{
    host_parts_buffer(gpu, small_square, sizeof small_square, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, vertices);
    host_parts_buffer(gpu, small_square_indices, sizeof small_square_indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                      indices);
}

/* A sampled picture of side x side texels of four bytes. */
static inline virga_image host_parts_picture(fixture *gpu, VkFormat format, uint32_t side, const void *data,
                                             host_image *made)
{
    const host_image_def def = {
        .format = format, .extent = {side, side, 1}, .usage = VK_IMAGE_USAGE_SAMPLED_BIT, .name = "of a test"};
    REQUIRE(host_image_create_with(&gpu->device, &def, data, (size_t)side * side * 4, 4, made, gpu->error,
                                   sizeof gpu->error));
    return (virga_image){.image = made->image,
                         .view = made->view,
                         .format = format,
                         .before = {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}};
}

/* Depth of the ground, a metre below the cameras of gpu_view, and of the sky, in a picture of side x side texels. */
static inline void host_parts_depth(uint32_t side, float *depth)
{
    for (uint32_t y = 0; y < side; y++) {
        const float down = 2 * ((float)y + 0.5f) / (float)side - 1;
        for (uint32_t x = 0; x < side; x++)
            depth[y * side + x] = down > 0.01f ? 1.001f - 0.1001f * down : 1;
    }
}

/* Throws away what the frame has recorded: an empty command buffer goes to the queue in its place. `tell`: the library
 * hears of it. */
static inline void host_parts_throw_away(const host_device *device, virga_context *context, VkCommandBuffer cmd,
                                         bool tell)
{
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    REQUIRE(vkEndCommandBuffer(cmd) == VK_SUCCESS);
    REQUIRE(vkResetCommandPool(device->device, device->frames[device->frame % HOST_FRAMES].pool, 0) == VK_SUCCESS);
    REQUIRE(vkBeginCommandBuffer(cmd, &begin) == VK_SUCCESS);
    if (tell)
        REQUIRE(virga_frame_dropped(context, device->frame) == VIRGA_OK);
}

#endif
