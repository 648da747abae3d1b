/* ripple_fixture.h - level ground under water, and what its ripple map and its list of rings hold. Include it once. */
#ifndef VIRGA_TESTS_RIPPLE_FIXTURE_H
#define VIRGA_TESTS_RIPPLE_FIXTURE_H

#include "ground_fixture.h"

#include <math.h>

static ground_fixture f;
static host_buffer picture, records; /* of the map, two halves a texel; and of the list */

/* All cells of a ground of its own under `mm` of water. The first step is done. */
static void ripple_fixture_flood(double mm)
{
    virga_cell_gpu *cells = f.upload.mapped;
    const uint32_t side = f.ground->def.cells, texels = f.ground->def.ripple_texels;
    for (uint32_t i = 0; i < side * side; i++)
        cells[i] = (virga_cell_gpu){(uint32_t)(mm * 2.5e6), 0};
    ground_fixture_put(&f);
    REQUIRE(host_buffer_create(&f.gpu.device, texels * texels * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "ripples", &picture, f.gpu.error, sizeof f.gpu.error));
    REQUIRE(host_buffer_create(&f.gpu.device, f.ground->rings->size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "rings", &records, f.gpu.error, sizeof f.gpu.error));
}

static void end(void)
{
    host_buffer_destroy(&f.gpu.device, &picture);
    host_buffer_destroy(&f.gpu.device, &records);
    ground_fixture_close(&f);
}

static void read_back(void)
{
    VkCommandBuffer cmd;
    const uint32_t texels = f.ground->def.ripple_texels;
    REQUIRE(host_begin_frame(&f.gpu.device, &cmd, f.gpu.error, sizeof f.gpu.error));
    REQUIRE(virga_frame_begin(f.context, f.gpu.device.frame, f.gpu.device.completed) == VIRGA_OK);
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {texels, texels, 1}};
    const VkImage map = f.ground->ripples.map->colors[0]->image;
    vkCmdCopyImageToBuffer(cmd, map, VK_IMAGE_LAYOUT_GENERAL, picture.buffer, 1, &copy);
    ground_fixture_copy(cmd, f.ground->rings->buffer, 0, records.buffer, 0, f.ground->rings->size);
    ground_fixture_submit(&f);
    host_buffer_invalidate(&f.gpu.device, &picture);
    host_buffer_invalidate(&f.gpu.device, &records);
}

/* What the map holds: the slope along an axis. */
static double slope(int x, int y, int axis)
{
    const uint16_t half =
        ((const uint16_t *)
             picture.mapped)[((uint32_t)y * f.ground->def.ripple_texels + (uint32_t)x) * 2 + (uint32_t)axis];
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    const double value = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return half & 0x8000 ? -value : value;
}

#endif
