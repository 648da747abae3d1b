/* gpu/pipelines.c - compute and graphics pipelines from embedded SPIR-V: creates, shares and destroys them. */
#include "gpu/pipelines.h"

#include "gpu/builds.h"
#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/layouts.h"
#include "gpu/retire.h"

#include <string.h>

/* ---- pipelines on the device */

static void built_destroy(virga_context *context, virga_built *built)
{
    virga_build_abandon(context, built);
    virga_built **at = &context->first_built;
    while (*at != built)
        at = &(*at)->next;
    *at = built->next;
    virga_free(&context->heap, built->code);
    VIRGA_DESTROY(context, Pipeline, built->handle);
    virga_layout_release(context, built->is_graphics ? built->graphics.layout : built->compute.layout);
    virga_free(&context->heap, built);
}

/* Passes of other names have pipelines of their own, so that each has its name in a debugger. */
static bool is_same_compute(const virga_compute_def *a, const virga_compute_def *b)
{
    return a->shader == b->shader && a->layout == b->layout && a->constant == b->constant && !strcmp(a->name, b->name);
}

static bool is_same_target(const virga_graphics_def *a, const virga_graphics_def *b)
{
    return a->pass_class == b->pass_class && !a->render_pass == !b->render_pass && a->subpass == b->subpass &&
           !memcmp(a->color_formats, b->color_formats, sizeof a->color_formats) && a->depth_format == b->depth_format &&
           a->stencil_format == b->stencil_format && a->view_mask == b->view_mask && a->color_count == b->color_count &&
           a->outputs == b->outputs && a->motion_attachment == b->motion_attachment &&
           a->reactive_attachment == b->reactive_attachment && a->encoded == b->encoded &&
           a->blend_background == b->blend_background && a->samples == b->samples &&
           a->reversed_depth == b->reversed_depth;
}

static bool is_same_graphics(const virga_graphics_def *a, const virga_graphics_def *b)
{
    return a->vertex == b->vertex && a->fragment == b->fragment && a->layout == b->layout &&
           a->constant == b->constant && a->vertex_stride == b->vertex_stride &&
           a->blend_premultiplied == b->blend_premultiplied && a->blend_add == b->blend_add &&
           a->add_all == b->add_all && a->no_color == b->no_color && a->depth_test == b->depth_test &&
           a->depth_write == b->depth_write && a->cull_back == b->cull_back && a->lines == b->lines &&
           is_same_target(a, b) && !strcmp(a->name, b->name);
}

static virga_built *find_compute(const virga_context *context, const virga_compute_def *def)
{
    virga_built *found = context->first_built;
    while (found && (found->is_graphics || found->closed || !is_same_compute(&found->compute, def)))
        found = found->next;
    return found;
}

/* A build that waits reads the host's render pass, which ends with the target that asked for it. So a target of another
 * render pass does not wait for it. */
static virga_built *find_graphics(const virga_context *context, const virga_graphics_def *def)
{
    if (def->render_pass && !def->pass_class)
        return NULL;
    virga_built *found = context->first_built;
    while (found && (!found->is_graphics || found->closed ||
                     (!found->handle && found->graphics.render_pass != def->render_pass) ||
                     !is_same_graphics(&found->graphics, def)))
        found = found->next;
    return found;
}

/* Exactly one of the two definitions is given. */
static virga_result built_create(virga_context *context, const virga_compute_def *compute,
                                 const virga_graphics_def *graphics, virga_built **created)
{
    virga_built *built = virga_alloc(&context->heap, sizeof *built);
    if (!built)
        return virga_out_of_host_memory(context, compute ? compute->name : graphics->name);
    built->name = compute ? compute->name : graphics->name;
    built->is_graphics = graphics != NULL;
    if (graphics)
        built->graphics = *graphics;
    else
        built->compute = *compute;
    virga_layout_share(graphics ? graphics->layout : compute->layout);
    built->next = context->first_built;
    context->first_built = built;
    *created = built;
    return VIRGA_OK;
}

/* ---- uses of them */

static void stop_waiting(virga_pipeline *pipeline)
{
    virga_pipeline **at = &pipeline->built->waiting;
    while (*at && *at != pipeline)
        at = &(*at)->after;
    if (*at)
        *at = pipeline->after;
}

static void pipeline_destroy(virga_context *context, virga_resource *resource)
{
    virga_pipeline *pipeline = (virga_pipeline *)resource;
    stop_waiting(pipeline);
    if (!--pipeline->built->users)
        built_destroy(context, pipeline->built);
    virga_free(&context->heap, pipeline);
}

/* A new use of a pipeline that is built, or whose build was requested. If there is no memory for it, a pipeline without
 * users is destroyed. */
static virga_result use(virga_context *context, virga_built *built, virga_pipeline_group *group, const char *name,
                        virga_pipeline **created)
{
    virga_pipeline *pipeline = virga_alloc(&context->heap, sizeof *pipeline);
    if (!pipeline) {
        if (!built->users)
            built_destroy(context, built);
        return virga_out_of_host_memory(context, name);
    }
    built->users++;
    pipeline->resource.destroy = pipeline_destroy;
    pipeline->pipeline = built->handle;
    pipeline->name = name;
    pipeline->group = group;
    pipeline->built = built;
    pipeline->waits = !built->handle;
    if (pipeline->waits) {
        pipeline->after = built->waiting;
        built->waiting = pipeline;
        if (group && context->pipeline_build_mode != VIRGA_PIPELINES_ON_USE)
            group->waiting++;
    }
    *created = pipeline;
    return VIRGA_OK;
}

/* Builds or queues a new pipeline. If that fails, it is destroyed. */
static virga_result request(virga_context *context, virga_built *built, const virga_compute_def *compute,
                            const virga_graphics_def *graphics)
{
    const virga_result result = virga_build_request(context, built, compute, graphics);
    if (result)
        built_destroy(context, built);
    return result;
}

virga_result virga_compute_pipeline_create(virga_context *context, const virga_compute_def *def,
                                           virga_pipeline **pipeline)
{
    virga_built *built = find_compute(context, def);
    if (!built) {
        virga_result result = built_create(context, def, NULL, &built);
        if (!result)
            result = request(context, built, def, NULL);
        if (result)
            return result;
    }
    return use(context, built, def->group, def->name, pipeline);
}

/* ---- outputs at the locations of the target */

/* The locations in shaders/gpu/temporal.glsl. */
#define LOCATION_MOTION   1
#define LOCATION_REACTIVE 2

/* From the SPIR-V specification: length of the header, opcodes, a decoration and a storage class. */
enum { SPIRV_HEADER_WORDS = 5, OP_VARIABLE = 59, OP_DECORATE = 71, LOCATION = 30, OUTPUT = 3 };

static bool is_output(const uint32_t *code, size_t word_count, uint32_t id)
{
    for (size_t at = SPIRV_HEADER_WORDS; at < word_count; at += code[at] >> 16)
        if ((code[at] & 0xffff) == OP_VARIABLE && code[at + 2] == id)
            return code[at + 3] == OUTPUT;
    return false;
}

/* The host chooses the attachment of each output, but Vulkan can not specialise locations. So they are patched in the
 * SPIR-V. This needs no validation, because the SPIR-V is our own. */
static void move_outputs(const virga_graphics_def *def, uint32_t *code, size_t word_count)
{
    for (size_t at = SPIRV_HEADER_WORDS; at < word_count; at += code[at] >> 16) {
        if ((code[at] & 0xffff) != OP_DECORATE || code[at + 2] != LOCATION ||
            !is_output(code, word_count, code[at + 1]))
            continue;
        if (code[at + 3] == LOCATION_MOTION)
            code[at + 3] = def->motion_attachment;
        else if (code[at + 3] == LOCATION_REACTIVE)
            code[at + 3] = def->reactive_attachment;
    }
}

/* Builds or queues a new pipeline, with its outputs where the target has them. */
static virga_result create_graphics(virga_context *context, const virga_graphics_def *def, virga_built **created)
{
    virga_built *built = NULL;
    const virga_result result = built_create(context, NULL, def, &built);
    if (result)
        return result;
    virga_graphics_def changed = *def;
    if (def->motion_attachment || def->reactive_attachment) {
        const size_t size = def->fragment->size;
        built->code = virga_memdup(&context->heap, def->fragment->code, size);
        if (!built->code) {
            built_destroy(context, built);
            return virga_out_of_host_memory(context, def->name);
        }
        move_outputs(def, built->code, size / sizeof *built->code);
        built->patched = (virga_spirv){built->code, size};
        changed.fragment = &built->patched;
    }
    *created = built;
    return request(context, built, NULL, &changed);
}

virga_result virga_graphics_pipeline_create(virga_context *context, const virga_graphics_def *def,
                                            virga_pipeline **pipeline)
{
    virga_built *built = find_graphics(context, def);
    const virga_result result = built ? VIRGA_OK : create_graphics(context, def, &built);
    return result ? result : use(context, built, def->group, def->name, pipeline);
}
