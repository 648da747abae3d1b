/* core/memory.c - see memory.h. */
#include "core/memory.h"

#include <stdlib.h>
#include <string.h>

/* In front of each block. It is as large as the alignment, so the block behind it is aligned too. */
typedef union block_header {
    size_t size;
    unsigned char alignment[16];
} block_header;

_Static_assert(sizeof(block_header) == 16, "the block behind the header must be aligned to 16 bytes");

static void *default_alloc(void *user, size_t size)
{
    (void)user;
    size_t rounded = (size + 15) & ~(size_t)15; /* aligned_alloc needs a multiple of the alignment */
    return rounded < size ? NULL : aligned_alloc(16, rounded);
}

static void default_free(void *user, void *pointer)
{
    (void)user;
    free(pointer);
}

virga_result virga_host_heap_init(virga_host_heap *heap, const virga_host_memory *callbacks)
{
    *heap = (virga_host_heap){.callbacks = {.alloc = default_alloc, .free = default_free}};
    if (callbacks == NULL || (callbacks->alloc == NULL && callbacks->free == NULL)) {
        return VIRGA_OK;
    }
    if (callbacks->alloc == NULL || callbacks->free == NULL) {
        return VIRGA_ERROR_INVALID;
    }
    heap->callbacks = *callbacks;
    return VIRGA_OK;
}

void *virga_alloc(virga_host_heap *heap, size_t size)
{
    if (size > SIZE_MAX - sizeof(block_header)) {
        return NULL;
    }
    block_header *header = heap->callbacks.alloc(heap->callbacks.user, sizeof *header + size);
    if (header == NULL) {
        return NULL;
    }
    memset(header, 0, sizeof *header + size);
    header->size = size;
    heap->live_count++;
    heap->live_bytes += size;
    return header + 1;
}

void *virga_alloc_array(virga_host_heap *heap, size_t count, size_t element_size)
{
    if (element_size != 0 && count > SIZE_MAX / element_size) {
        return NULL;
    }
    return virga_alloc(heap, count * element_size);
}

void virga_free(virga_host_heap *heap, void *block)
{
    if (block == NULL) {
        return;
    }
    block_header *header = (block_header *)block - 1;
    heap->live_count--;
    heap->live_bytes -= header->size;
    heap->callbacks.free(heap->callbacks.user, header);
}

char *virga_strdup(virga_host_heap *heap, const char *text)
{
    return text == NULL ? NULL : virga_memdup(heap, text, strlen(text) + 1);
}

void *virga_memdup(virga_host_heap *heap, const void *data, size_t size)
{
    if (data == NULL) {
        return NULL;
    }
    void *copy = virga_alloc(heap, size);
    if (copy != NULL) {
        memcpy(copy, data, size);
    }
    return copy;
}
