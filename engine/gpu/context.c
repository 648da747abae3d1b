/* gpu/context.c - creates the context on a host's device. */
#include "gpu/context.h"

#include "core/settings.h"
#include "gpu/builds.h"
#include "gpu/errors.h"
#include "gpu/functions.h"
#include "gpu/lanes.h"
#include "gpu/pipeline_cache.h"
#include "gpu/retire.h"
#include "gpu/timers.h"

#include <string.h>

#define LARGEST_POOL_TEXELS 33554432 /* lower bound: the largest pools hold 4194304 streaks or sprites of 5 texels */

virga_context_def virga_default_context_def(void)
{
    return (virga_context_def){.size = sizeof(virga_context_def),
                               .cookie = virga_settings_cookie("context_def"),
                               .frames_in_flight = 3,
                               .timings = true,
                               .debug_names = true};
}

static virga_result check_def(const virga_log *log, const virga_context_def *def)
{
    const virga_result result = virga_settings_check(log, "context_def", def->size, sizeof *def, def->cookie);
    if (result)
        return result;
    if (!def->instance || !def->physical_device || !def->device || !def->get_instance_proc_addr)
        return virga_wrong_argument(log, "context_def: instance, physical_device, device and get_instance_proc_addr "
                                         "are all required");
    if (def->frames_in_flight < 1 || def->frames_in_flight > VIRGA_MAX_FRAMES_IN_FLIGHT)
        return virga_wrong_argument(log, "context_def.frames_in_flight: expected 1 to %d, got %u",
                                    VIRGA_MAX_FRAMES_IN_FLIGHT, def->frames_in_flight);
    if (!def->device_memory.alloc != !def->device_memory.free)
        return virga_wrong_argument(log, "context_def.device_memory: expected both alloc and free, or neither");
    if ((uint32_t)def->pipeline_build_mode > VIRGA_PIPELINES_ON_USE)
        return virga_wrong_argument(log, "context_def.pipeline_build_mode: there is no %d",
                                    (int)def->pipeline_build_mode);
    if ((uint32_t)def->variants > VIRGA_VARIANTS_GPU)
        return virga_wrong_argument(log, "context_def.variants: there is no %d", (int)def->variants);
    if ((def->pipeline_build_mode == VIRGA_PIPELINES_AS_JOBS) != (def->pipeline_jobs.run != NULL))
        return virga_wrong_argument(log, "context_def.pipeline_jobs: expected run with VIRGA_PIPELINES_AS_JOBS, and "
                                         "without it none");
    return VIRGA_OK;
}

/* Checks the queue family: otherwise a wrong one would first fail at the first submit. Fills the number of valid bits
 * of its timestamps. */
static virga_result check_family(const virga_context *context, uint32_t family, uint32_t *timestamp_bits)
{
    const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    VkQueueFamilyProperties families[64];
    uint32_t count = 64;
    context->vk.GetPhysicalDeviceQueueFamilyProperties(context->physical_device, &count, families);
    if (family >= count || (families[family].queueFlags & both) != both)
        return virga_wrong_argument(&context->log, "context_def.queue_family: %u is none with graphics and compute",
                                    family);
    *timestamp_bits = families[family].timestampValidBits;
    return VIRGA_OK;
}

static virga_result check_lines(const virga_context *context, const virga_context_def *def)
{
    VkPhysicalDeviceFeatures2 there = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    context->vk.GetPhysicalDeviceFeatures2(def->physical_device, &there);
    if (!def->wide_lines || there.features.wideLines)
        return VIRGA_OK;
    return virga_wrong_argument(&context->log, "context_def.wide_lines: the device has no wideLines");
}

/* The one place that chooses between variants of passes, and how the log names the choice. */
static void choose_variants(virga_context *context, const virga_context_def *def)
{
    static const char *const names[2][2] = {{"passes for a GPU", "passes for a GPU as demanded"},
                                            {"passes for software Vulkan", "passes for software Vulkan as demanded"}};
    context->software = context->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    context->for_software =
        def->variants == VIRGA_VARIANTS_OF_DEVICE ? context->software : def->variants == VIRGA_VARIANTS_SOFTWARE;
    context->variants_name = names[context->for_software][def->variants != VIRGA_VARIANTS_OF_DEVICE];
    context->lines = def->wide_lines && context->for_software && context->properties.limits.strictLines;
}

uint32_t virga_shuffled_lanes(const virga_context *context)
{
    if (!context->for_software)
        return 0;
    VkPhysicalDeviceSubgroupProperties subgroup = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                              .pNext = &subgroup};
    context->vk.GetPhysicalDeviceProperties2(context->physical_device, &properties);
    const bool can = (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) &&
                     (subgroup.supportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT);
    return can ? subgroup.subgroupSize : 0;
}

static virga_result create_samplers(virga_context *context)
{
    virga_result result = VIRGA_OK;
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    VK_TRY(context, CreateSampler(context->device, &info, NULL, &context->nearest));
    context->objects++;
    info.magFilter = info.minFilter = VK_FILTER_LINEAR;
    VK_TRY(context, CreateSampler(context->device, &info, NULL, &context->linear));
    context->objects++;
error:
    return result;
}

static void destroy_objects(virga_context *context)
{
    virga_destroy_retired(context, true);
    virga_builds_free(context);
    const VkSampler samplers[2] = {context->nearest, context->linear};
    for (int i = 0; i < 2; i++)
        VIRGA_DESTROY(context, Sampler, samplers[i]);
    virga_timers_destroy(context);
    virga_lanes_destroy(context);
    VIRGA_DESTROY(context, PipelineCache, context->pipeline_cache);
}

/* The heap is a member of the context, which is allocated in it. So the heap is copied before it frees the context. */
static void free_context(virga_context *context)
{
    virga_host_heap heap = context->heap;
    virga_free(&heap, context);
}

static virga_result init(virga_context *context, const virga_context_def *def)
{
    virga_result result = VIRGA_OK;
    char reason[256];
    uint32_t timestamp_bits = 0;
    context->instance = def->instance;
    context->physical_device = def->physical_device;
    context->device = def->device;
    context->device_memory = def->device_memory;
    context->memory_budget = def->memory_budget;
    context->frames_in_flight = def->frames_in_flight;
    context->debug_names = def->debug_names;
    context->strict = def->strict;
    context->pipeline_build_mode = def->pipeline_build_mode;
    context->pipeline_jobs = def->pipeline_jobs;
    TRY(virga_functions_load_instance(&context->vk, &context->log, def->get_instance_proc_addr, def->instance));
    result =
        virga_check_device(def->get_instance_proc_addr, def->instance, def->physical_device, reason, sizeof reason);
    if (result) {
        virga_log_write(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_FEATURE_MISSING, "the device %s", reason);
        return result;
    }
    TRY(virga_functions_load_device(&context->vk, &context->log, def->device));
    context->vk.GetPhysicalDeviceProperties(def->physical_device, &context->properties);
    TRY(check_lines(context, def));
    choose_variants(context, def);
    /* The device alone decides, not the sizes of pools, so that a device has one variant of each pipeline. Desktop GPUs
     * allow 2^27 texels or more in a view, phones often only what Vulkan guarantees. */
    context->small_views = context->properties.limits.maxTexelBufferElements < LARGEST_POOL_TEXELS;
    context->vk.GetPhysicalDeviceMemoryProperties(def->physical_device, &context->memory_properties);
    TRY(virga_pipeline_cache_create(context, def->pipeline_cache, def->pipeline_cache_size));
    TRY(check_family(context, def->queue_family, &timestamp_bits));
    TRY(virga_timers_create(context, def->timings ? timestamp_bits : 0));
    TRY(create_samplers(context));
error:
    return result;
}

virga_result virga_context_create(const virga_context_def *def, virga_context **context)
{
    if (context)
        *context = NULL;
    if (!def || !context)
        return VIRGA_ERROR_INVALID;
    const virga_log log = {def->log, def->log_user};
    virga_result result = check_def(&log, def);
    if (result)
        return result;
    virga_host_heap heap;
    if (virga_host_heap_init(&heap, &def->host_memory))
        return virga_wrong_argument(&log, "context_def.host_memory: expected both alloc and free, or neither");
    virga_context *made = virga_alloc(&heap, sizeof *made);
    if (!made) {
        virga_log_write(&log, VIRGA_LOG_ERROR, VIRGA_LOG_HOST_MEMORY, "no host memory for a context");
        return VIRGA_ERROR_HOST_MEMORY;
    }
    made->heap = heap;
    made->host_log = log;
    made->log = def->log_repeats ? log : (virga_log){virga_repeats_log, made};
    result = init(made, def);
    if (result) {
        if (made->vk.DestroyPipelineCache)
            destroy_objects(made);
        free_context(made);
        return result;
    }
    virga_log_write(&log, VIRGA_LOG_INFO, VIRGA_LOG_CREATED, "context on %s%s, %s, %u frames in flight",
                    made->properties.deviceName, made->software ? ", software Vulkan without a GPU" : "",
                    made->variants_name, made->frames_in_flight);
    *context = made;
    return VIRGA_OK;
}

static void end(virga_context *context)
{
    destroy_objects(context);
    free_context(context);
}

void virga_context_destroy(virga_context **context)
{
    if (!context || !*context)
        return;
    virga_context *object = *context;
    *context = NULL;
    object->closed = true;
    if (!object->members) {
        end(object);
        return;
    }
    virga_log_write(&object->log, VIRGA_LOG_ERROR, VIRGA_LOG_LIVE_OBJECTS,
                    "virga_context_destroy: %u effects, targets and scenes of it still exist: destroy them first; the "
                    "context ends with the last one",
                    object->members);
    object->lost = true; /* calls on them are refused from now on */
}

virga_result virga_context_check_create(virga_context *context, bool complete, const char *call)
{
    if (!context || !complete)
        return virga_wrong_argument(context ? &context->log : NULL, "%s: NULL argument", call);
    return context->lost ? VIRGA_ERROR_DEVICE_LOST : VIRGA_OK;
}

void virga_context_join(virga_context *context)
{
    context->members++;
}

void virga_context_leave(virga_context *context)
{
    if (!--context->members && context->closed)
        end(context);
}

void virga_memory_get(const virga_context *context, virga_memory_stats *stats)
{
    if (!stats)
        return;
    memset(stats, 0, sizeof *stats);
    if (!context)
        return;
    *stats = (virga_memory_stats){.device_bytes = context->device_bytes,
                                  .device_used = context->device_used,
                                  .device_allocations = context->device_allocations,
                                  .objects = context->objects,
                                  .host_bytes = context->heap.live_bytes,
                                  .host_allocations = (uint32_t)context->heap.live_count};
}
