/* gpu/context.c - takes a host's device into use, and moves with its frames. */
#include "gpu/context.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define CONTEXT_COOKIE VIRGA_COOKIE(1)

/* ---- results and their lines */

static const char *vulkan_result_name(VkResult result)
{
    switch (result) {
#define NAME(value)    \
    case value: {      \
        return #value; \
    }
        NAME(VK_SUCCESS)
        NAME(VK_NOT_READY)
        NAME(VK_TIMEOUT)
        NAME(VK_INCOMPLETE)
        NAME(VK_ERROR_OUT_OF_HOST_MEMORY)
        NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        NAME(VK_ERROR_INITIALIZATION_FAILED)
        NAME(VK_ERROR_DEVICE_LOST)
        NAME(VK_ERROR_MEMORY_MAP_FAILED)
        NAME(VK_ERROR_FEATURE_NOT_PRESENT)
        NAME(VK_ERROR_TOO_MANY_OBJECTS)
        NAME(VK_ERROR_FORMAT_NOT_SUPPORTED)
        NAME(VK_ERROR_FRAGMENTED_POOL)
        NAME(VK_ERROR_OUT_OF_POOL_MEMORY)
        NAME(VK_ERROR_UNKNOWN)
#undef NAME
    default: {
        return "another VkResult";
    }
    }
}

virga_result virga_vulkan_failed(virga_context *context, VkResult result, const char *call)
{
    if (result == VK_ERROR_DEVICE_LOST) {
        if (!context->lost)
            virga_log_say(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_DEVICE_LOST, "the device is lost, said %.100s",
                          call);
        context->lost = true;
        return VIRGA_ERROR_DEVICE_LOST;
    }
    virga_log_say(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_VULKAN_CALL, "%s (%d) from %.300s",
                  vulkan_result_name(result), (int)result, call);
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY)
        return VIRGA_ERROR_HOST_MEMORY;
    return result == VK_ERROR_OUT_OF_DEVICE_MEMORY ? VIRGA_ERROR_DEVICE_MEMORY : VIRGA_ERROR_VULKAN;
}

virga_result virga_out_of_host_memory(virga_context *context, const char *what)
{
    virga_log_say(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_HOST_MEMORY, "no host memory for %s", what);
    return VIRGA_ERROR_HOST_MEMORY;
}

virga_result virga_wrong_argument(const virga_log *log, const char *format, ...)
{
    char line[VIRGA_LOG_LINE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    virga_log_say(log, VIRGA_LOG_ERROR, VIRGA_LOG_ARGUMENT, "%s", line);
    return VIRGA_ERROR_INVALID;
}

virga_result virga_not_drawn(virga_context *context, const char *call, bool attached, virga_result ready, bool *told)
{
    if (ready == VIRGA_OK && !*told) {
        virga_log_say(&context->log, VIRGA_LOG_WARNING, VIRGA_LOG_NOT_DRAWN, "%s: %s", call,
                      attached ? "nothing was prepared in this frame" : "the target was not attached");
        *told = true;
    }
    return VIRGA_NOT_READY;
}

/* Numbers of ticks wrap around, after years. */
virga_result virga_ticks_check(const virga_log *log, uint32_t first, uint32_t ticks, const uint32_t *last)
{
    if (!ticks || !last || (int32_t)(first - *last) > 0)
        return VIRGA_OK;
    virga_log_say(log, VIRGA_LOG_ERROR, VIRGA_LOG_FRAME_ORDER,
                  "step_info.first_tick: %u after %u, expected one behind it", first, *last);
    return VIRGA_ERROR_INVALID;
}

/* ---- create and destroy */

virga_context_def virga_default_context_def(void)
{
    return (virga_context_def){.size = sizeof(virga_context_def),
                               .cookie = CONTEXT_COOKIE,
                               .frames_in_flight = 3,
                               .timings = true,
                               .debug_names = true};
}

static virga_result check_def(const virga_log *log, const virga_context_def *def)
{
    const virga_result result =
        virga_settings_check(log, "context_def", def->size, sizeof *def, def->cookie, CONTEXT_COOKIE);
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
    if ((uint32_t)def->pipelines > VIRGA_PIPELINES_AS_JOBS)
        return virga_wrong_argument(log, "context_def.pipelines: there is no %d", (int)def->pipelines);
    if ((def->pipelines == VIRGA_PIPELINES_AS_JOBS) != (def->pipeline_jobs.run != NULL))
        return virga_wrong_argument(log, "context_def.pipeline_jobs: expected run with VIRGA_PIPELINES_AS_JOBS, and "
                                         "without it none");
    return VIRGA_OK;
}

/* Out of range it would be found out at the first submit only. */
static virga_result check_family(const virga_context *context, uint32_t family, const VkQueueFamilyProperties *families,
                                 uint32_t count)
{
    const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    if (family < count && (families[family].queueFlags & both) == both)
        return VIRGA_OK;
    return virga_wrong_argument(&context->log, "context_def.queue_family: %u is none with graphics and compute",
                                family);
}

static virga_result check_lines(const virga_context *context, const virga_context_def *def)
{
    VkPhysicalDeviceFeatures2 there = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    context->vk.GetPhysicalDeviceFeatures2(def->physical_device, &there);
    if (!def->wide_lines || there.features.wideLines)
        return VIRGA_OK;
    return virga_wrong_argument(&context->log, "context_def.wide_lines: the device has no wideLines");
}

static virga_result create_timers(virga_context *context, const virga_context_def *def)
{
    virga_result result = VIRGA_OK;
    VkQueueFamilyProperties families[64];
    uint32_t count = 64;
    context->vk.GetPhysicalDeviceQueueFamilyProperties(context->physical_device, &count, families);
    result = check_family(context, def->queue_family, families, count);
    if (result)
        return result;
    const uint32_t bits = families[def->queue_family].timestampValidBits;
    context->timings = def->timings && bits > 0;
    if (!context->timings)
        return VIRGA_OK;
    context->timestamp_mask = bits >= 64 ? UINT64_MAX : (UINT64_C(1) << bits) - 1;
    context->timestamp_ns = (double)context->properties.limits.timestampPeriod;
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = VIRGA_MAX_QUERIES};
    for (uint32_t i = 0; i < context->frames_in_flight; i++) {
        VK_TRY(context, CreateQueryPool(context->device, &info, NULL, &context->timers[i].pool));
        context->objects++;
    }
error:
    return result;
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
    virga_graveyard_sweep(context, true);
    virga_builds_free(context);
    const VkSampler samplers[2] = {context->nearest, context->linear};
    for (int i = 0; i < 2; i++)
        if (samplers[i]) {
            context->vk.DestroySampler(context->device, samplers[i], NULL);
            context->objects--;
        }
    for (uint32_t i = 0; i < VIRGA_MAX_FRAMES_IN_FLIGHT; i++)
        if (context->timers[i].pool) {
            context->vk.DestroyQueryPool(context->device, context->timers[i].pool, NULL);
            context->objects--;
        }
    if (context->pipeline_cache) {
        context->vk.DestroyPipelineCache(context->device, context->pipeline_cache, NULL);
        context->objects--;
    }
}

/* The context lives in its own heap, whose struct is inside it: take a copy of the heap to free it with. */
static void free_context(virga_context *context)
{
    virga_host_heap heap = context->heap;
    virga_free(&heap, context);
}

static virga_result init(virga_context *context, const virga_context_def *def)
{
    virga_result result = VIRGA_OK;
    char reason[256];
    context->instance = def->instance;
    context->physical_device = def->physical_device;
    context->device = def->device;
    context->device_memory = def->device_memory;
    context->memory_budget = def->memory_budget;
    context->frames_in_flight = def->frames_in_flight;
    context->debug_names = def->debug_names;
    context->pipelines_when = def->pipelines;
    context->pipeline_jobs = def->pipeline_jobs;
    TRY(virga_functions_load_instance(&context->vk, &context->log, def->get_instance_proc_addr, def->instance));
    result =
        virga_check_device(def->get_instance_proc_addr, def->instance, def->physical_device, reason, sizeof reason);
    if (result) {
        virga_log_say(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_FEATURE_MISSING, "the device %s", reason);
        return result;
    }
    TRY(virga_functions_load_device(&context->vk, &context->log, def->device));
    context->vk.GetPhysicalDeviceProperties(def->physical_device, &context->properties);
    context->software = context->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    TRY(check_lines(context, def));
    context->lines = def->wide_lines && context->software && context->properties.limits.strictLines;
    /* By the device alone and not by what is asked of it, so that it has one kind of pipelines. GPUs of desktops have
     * 2^27 texels or more in a view, those of phones often what is promised. */
    context->small_views = context->properties.limits.maxTexelBufferElements < VIRGA_MOST_TEXELS;
    context->vk.GetPhysicalDeviceMemoryProperties(def->physical_device, &context->memory_properties);
    TRY(virga_pipeline_cache_create(context, def->pipeline_cache, def->pipeline_cache_size));
    TRY(create_timers(context, def));
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
        virga_log_say(&log, VIRGA_LOG_ERROR, VIRGA_LOG_HOST_MEMORY, "no host memory for a context");
        return VIRGA_ERROR_HOST_MEMORY;
    }
    made->heap = heap;
    made->log = log;
    result = init(made, def);
    if (result) {
        if (made->vk.DestroyPipelineCache)
            destroy_objects(made);
        free_context(made);
        return result;
    }
    virga_log_say(&log, VIRGA_LOG_INFO, VIRGA_LOG_CREATED, "context on %s, %u frames in flight",
                  made->properties.deviceName, made->frames_in_flight);
    *context = made;
    return VIRGA_OK;
}

void virga_context_destroy(virga_context **context)
{
    if (!context || !*context)
        return;
    virga_context *dying = *context;
    if (dying->effects)
        virga_log_say(&dying->log, VIRGA_LOG_ERROR, VIRGA_LOG_LIVE_OBJECTS,
                      "%u effects are alive while their context is destroyed; destroy them first", dying->effects);
    destroy_objects(dying);
    free_context(dying);
    *context = NULL;
}

/* ---- frames */

virga_result virga_frame_begin(virga_context *context, uint64_t frame_index, uint64_t completed_index)
{
    if (!context)
        return VIRGA_ERROR_INVALID;
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (frame_index <= context->frame_index || completed_index >= frame_index ||
        completed_index < context->completed_index) {
        virga_log_say(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_FRAME_ORDER,
                      "frame %llu after %llu with %llu completed: indices start at 1 and rise, and completed is behind",
                      (unsigned long long)frame_index, (unsigned long long)context->frame_index,
                      (unsigned long long)completed_index);
        return VIRGA_ERROR_INVALID;
    }
    if (frame_index - completed_index > context->frames_in_flight) {
        virga_log_say(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_FRAME_ORDER,
                      "frame %llu with %llu completed: more than %u frames in flight", (unsigned long long)frame_index,
                      (unsigned long long)completed_index, context->frames_in_flight);
        return VIRGA_ERROR_INVALID;
    }
    context->frame_index = frame_index;
    context->completed_index = completed_index;
    context->ring_slot = (uint32_t)(frame_index % context->frames_in_flight);
    virga_builds_collect(context); /* a failure is its effect's to say */
    virga_graveyard_sweep(context, false);
    virga_timer_slot *slot = &context->timers[context->ring_slot];
    const virga_result result = virga_timers_collect(context, slot);
    slot->count = 0;
    slot->reset = false;
    return result;
}

virga_result virga_frame_completed(virga_context *context, uint64_t completed_index)
{
    if (!context)
        return VIRGA_ERROR_INVALID;
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (completed_index < context->completed_index || completed_index > context->frame_index) {
        virga_log_say(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_FRAME_ORDER,
                      "frame %llu said to be complete, between %llu and %llu expected",
                      (unsigned long long)completed_index, (unsigned long long)context->completed_index,
                      (unsigned long long)context->frame_index);
        return VIRGA_ERROR_INVALID;
    }
    virga_result result = VIRGA_OK;
    context->completed_index = completed_index;
    for (uint32_t i = 0; i < context->frames_in_flight && result >= 0; i++)
        if (context->timers[i].count && context->timers[i].frame_index <= completed_index) {
            const virga_result collected = virga_timers_collect(context, &context->timers[i]);
            result = collected ? collected : result;
            context->timers[i].count = 0;
            context->timers[i].reset = false;
        }
    return result;
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
