/* gpu/target.c - classes of targets, and graphics pipelines for a target. */
#include "gpu/target.h"

#include "gpu/context.h"
#include "gpu/errors.h"

#include <string.h>

/* The members that decide what a pipeline is like. A render pass is known by its handle only, and a handle may be given
 * to another pass later. So without a class number, each such target is of a class of its own. */
static void fill_like(const virga_target *target, virga_target_def *like)
{
    const virga_target_def *def = &target->def;
    memset(like, 0, sizeof *like); /* also the padding */
    like->kind = def->kind;
    like->color_count = def->color_count;
    like->motion_attachment = def->motion_attachment;
    like->reactive_attachment = def->reactive_attachment;
    like->samples = def->samples;
    like->depth_attached = def->depth_attached;
    like->depth_written = def->depth_written;
    like->reversed_depth = def->reversed_depth;
    like->view_mask = def->view_mask;
    if (def->encoding == VIRGA_ENCODING_SRGB) {
        like->encoding = def->encoding;
        like->blend_background = def->blend_background;
    }
    if (def->kind == VIRGA_TARGET_DYNAMIC) {
        memcpy(like->color_formats, def->color_formats, sizeof like->color_formats);
        like->depth_format = def->depth_format;
        like->stencil_format = def->stencil_format;
    } else {
        like->subpass = def->subpass;
        like->render_pass_class = def->render_pass_class;
    }
}

static virga_target_class *find_class(const virga_context *context, const virga_target_def *like)
{
    if (like->kind == VIRGA_TARGET_RENDER_PASS && !like->render_pass_class)
        return NULL;
    for (virga_target_class *found = context->first_target_class; found; found = found->next)
        if (!memcmp(&found->like, like, sizeof *like))
            return found;
    return NULL;
}

virga_result virga_target_class_join(virga_context *context, virga_target *target)
{
    virga_target_def like;
    fill_like(target, &like);
    target->class_of = find_class(context, &like);
    if (!target->class_of) {
        target->class_of = virga_alloc(&context->heap, sizeof *target->class_of);
        if (!target->class_of)
            return virga_out_of_host_memory(context, "a target");
        target->class_of->serial = ++context->class_serial;
        memcpy(&target->class_of->like, &like, sizeof like);
        target->class_of->next = context->first_target_class;
        context->first_target_class = target->class_of;
    }
    target->class_of->targets++;
    return VIRGA_OK;
}

static void free_unused(virga_context *context, virga_target_class *class_of)
{
    if (class_of->targets || class_of->users)
        return;
    virga_target_class **at = &context->first_target_class;
    while (*at != class_of)
        at = &(*at)->next;
    *at = class_of->next;
    virga_free(&context->heap, class_of);
}

void virga_target_class_use(virga_target_class *class_of)
{
    class_of->users++;
}

void virga_target_class_leave(virga_context *context, virga_target_class *class_of)
{
    class_of->users--;
    free_unused(context, class_of);
}

virga_target_outputs virga_target_outputs_of(const virga_target *target)
{
    return (virga_target_outputs)((target->def.motion_attachment ? VIRGA_OUTPUTS_MOTION : 0) |
                                  (target->def.reactive_attachment ? VIRGA_OUTPUTS_REACTIVE : 0));
}

virga_result virga_target_pipeline(const virga_target *target, virga_graphics_def def, virga_pipeline **pipeline)
{
    const virga_target_def *into = &target->def;
    def.pass_class = target->class_of->serial;
    def.color_count = into->color_count;
    def.motion_attachment = def.outputs & VIRGA_OUTPUTS_MOTION ? into->motion_attachment : 0;
    def.reactive_attachment = def.outputs & VIRGA_OUTPUTS_REACTIVE ? into->reactive_attachment : 0;
    def.samples = into->samples;
    def.depth_test = def.depth_test && into->depth_attached;
    def.depth_write = def.depth_test && into->depth_written;
    def.reversed_depth = into->reversed_depth;
    def.encoded = into->encoding == VIRGA_ENCODING_SRGB;
    def.blend_background = into->blend_background;
    if (into->kind == VIRGA_TARGET_DYNAMIC) {
        memcpy(def.color_formats, into->color_formats, sizeof def.color_formats);
        def.depth_format = into->depth_format;
        def.stencil_format = into->stencil_format;
        def.view_mask = into->view_mask;
    } else {
        def.render_pass = into->render_pass;
        def.subpass = into->subpass;
    }
    return virga_graphics_pipeline_create(target->context, &def, pipeline);
}
