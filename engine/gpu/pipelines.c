/* gpu/pipelines.c - compute and graphics pipelines from embedded SPIR-V: creates them, and destroys them. */
#include "gpu/pipelines.h"

#include "gpu/builds.h"
#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/retire.h"

#include <string.h>

static void pipeline_destroy(virga_context *context, virga_resource *resource)
{
    virga_pipeline *pipeline = (virga_pipeline *)resource;
    virga_build_abandon(context, pipeline);
    virga_free(&context->heap, pipeline->code);
    VIRGA_DESTROY(context, Pipeline, pipeline->pipeline);
    virga_free(&context->heap, pipeline);
}

/* Builds or queues a pipeline with that name. Owns `code` from now on; the definition may point to it. */
static virga_result pipeline_create(virga_context *context, const char *name, virga_pipeline_group *group,
                                    const virga_compute_def *compute, const virga_graphics_def *graphics,
                                    uint32_t *code, virga_pipeline **created)
{
    virga_pipeline *pipeline = virga_alloc(&context->heap, sizeof *pipeline);
    if (!pipeline) {
        virga_free(&context->heap, code);
        return virga_out_of_host_memory(context, name);
    }
    pipeline->code = code;
    pipeline->resource.destroy = pipeline_destroy;
    pipeline->name = name;
    pipeline->group = group;
    const virga_result result = virga_build_request(context, pipeline, compute, graphics);
    if (result)
        pipeline_destroy(context, &pipeline->resource);
    else
        *created = pipeline;
    return result;
}

virga_result virga_compute_pipeline_create(virga_context *context, const virga_compute_def *def,
                                           virga_pipeline **pipeline)
{
    return pipeline_create(context, def->name, def->group, def, NULL, NULL, pipeline);
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

virga_result virga_graphics_pipeline_create(virga_context *context, const virga_graphics_def *def,
                                            virga_pipeline **pipeline)
{
    virga_graphics_def changed = *def;
    uint32_t *code = NULL;
    if (def->motion_attachment || def->reactive_attachment) {
        code = virga_memdup(&context->heap, def->fragment.code, def->fragment.size);
        if (!code)
            return virga_out_of_host_memory(context, def->name);
        move_outputs(def, code, def->fragment.size / sizeof *code);
        changed.fragment.code = code;
    }
    return pipeline_create(context, def->name, def->group, NULL, &changed, code, pipeline);
}
