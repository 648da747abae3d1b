/* gpu/retire.c - deferred destruction of what frames in flight may still use. */
#include "gpu/retire.h"

#include "gpu/builds.h"
#include "gpu/context.h"

void virga_retire(virga_context *context, virga_resource *resource)
{
    resource->last_frame = context->making ? 0 : context->frame_index;
    resource->retired = true;
    resource->next = context->retired;
    context->retired = resource;
    /* No device work is in flight, so the resource is destroyed at once. Its memory is free for the next resource, a
     * create that failed half-way leaves nothing behind, and a host that renders no more frames gets all memory
     * back. */
    if (context->making || context->frame_index == context->completed_index)
        virga_destroy_retired(context, false);
}

void virga_destroy_retired(virga_context *context, bool all)
{
    /* A pipeline that another thread is building reads its layout, which may be one of these resources. */
    if (virga_builds_cancel_retired(context) && !all)
        return;
    virga_resource **at = &context->retired;
    while (*at) {
        virga_resource *resource = *at;
        if (all || resource->last_frame <= context->completed_index) {
            *at = resource->next;
            resource->destroy(context, resource);
        } else {
            at = &resource->next;
        }
    }
}
