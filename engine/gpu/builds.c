/* gpu/builds.c - when pipelines are built: at once, in steps of the host's choice, by the host's jobs, or on use.
 *
 * A waiting build holds a copy of its definition. Any thread may run it: it calls the device and writes only into the
 * build. The API's thread collects the result. So the context needs no lock: threads share only the state of a build:
 *
 *     WAITING -> RUNNING -> DONE -> collected          WAITING -> DROPPED -> DONE -> collected
 *
 * The second sequence is for a pipeline whose users were retired before its build began. The host's job keeps a pointer
 * to its build. So a dropped build is freed only after its job ran (and did nothing), or with the context. */
#include "gpu/builds.h"

#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/names.h"
#include "gpu/pipeline_build.h"
#include "gpu/pipelines.h"
#include "gpu/resources.h"

#include <stdatomic.h>

enum { WAITING, RUNNING, DROPPED, DONE };

typedef struct virga_build {
    struct virga_build *next;
    virga_context *context; /* read by jobs: its functions, device and pipeline cache, which never change */
    virga_built *owner;     /* NULL: abandoned */
    bool graphics;
    virga_compute_def compute_def;
    virga_graphics_def graphics_def;
    atomic_int state;
    VkPipeline made; /* from here on: written by the thread that runs the build, before DONE */
    VkResult result;
    const char *call;
} virga_build;

static VkResult make(const virga_context *context, const virga_compute_def *compute, const virga_graphics_def *graphics,
                     VkPipeline *made, const char **call)
{
    return compute ? virga_compute_build(context, compute, made, call)
                   : virga_graphics_build(context, graphics, made, call);
}

/* Run by the host as a job, or by virga_pipelines_build in steps. */
static void run(void *data)
{
    virga_build *build = data;
    int expected = WAITING;
    if (atomic_compare_exchange_strong(&build->state, &expected, RUNNING))
        build->result = make(build->context, build->graphics ? NULL : &build->compute_def, &build->graphics_def,
                             &build->made, &build->call);
    atomic_store(&build->state, DONE);
}

/* The device built it, or failed. */
static virga_result finish(virga_context *context, virga_built *built, VkResult made, VkPipeline handle,
                           const char *call)
{
    virga_free(&context->heap, built->code);
    built->code = NULL;
    built->closed = made != VK_SUCCESS;
    if (built->closed)
        return virga_vulkan_failed(context, made, call);
    built->handle = handle;
    context->objects++;
    virga_set_name(context, VK_OBJECT_TYPE_PIPELINE, (uint64_t)handle, built->name);
    return VIRGA_OK;
}

virga_result virga_build_request(virga_context *context, virga_built *built, const virga_compute_def *compute,
                                 const virga_graphics_def *graphics)
{
    if (context->pipeline_build_mode == VIRGA_PIPELINES_IMMEDIATE) {
        VkPipeline handle = VK_NULL_HANDLE;
        const char *call = NULL;
        const VkResult made = make(context, compute, graphics, &handle, &call);
        return finish(context, built, made, handle, call);
    }
    virga_build *build = virga_alloc(&context->heap, sizeof *build);
    if (!build)
        return virga_out_of_host_memory(context, built->name);
    build->context = context;
    build->owner = built;
    build->graphics = graphics != NULL;
    if (graphics)
        build->graphics_def = *graphics;
    else
        build->compute_def = *compute;
    atomic_init(&build->state, WAITING);
    built->build = build;
    virga_build **end = &context->builds;
    while (*end)
        end = &(*end)->next;
    *end = build;
    if (context->pipeline_build_mode == VIRGA_PIPELINES_AS_JOBS)
        context->pipeline_jobs.run(context->pipeline_jobs.user, run, build);
    return VIRGA_OK;
}

/* One that waits on use is built now. If that fails, the pipeline says why. */
static void build_now(const virga_pipeline *pipeline)
{
    virga_build *build = pipeline->built->build;
    if (pipeline->pipeline || !build || build->context->pipeline_build_mode != VIRGA_PIPELINES_ON_USE)
        return;
    run(build);
    virga_builds_collect(build->context);
}

VkPipeline virga_build_on_use(virga_context *context, const virga_pipeline *pipeline)
{
    build_now(pipeline);
    if (pipeline->failed)
        context->recording_failed = pipeline->failed;
    return pipeline->pipeline;
}

virga_result virga_pipelines_ready(const virga_pipeline *const *pipelines, uint32_t count)
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < count; i++) {
        build_now(pipelines[i]);
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

/* One that waited has its pipeline now. If it was retired meanwhile, its group may be gone. */
static void serve(const virga_context *context, virga_pipeline *pipeline, VkPipeline handle, virga_result result)
{
    pipeline->waits = false;
    pipeline->after = NULL;
    if (pipeline->resource.retired)
        return;
    pipeline->pipeline = handle;
    pipeline->failed = result;
    if (pipeline->group) {
        if (context->pipeline_build_mode != VIRGA_PIPELINES_ON_USE)
            pipeline->group->waiting--;
        if (result && !pipeline->group->failed)
            pipeline->group->failed = result;
    }
}

/* Moves the built pipeline to its owner, and serves all that wait for it. */
static virga_result hand_over(virga_context *context, virga_build *build)
{
    virga_built *built = build->owner;
    const virga_result result = finish(context, built, build->result, build->made, build->call);
    build->made = VK_NULL_HANDLE;
    built->build = NULL;
    while (built->waiting) {
        virga_pipeline *pipeline = built->waiting;
        built->waiting = pipeline->after;
        serve(context, pipeline, built->handle, result);
    }
    return result;
}

/* True if anybody still waits for it. */
static bool is_wanted(const virga_built *built)
{
    const virga_pipeline *pipeline = built->waiting;
    while (pipeline && pipeline->resource.retired)
        pipeline = pipeline->after;
    return pipeline != NULL;
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
        if (build->owner && !is_wanted(build->owner))
            virga_build_abandon(context, build->owner);
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

/* Without jobs there is no other pointer to the build, so it counts as run. */
static void drop(const virga_context *context, virga_build *build)
{
    int expected = WAITING;
    const bool ours = context->pipeline_build_mode != VIRGA_PIPELINES_AS_JOBS;
    atomic_compare_exchange_strong(&build->state, &expected, ours ? DONE : DROPPED);
}

void virga_build_abandon(virga_context *context, virga_built *built)
{
    if (!built->build)
        return;
    drop(context, built->build);
    built->build->owner = NULL;
    built->build = NULL;
    built->closed = true;
}

bool virga_builds_cancel_retired(virga_context *context)
{
    bool running = false;
    for (virga_build *build = context->builds; build; build = build->next) {
        if (build->owner && !is_wanted(build->owner))
            virga_build_abandon(context, build->owner);
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

/* Runs up to `max_count` of the waiting builds, in the order of the requests. */
static void run_some(const virga_context *context, uint32_t max_count)
{
    for (virga_build *build = context->builds; build && max_count; build = build->next)
        if (atomic_load(&build->state) == WAITING) {
            run(build);
            max_count--;
        }
}

virga_result virga_pipelines_build(virga_context *context, uint32_t max_count, uint32_t *remaining)
{
    if (remaining)
        *remaining = 0;
    if (!context)
        return VIRGA_ERROR_INVALID;
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (context->pipeline_build_mode == VIRGA_PIPELINES_DEFERRED ||
        context->pipeline_build_mode == VIRGA_PIPELINES_ON_USE)
        run_some(context, max_count);
    const virga_result result = virga_builds_collect(context);
    uint32_t count = 0;
    for (const virga_build *build = context->builds; build; build = build->next)
        count += build->owner && is_wanted(build->owner);
    if (remaining)
        *remaining = count;
    return result ? result : count ? VIRGA_NOT_READY : VIRGA_OK;
}
