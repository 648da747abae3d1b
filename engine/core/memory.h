/* core/memory.h - counted host memory from the host's callbacks. Internal.
 *
 * Every block stores its size in front of it. So the heap knows what is allocated, and a host's allocator needs no size
 * when a block is freed. A heap is used by one thread at a time, like the object that owns it. */
#ifndef VIRGA_CORE_MEMORY_H
#define VIRGA_CORE_MEMORY_H

#include <virga/base.h>

typedef struct virga_host_heap {
    virga_host_memory callbacks;
    size_t live_count; /* allocated blocks */
    size_t live_bytes; /* their requested sizes, without headers */
} virga_host_heap;

/* Initialises an empty heap. `callbacks` NULL or all zero: malloc and free. If only one of alloc and free is set,
 * returns VIRGA_ERROR_INVALID; the heap then works with malloc and free. */
virga_result virga_host_heap_init(virga_host_heap *heap, const virga_host_memory *callbacks);

/* Zeroed memory, aligned to 16 bytes, or NULL. Size 0 gives a valid block too. */
void *virga_alloc(virga_host_heap *heap, size_t size);

/* Zeroed memory for `count` elements. NULL if memory ran out, or if the product does not fit into size_t. */
void *virga_alloc_array(virga_host_heap *heap, size_t count, size_t element_size);

/* Accepts NULL. The block must come from the same heap. */
void virga_free(virga_host_heap *heap, void *block);

/* A copy of a string; NULL for NULL or when memory ran out. */
char *virga_strdup(virga_host_heap *heap, const char *text);

/* A copy of `size` bytes; NULL for NULL or when memory ran out. */
void *virga_memdup(virga_host_heap *heap, const void *data, size_t size);

#endif
