/* gpu/retire.h - deferred destruction: a retired resource exists until the last frame that used it has completed.
 * Internal. */
#ifndef VIRGA_GPU_RETIRE_H
#define VIRGA_GPU_RETIRE_H

#include <virga/vulkan.h>

#include <stdbool.h>
#include <stdint.h>

/* The first member of everything that can be retired: buffers, images, pipelines, bindings. */
typedef struct virga_resource {
    struct virga_resource *next; /* in the context's list of retired resources */
    uint64_t last_frame;         /* the last frame that may have used it */
    bool retired;
    void (*destroy)(struct virga_context *context, struct virga_resource *resource);
} virga_resource;

/* Retires a resource. It is destroyed at once if all begun frames have completed, otherwise when the newest of them
 * has. The macro accepts NULL, and sets the pointer to NULL. */
void virga_retire(virga_context *context, virga_resource *resource);
#define VIRGA_RETIRE(context, pointer)                   \
    do {                                                 \
        if (pointer)                                     \
            virga_retire(context, &(pointer)->resource); \
        (pointer) = NULL;                                \
    } while (0)

/* Destroys the retired resources that no frame in flight uses, or all of them if `all` is true. */
void virga_destroy_retired(virga_context *context, bool all);

/* Destroys a Vulkan object that was counted in context->objects; null handles are accepted. E.g.
 * VIRGA_DESTROY(context, Buffer, buffer->buffer). */
#define VIRGA_DESTROY(context, Kind, handle)                                \
    do {                                                                    \
        if (handle) {                                                       \
            (context)->vk.Destroy##Kind((context)->device, (handle), NULL); \
            (context)->objects--;                                           \
        }                                                                   \
    } while (0)

#endif
