/* gpu/state_bytes.c - see state_bytes.h. */
#include "gpu/state_bytes.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

/* Multiplies and folds words of 64 bits. It finds damage, but does not protect against bytes made on purpose. */
static uint64_t mix(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 29;
}

/* Of all bytes, with 0 in place of the hash. Never 0. */
static uint64_t hash_of(const void *bytes, uint64_t size)
{
    const uint64_t *words = bytes;
    const uint64_t own = offsetof(virga_state_header, hash) / sizeof *words;
    uint64_t hash = size;
    for (uint64_t i = 0; i < size / sizeof *words; i++)
        hash = mix(hash, i == own ? 0 : words[i]);
    return hash ? hash : 1;
}

static void fill_info(const virga_state_header *header, virga_state_info *info)
{
    if (info)
        *info = (virga_state_info){.version = header->version,
                                   .effects = header->effects,
                                   .bytes = header->bytes,
                                   .frame_index = header->frame_index,
                                   .hash = header->hash,
                                   .vendor_id = header->vendor_id,
                                   .device_id = header->device_id,
                                   .driver_version = header->driver_version};
}

static bool is_aligned(const void *bytes)
{
    return (uintptr_t)bytes % _Alignof(uint64_t) == 0;
}

virga_result virga_state_seal(void *bytes, VkDeviceSize size, uint64_t frame_index, virga_state_info *info)
{
    virga_state_header *header = bytes;
    if (!bytes || !is_aligned(bytes) || size < sizeof *header)
        return VIRGA_ERROR_INVALID;
    if (memcmp(header->magic, VIRGA_STATE_MAGIC, sizeof header->magic) || header->frame_index != frame_index)
        return VIRGA_NOT_READY;
    if (header->bytes > size || header->bytes % VIRGA_STATE_ALIGNMENT)
        return VIRGA_ERROR_INVALID;
    header->hash = hash_of(bytes, header->bytes);
    fill_info(header, info);
    return VIRGA_OK;
}

static virga_result refuse(char *reason, size_t reason_size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (reason && reason_size)
        vsnprintf(reason, reason_size, format, arguments);
    va_end(arguments);
    return VIRGA_ERROR_INVALID;
}

virga_result virga_state_read(const void *bytes, VkDeviceSize size, virga_state_info *info, char *reason,
                              size_t reason_size)
{
    const virga_state_header *header = bytes;
    if (!bytes || !is_aligned(bytes))
        return refuse(reason, reason_size, "expected bytes that are aligned to 8, got %s",
                      bytes ? "others" : "a NULL pointer");
    if (size < sizeof *header || memcmp(header->magic, VIRGA_STATE_MAGIC, sizeof header->magic))
        return refuse(reason, reason_size, "the bytes are not a saved state");
    if (header->version != VIRGA_STATE_VERSION)
        return refuse(reason, reason_size, "the state has format version %u, expected %u", header->version,
                      VIRGA_STATE_VERSION);
    if (header->bytes > size || header->bytes < sizeof *header || header->bytes % VIRGA_STATE_ALIGNMENT)
        return refuse(reason, reason_size, "the state has %llu bytes, of which %llu were given",
                      (unsigned long long)header->bytes, (unsigned long long)size);
    if (!header->hash)
        return refuse(reason, reason_size, "the state is not sealed, see virga_state_seal");
    if (header->hash != hash_of(bytes, header->bytes))
        return refuse(reason, reason_size, "the state is damaged: its bytes do not have its hash");
    fill_info(header, info);
    return VIRGA_OK;
}
