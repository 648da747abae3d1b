/* calls_context.c - random calls of the functions of base.h, drops.h, light.h and vulkan.h. */
#include "calls.h"
#include "calls_list.h"

static void read_text(const calls *c, const char *name, const char *text)
{
    if (!text || !text[0])
        calls_wrong(c, name, "returned no text");
}

void call_virga_result_name(calls *c)
{
    read_text(c, __func__, virga_result_name((virga_result)((int)calls_below(c, 16) - 8)));
}

void call_virga_version(calls *c)
{
    read_text(c, __func__, virga_version());
}

void call_virga_log_name(calls *c)
{
    read_text(c, __func__, virga_log_name((virga_log_id)((int)calls_below(c, 40) - 4)));
}

/* ---- the device */

void call_virga_required_features(calls *c)
{
    uint32_t count = 0;
    if (!virga_required_features(calls_once_in(c, 2) ? &count : NULL))
        calls_wrong(c, __func__, "returned NULL");
}

void call_virga_enable_features(calls *c)
{
    VkPhysicalDeviceVulkan12Features of_1_2 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 chain = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    const bool whole = calls_once_in(c, 2);
    chain.pNext = whole ? &of_1_2 : NULL;
    const virga_result result = virga_enable_features(calls_once_in(c, 4) ? NULL : &chain);
    if (result > 0 || (result == VIRGA_OK && !whole))
        calls_wrong(c, __func__, "said OK to a chain that lacks a struct");
}

void call_virga_check_device(calls *c)
{
    char reason[64];
    virga_context_def def = {0};
    c->device->define(c, 0, &def);
    const size_t size = calls_below(c, sizeof reason + 1);
    const virga_result result =
        virga_check_device(calls_slip(c, 8) ? NULL : def.get_instance_proc_addr, calls_slip(c, 8) ? NULL : def.instance,
                           calls_slip(c, 8) ? NULL : def.physical_device, calls_once_in(c, 4) ? NULL : reason, size);
    if (result > 0)
        calls_wrong(c, __func__, "returned a remark");
}

/* ---- contexts */

static void log_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    calls *c = user;
    (void)level;
    c->lines++;
    snprintf(c->said, sizeof c->said, "%s: %s", virga_log_name(id), text);
    if (getenv("VIRGA_TEST_VERBOSE"))
        fprintf(stderr, "    %s\n", c->said);
}

static void *allocate(void *user, size_t size)
{
    calls *c = user;
    if (c->fail_alloc && !--c->fail_alloc)
        return NULL;
    uint64_t *memory = aligned_alloc(16, (size + 16 + 15) / 16 * 16);
    if (!memory)
        return NULL;
    memset(memory, 0x5a, size + 16); /* the library clears what it must */
    memory[0] = size;
    c->bytes += size;
    return memory + 2;
}

static void release(void *user, void *pointer)
{
    calls *c = user;
    uint64_t *memory = (uint64_t *)pointer - 2;
    c->bytes -= memory[0];
    free(memory);
}

static void run_job(void *user, void (*job)(void *data), void *data)
{
    (void)user;
    job(data);
}

void call_virga_default_context_def(calls *c)
{
    const virga_context_def def = virga_default_context_def();
    if (def.size != sizeof def)
        calls_wrong(c, __func__, "has the wrong size");
}

static void fill_context_def(calls *c, uint32_t index, virga_context_def *out)
{
    static const uint8_t blob[64] = {32, 0, 0, 0, 1};
    static const calls_member kept[] = {CALLS_KEPT(virga_context_def, instance),
                                        CALLS_KEPT(virga_context_def, physical_device),
                                        CALLS_KEPT(virga_context_def, device),
                                        CALLS_KEPT(virga_context_def, get_instance_proc_addr),
                                        CALLS_KEPT(virga_context_def, host_memory),
                                        CALLS_KEPT(virga_context_def, device_memory),
                                        CALLS_KEPT(virga_context_def, log),
                                        CALLS_KEPT(virga_context_def, log_user),
                                        CALLS_KEPT(virga_context_def, pipeline_cache),
                                        CALLS_KEPT(virga_context_def, pipeline_cache_size),
                                        CALLS_KEPT(virga_context_def, pipeline_jobs),
                                        CALLS_KEPT(virga_context_def, log_repeats),
                                        CALLS_BOOL(virga_context_def, strict),
                                        CALLS_BOOL(virga_context_def, wide_lines),
                                        CALLS_BOOL(virga_context_def, timings),
                                        CALLS_BOOL(virga_context_def, debug_names)};
    *out = virga_default_context_def();
    c->device->define(c, index, out);
    out->log = log_line;
    out->log_user = c;
    out->log_repeats = true;
    out->frames_in_flight = c->careful ? 3 : 1 + calls_below(c, 4);
    out->timings = !calls_once_in(c, 4);
    out->host_memory = (virga_host_memory){c, allocate, release};
    if (calls_once_in(c, 3))
        out->memory_budget = (VkDeviceSize)calls_below(c, 64) << 20;
    if (calls_once_in(c, 4)) {
        out->pipeline_cache = blob;
        out->pipeline_cache_size = calls_below(c, sizeof blob + 1);
    }
    out->pipeline_build_mode = (virga_pipeline_build_mode)calls_below(c, 4);
    if (out->pipeline_build_mode == VIRGA_PIPELINES_AS_JOBS)
        out->pipeline_jobs.run = run_job;
    out->variants = (virga_pass_variants)calls_below(c, 3);
    if (!c->device->honest && calls_once_in(c, 4))
        CALLS_WILD(c, out, kept);
}

void calls_make_context(calls *c, uint32_t index)
{
    virga_context_def def;
    virga_context *made = NULL;
    fill_context_def(c, index, &def);
    if (c->contexts[index])
        return;
    c->lost[index] = false;
    c->jobs[index] = def.pipeline_build_mode == VIRGA_PIPELINES_AS_JOBS;
    c->frames[index].begun = c->frames[index].completed = 0;
    const virga_result result = CALLS_TRY(c, index, CALLS_PLAIN, virga_context_create, &def, &made);
    if (!made != (result < 0))
        calls_wrong(c, __func__, "result and handle disagree");
    c->contexts[index] = made;
}

void call_virga_context_create(calls *c)
{
    const uint32_t index = calls_some_context(c);
    virga_context *made = (virga_context *)c;
    if (calls_once_in(c, 8))
        CALLS_TRY(c, index, CALLS_WRONG | CALLS_SILENT, virga_context_create, NULL, &made);
    else
        calls_make_context(c, index);
}

void call_virga_context_destroy(calls *c)
{
    const uint32_t index = calls_some_context(c);
    if (calls_once_in(c, 3))
        CALLS_DO(c, virga_context_destroy, NULL);
    if (!calls_slip(c, 20))
        return;
    c->device->begin(c, index); /* what was recorded goes out */
    c->device->wait(c, index);
    CALLS_DO(c, virga_context_destroy, &c->contexts[index]);
    if (c->contexts[index])
        calls_wrong(c, __func__, "the handle is not NULL");
    for (int type = 0; type < CALLS_TYPES; type++)
        for (int i = 0; i < CALLS_SLOTS; i++)
            if (c->handles[type][i].context == index && c->handles[type][i].object)
                c->handles[type][i].context = CALLS_GONE;
}

/* ---- frames */

void call_virga_frame_begin(calls *c)
{
    const uint32_t index = calls_some_context(c);
    virga_context *context = calls_slip(c, 30) ? NULL : c->contexts[index];
    calls_frames *f = &c->frames[index];
    if (!context) {
        CALLS_TRY(c, index, CALLS_WRONG | CALLS_SILENT, virga_frame_begin, NULL, 1, 0);
        return;
    }
    uint64_t frame = f->begun + 1 + (calls_slip(c, 10) ? calls_below(c, 3) : 0);
    uint64_t completed = f->begun > 1 && calls_once_in(c, 2) ? f->begun - 1 : f->begun;
    completed = completed < f->completed ? f->completed : completed;
    c->device->begin(c, index); /* submits or drops the last one */
    if (c->lies && calls_once_in(c, 5)) {
        frame = calls_below(c, 10);
        completed = calls_below(c, 10);
    } else if (completed == f->begun || completed) {
        c->device->wait(c, index);
    }
    if (CALLS_TRY(c, index, CALLS_PLAIN, virga_frame_begin, context, frame, completed) < 0) {
        /* The frame goes on in another command buffer. What is thrown away of it must be told: a prepare needs the step
         * before it. */
        if (c->thrown_away && f->begun > f->completed)
            virga_frame_dropped(context, f->begun);
        return;
    }
    f->begun = frame;
    f->completed = completed;
}

void call_virga_frame_completed(calls *c)
{
    const uint32_t index = calls_some_context(c);
    virga_context *context = calls_slip(c, 30) ? NULL : c->contexts[index];
    calls_frames *f = &c->frames[index];
    /* What is recorded now is not executed yet. */
    uint64_t completed = f->begun ? f->begun - 1 : 0;
    completed = completed < f->completed ? f->completed : completed;
    if (c->lies && calls_once_in(c, 3))
        completed = calls_below(c, 12);
    else
        c->device->wait(c, index);
    const uint32_t flags = context ? CALLS_PLAIN : CALLS_WRONG | CALLS_SILENT;
    if (CALLS_TRY(c, index, flags, virga_frame_completed, context, completed) >= 0)
        f->completed = completed;
}

void call_virga_frame_dropped(calls *c)
{
    const uint32_t index = calls_some_context(c);
    virga_context *context = calls_slip(c, 30) ? NULL : c->contexts[index];
    calls_frames *f = &c->frames[index];
    const uint32_t flags = context ? CALLS_PLAIN : CALLS_WRONG | CALLS_SILENT;
    const uint64_t frame = calls_once_in(c, 3) ? calls_below(c, 6) : f->begun;
    if (c->device->honest && (frame != f->begun || !f->open || c->device->inside(c, index)))
        return;
    if (CALLS_TRY(c, index, flags, virga_frame_dropped, context, frame) >= 0 && frame == f->begun)
        f->open = false; /* it must not be submitted, and nothing more goes into it */
}

void call_virga_frames_lost(calls *c)
{
    if (virga_frames_lost(calls_slip(c, 8) ? NULL : c->contexts[calls_some_context(c)]) > c->made)
        calls_wrong(c, __func__, "more frames than there were calls");
}

/* ---- pipelines, memory, timings */

void call_virga_pipelines_build(calls *c)
{
    const uint32_t index = calls_some_context(c);
    virga_context *context = calls_slip(c, 30) ? NULL : c->contexts[index];
    uint32_t left = 0;
    const uint32_t count = calls_once_in(c, 3) ? UINT32_MAX : calls_below(c, 40);
    const uint32_t flags = context ? CALLS_PLAIN : CALLS_WRONG | CALLS_SILENT;
    const virga_result result =
        CALLS_TRY(c, index, flags, virga_pipelines_build, context, count, calls_once_in(c, 4) ? NULL : &left);
    if (result == VIRGA_OK && left)
        calls_wrong(c, __func__, "said OK, and some are missing");
}

void call_virga_pipeline_cache_get(calls *c)
{
    const uint32_t index = calls_some_context(c);
    virga_context *context = calls_slip(c, 30) ? NULL : c->contexts[index];
    size_t size = calls_below(c, 100);
    char *data = calls_once_in(c, 3) ? NULL : malloc(size + 1);
    const bool wrong = !context || calls_once_in(c, 10);
    const uint32_t flags = wrong ? CALLS_WRONG | (context ? 0 : CALLS_SILENT) : CALLS_PLAIN;
    if (c->device->honest && data)
        size = 0;
    CALLS_TRY(c, index, flags, virga_pipeline_cache_get, context, wrong ? NULL : &size, data);
    free(data);
}

void call_virga_memory_get(calls *c)
{
    virga_memory_stats stats;
    const uint32_t index = calls_some_context(c);
    CALLS_DO(c, virga_memory_get, calls_slip(c, 8) ? NULL : c->contexts[index], calls_slip(c, 8) ? NULL : &stats);
}

void call_virga_timings_get(calls *c)
{
    virga_pass_time times[8];
    const uint32_t capacity = calls_below(c, 9);
    c->made++;
    const uint32_t count = virga_timings_get(calls_slip(c, 8) ? NULL : c->contexts[calls_some_context(c)],
                                             calls_slip(c, 8) ? NULL : times, capacity);
    if (count > 4096)
        calls_wrong(c, __func__, "has more passes than there are");
}

/* ---- targets */

void call_virga_default_target_def(calls *c)
{
    const virga_target_def def = virga_default_target_def();
    if (def.size != sizeof def)
        calls_wrong(c, __func__, "has the wrong size");
}

void call_virga_target_create(calls *c)
{
    const uint32_t index = calls_some_context(c);
    virga_context *context = calls_slip(c, 30) ? NULL : c->contexts[index];
    virga_target_def def;
    virga_target *made = NULL;
    calls_fill_target_def(c, &def);
    const bool wrong = !context || calls_slip(c, 20);
    const uint32_t flags = wrong ? CALLS_WRONG | (context ? 0 : CALLS_SILENT) : CALLS_PLAIN;
    const virga_result result =
        CALLS_TRY(c, index, flags, virga_target_create, context, wrong && context ? NULL : &def, &made);
    if (!made != (result < 0))
        calls_wrong(c, __func__, "result and handle disagree");
    calls_keep(c, CALLS_TARGET, index, made);
}

void call_virga_target_destroy(calls *c)
{
    if (calls_once_in(c, 3))
        CALLS_DO(c, virga_target_destroy, NULL);
    if (calls_once_in(c, 6))
        calls_destroy(c, CALLS_TARGET, &c->handles[CALLS_TARGET][calls_below(c, CALLS_SLOTS)].object);
}

void call_virga_default_view(calls *c)
{
    const virga_view view = virga_default_view();
    if (view.size != sizeof view)
        calls_wrong(c, __func__, "has the wrong size");
}

/* ---- drops and light: pure functions */

static void need_finite(const calls *c, const char *name, double value)
{
    if (!isfinite(value))
        calls_wrong(c, name, "is not finite");
}

#define PURE(name, ...)                           \
    void call_##name(calls *c)                    \
    {                                             \
        need_finite(c, #name, name(__VA_ARGS__)); \
    }

PURE(virga_drop_terminal_speed, calls_number(c, 0, 0.01), calls_number(c, 0, 2))
PURE(virga_drop_relaxation_time, calls_number(c, 0, 0.01), calls_number(c, 0, 2))
PURE(virga_drop_axis_ratio, calls_number(c, 0, 0.01))
PURE(virga_drop_oscillation_hz, calls_number(c, 0, 0.01))
PURE(virga_drop_volume, calls_number(c, 0, 0.01))
PURE(virga_drop_phase, calls_number(c, -1, 1))
PURE(virga_rain_extinction, calls_number(c, 0, 200))
PURE(virga_lens_breathing, calls_number(c, 0, 1), calls_number(c, 0, 10))

void call_virga_drop_phase_moments(calls *c)
{
    double moments[3];
    CALLS_DO(c, virga_drop_phase_moments, calls_slip(c, 8) ? NULL : moments);
}

void call_virga_sizes_density(calls *c)
{
    virga_sizes sizes;
    double diameters[4], numbers[4];
    calls_fill_sizes(c, &sizes, diameters, numbers);
    need_finite(c, __func__,
                virga_sizes_density(calls_slip(c, 12) ? NULL : &sizes, calls_number(c, 0, 200), calls_number(c, 0.3, 2),
                                    calls_number(c, 0, 0.01)));
}

void call_virga_sizes_landing_share(calls *c)
{
    virga_sizes sizes;
    double diameters[4], numbers[4];
    calls_fill_sizes(c, &sizes, diameters, numbers);
    need_finite(c, __func__,
                virga_sizes_landing_share(calls_slip(c, 12) ? NULL : &sizes, calls_number(c, 0, 200),
                                          calls_number(c, 0.3, 2), calls_number(c, 0, 0.01)));
}

void call_virga_sizes_densities(calls *c)
{
    virga_sizes sizes;
    double diameters[4], numbers[4], at[3], densities[3];
    calls_fill_sizes(c, &sizes, diameters, numbers);
    calls_doubles(c, at, 3, 0, 0.01);
    CALLS_TRY(c, 0, CALLS_SILENT, virga_sizes_densities, calls_slip(c, 12) ? NULL : &sizes, calls_number(c, 0, 200),
              calls_number(c, 0.3, 2), calls_below(c, 4), calls_slip(c, 8) ? NULL : at,
              calls_slip(c, 8) ? NULL : densities);
}

void call_virga_default_lighting(calls *c)
{
    const virga_lighting lighting = virga_default_lighting();
    if (lighting.light_count)
        calls_wrong(c, __func__, "has lamps");
}
