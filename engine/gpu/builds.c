/* gpu/builds.c - when pipelines are built: at once, in steps of the host's choice, or by the host's jobs.
 *
 * A build that waits holds a copy of its definition. Whoever runs it, on whatever thread, calls the device and writes
 * into the build alone; the thread of the API takes the result over when it collects. So the context needs no lock:
 * what threads share of a build is its state, which moves
 *
 *     WAITING -> RUNNING -> DONE -> collected          WAITING -> DROPPED -> DONE -> collected
 *
 * where the second way is that of a pipeline let go of before its turn. A job that the host has been given keeps a
 * pointer to its build, so that a dropped one is freed only after its job was run (and did nothing), or with the
 * context. */
#include "gpu/context.h"

#include <stdatomic.h>

enum { WAITING, RUNNING, DROPPED, DONE };

typedef struct virga_build {
    struct virga_build *next;
    virga_context *context; /* read by jobs: its functions, device and pipeline cache, which never change */
    virga_pipeline *owner;  /* NULL: let go of */
    bool graphics;
    virga_compute_def compute_def;
    virga_graphics_def graphics_def;
    atomic_int state;
    VkPipeline made; /* from here on: written by who runs it, before it is DONE */
    VkResult result;
    const char *call;
} virga_build;

static VkResult make(const virga_context *context, const virga_compute_def *compute, const virga_graphics_def *graphics,
                     VkPipeline *made, const char **call)
{
    return compute ? virga_compute_build(context, compute, made, call)
                   : virga_graphics_build(context, graphics, made, call);
}

/* What the host runs as a job, and virga_pipelines_build in steps. */
static void run(void *data)
{
    virga_build *build = data;
    int expected = WAITING;
    if (atomic_compare_exchange_strong(&build->state, &expected, RUNNING))
        build->result = make(build->context, build->graphics ? NULL : &build->compute_def, &build->graphics_def,
                             &build->made, &build->call);
    atomic_store(&build->state, DONE);
}

/* The device made it, or did not. */
static virga_result finish(virga_context *context, virga_pipeline *pipeline, VkResult made, VkPipeline handle,
                           const char *call)
{
    virga_free(&context->heap, pipeline->code);
    pipeline->code = NULL;
    if (made != VK_SUCCESS)
        return pipeline->failed = virga_vulkan_failed(context, made, call);
    pipeline->pipeline = handle;
    context->objects++;
    virga_set_name(context, VK_OBJECT_TYPE_PIPELINE, (uint64_t)handle, pipeline->name);
    return VIRGA_OK;
}

virga_result virga_pipeline_ask(virga_context *context, virga_pipeline *pipeline, const virga_compute_def *compute,
                                const virga_graphics_def *graphics)
{
    if (context->pipelines_when == VIRGA_PIPELINES_AT_ONCE) {
        VkPipeline handle = VK_NULL_HANDLE;
        const char *call = NULL;
        const VkResult made = make(context, compute, graphics, &handle, &call);
        return finish(context, pipeline, made, handle, call);
    }
    virga_build *build = virga_alloc(&context->heap, sizeof *build);
    if (!build)
        return virga_out_of_host_memory(context, pipeline->name);
    build->context = context;
    build->owner = pipeline;
    build->graphics = graphics != NULL;
    if (graphics)
        build->graphics_def = *graphics;
    else
        build->compute_def = *compute;
    atomic_init(&build->state, WAITING);
    pipeline->build = build;
    if (pipeline->group)
        pipeline->group->waiting++;
    virga_build **end = &context->builds;
    while (*end)
        end = &(*end)->next;
    *end = build;
    if (context->pipelines_when == VIRGA_PIPELINES_AS_JOBS)
        context->pipeline_jobs.run(context->pipeline_jobs.user, run, build);
    return VIRGA_OK;
}

virga_result virga_pipelines_ready(const virga_pipeline *const *pipelines, uint32_t count)
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < count; i++) {
        if (pipelines[i]->failed)
            return pipelines[i]->failed;
        result = pipelines[i]->pipeline ? result : VIRGA_NOT_READY;
    }
    return result;
}

virga_result virga_group_ready(const virga_pipeline_group *group)
{
    return group->failed ? group->failed : group->waiting ? VIRGA_NOT_READY : VIRGA_OK;
}

/* The owner gets what was built for it. */
static virga_result hand_over(virga_context *context, virga_build *build)
{
    virga_pipeline *pipeline = build->owner;
    const virga_result result = finish(context, pipeline, build->result, build->made, build->call);
    build->made = VK_NULL_HANDLE;
    pipeline->build = NULL;
    if (pipeline->group) {
        pipeline->group->waiting--;
        if (result && !pipeline->group->failed)
            pipeline->group->failed = result;
    }
    return result;
}

virga_result virga_builds_collect(virga_context *context)
{
    virga_result first = VIRGA_OK;
    virga_build **at = &context->builds;
    while (*at) {
        virga_build *build = *at;
        if (atomic_load(&build->state) != DONE) {
            at = &build->next;
            continue;
        }
        if (build->owner && build->owner->resource.retired)
            virga_build_disown(context, build->owner);
        if (build->owner) {
            const virga_result result = hand_over(context, build);
            first = first ? first : result;
        }
        if (build->made)
            context->vk.DestroyPipeline(context->device, build->made, NULL);
        *at = build->next;
        virga_free(&context->heap, build);
    }
    return first;
}

/* Without jobs nobody else knows of a build, so that one nobody wants is as good as run. */
static void drop(const virga_context *context, virga_build *build)
{
    int expected = WAITING;
    const bool ours = context->pipelines_when != VIRGA_PIPELINES_AS_JOBS;
    atomic_compare_exchange_strong(&build->state, &expected, ours ? DONE : DROPPED);
}

void virga_build_disown(virga_context *context, virga_pipeline *pipeline)
{
    if (!pipeline->build)
        return;
    drop(context, pipeline->build);
    pipeline->build->owner = NULL;
    pipeline->build = NULL;
}

bool virga_builds_hold(virga_context *context)
{
    bool running = false;
    for (virga_build *build = context->builds; build; build = build->next) {
        if (!build->owner || build->owner->resource.retired)
            drop(context, build);
        running = running || atomic_load(&build->state) == RUNNING;
    }
    return running;
}

void virga_builds_free(virga_context *context)
{
    while (context->builds) {
        virga_build *build = context->builds;
        context->builds = build->next;
        if (build->made)
            context->vk.DestroyPipeline(context->device, build->made, NULL);
        virga_free(&context->heap, build);
    }
}

/* Runs up to `most` of those that wait, in the order they were asked for. */
static void run_some(const virga_context *context, uint32_t most)
{
    for (virga_build *build = context->builds; build && most; build = build->next)
        if (atomic_load(&build->state) == WAITING) {
            run(build);
            most--;
        }
}

virga_result virga_pipelines_build(virga_context *context, uint32_t most, uint32_t *left)
{
    if (left)
        *left = 0;
    if (!context)
        return VIRGA_ERROR_INVALID;
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (context->pipelines_when == VIRGA_PIPELINES_IN_STEPS)
        run_some(context, most);
    const virga_result result = virga_builds_collect(context);
    uint32_t count = 0;
    for (const virga_build *build = context->builds; build; build = build->next)
        count += build->owner && !build->owner->resource.retired;
    if (left)
        *left = count;
    return result ? result : count ? VIRGA_NOT_READY : VIRGA_OK;
}
