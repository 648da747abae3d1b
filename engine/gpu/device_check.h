/* gpu/device_check.h - limits that every device has, because of Vulkan or virga_check_device. Internal. */
#ifndef VIRGA_GPU_DEVICE_CHECK_H
#define VIRGA_GPU_DEVICE_CHECK_H

#include <virga/vulkan.h>

#define VIRGA_STORAGE_BUFFERS   16    /* in one stage of one pass; Vulkan alone guarantees four */
#define VIRGA_RING_ALIGNMENT    256   /* the largest offset alignment that a device may require */
#define VIRGA_GUARANTEED_TEXELS 65536 /* guaranteed in a buffer view */

#endif
