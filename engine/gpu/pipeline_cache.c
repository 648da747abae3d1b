/* gpu/pipeline_cache.c - the context's VkPipelineCache, and the blob in which a host saves it. */
#include "gpu/pipeline_cache.h"

#include "gpu/context.h"
#include "gpu/errors.h"

#include <string.h>

#define BLOB_MAGIC UINT32_C(0x31637076) /* "vpc1" in a file */

/* The header in front of the driver's data. Drivers trust their data, so a truncated or damaged file must be detected
 * here. */
typedef struct blob_head {
    uint32_t magic;
    uint32_t size; /* of what follows */
    uint64_t hash; /* of what follows */
} blob_head;

/* 64-bit FNV-1a. */
static uint64_t hash_bytes(const void *data, size_t size)
{
    const unsigned char *bytes = data;
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * UINT64_C(0x100000001b3);
    return hash;
}

static bool blob_is_whole(const void *blob, size_t size)
{
    blob_head head;
    if (size < sizeof head)
        return false;
    memcpy(&head, blob, sizeof head);
    return head.magic == BLOB_MAGIC && head.size == size - sizeof head &&
           head.hash == hash_bytes((const char *)blob + sizeof head, head.size);
}

/* Vulkan's own header identifies driver and device: data of another one must not reach the driver. */
static bool data_is_ours(const virga_context *context, const void *data, size_t size)
{
    VkPipelineCacheHeaderVersionOne header;
    if (size < sizeof header)
        return false;
    memcpy(&header, data, sizeof header);
    return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorID == context->properties.vendorID && header.deviceID == context->properties.deviceID &&
           !memcmp(header.pipelineCacheUUID, context->properties.pipelineCacheUUID, VK_UUID_SIZE);
}

virga_result virga_pipeline_cache_create(virga_context *context, const void *blob, size_t size)
{
    virga_result result = VIRGA_OK;
    VkPipelineCacheCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    const bool whole = blob && blob_is_whole(blob, size);
    const void *data = whole ? (const char *)blob + sizeof(blob_head) : NULL;
    if (whole && data_is_ours(context, data, size - sizeof(blob_head))) {
        info.initialDataSize = size - sizeof(blob_head);
        info.pInitialData = data;
    } else if (blob && size) {
        virga_log_write(&context->log, VIRGA_LOG_INFO, VIRGA_LOG_PIPELINE_CACHE,
                        "the pipeline cache blob is %s; starting with an empty one",
                        whole ? "from another driver or device" : "not whole, or not one of virga_pipeline_cache_get");
    }
    VK_TRY(context, CreatePipelineCache(context->device, &info, NULL, &context->pipeline_cache));
    context->objects++;
error:
    return result;
}

virga_result virga_pipeline_cache_get(virga_context *context, size_t *size, void *data)
{
    virga_result result = VIRGA_OK;
    if (!context || !size)
        return virga_wrong_argument(context ? &context->log : NULL, "virga_pipeline_cache_get: NULL argument");
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    size_t bytes = 0;
    VK_TRY(context, GetPipelineCacheData(context->device, context->pipeline_cache, &bytes, NULL));
    if (data) {
        if (*size < bytes + sizeof(blob_head))
            return virga_wrong_argument(&context->log, "virga_pipeline_cache_get: expected room for %zu bytes, got %zu",
                                        bytes + sizeof(blob_head), *size);
        char *follows = (char *)data + sizeof(blob_head);
        VK_TRY(context, GetPipelineCacheData(context->device, context->pipeline_cache, &bytes, follows));
        const blob_head head = {BLOB_MAGIC, (uint32_t)bytes, hash_bytes(follows, bytes)};
        memcpy(data, &head, sizeof head);
    }
    *size = bytes + sizeof(blob_head);
error:
    return result;
}
