/* gpu/effect.c - the lifetime of an effect: estimates, creates within the memory budget, initialises, destroys. */
#include "gpu/effect.h"

#include "core/light.h"
#include "core/memory.h"
#include "gpu/budget.h"
#include "gpu/builds.h"
#include "gpu/context.h"
#include "gpu/errors.h"

#include <string.h>

typedef VkDeviceSize effect_counts[VIRGA_EFFECT_MAX_COUNTS];

static void fill_counts(const virga_effect_type *type, const void *def, effect_counts counts)
{
    memset(counts, 0, sizeof(effect_counts));
    counts[VIRGA_COUNT_ONE] = 1;
    if (type->count)
        type->count(def, counts);
}

static const void *def_of(const virga_effect *effect)
{
    return virga_effect_member(effect, effect->type->def.member);
}

void virga_effect_counts(const virga_effect *effect, effect_counts counts)
{
    fill_counts(effect->type, def_of(effect), counts);
}

static VkDeviceSize buffer_bytes(const virga_effect_buffer *row, const effect_counts counts)
{
    return row->head + row->entry * counts[row->count];
}

static uint32_t views_of(const virga_effect_type *type, const void *def)
{
    const uint32_t *views = (const void *)((const char *)def + type->max_views);
    return type->max_views ? *views : 1;
}

static VkDeviceSize ring_bytes(const virga_effect_ring *row, const effect_counts counts, uint32_t frames)
{
    return row->block * counts[row->count] * frames;
}

/* ---- definitions and settings */

static void fill_defaults(const virga_effect_struct *kind, void *out)
{
    uint32_t *head = out;
    memset(out, 0, kind->size);
    head[0] = kind->size;
    head[1] = virga_settings_cookie(kind->name);
    virga_settings_fill(kind->rows, kind->row_count, out);
}

void virga_effect_default_def(const virga_effect_type *type, void *def)
{
    fill_defaults(&type->def, def);
}

static virga_lighting *lighting_of(const virga_effect_type *type, void *settings)
{
    return (virga_lighting *)(void *)((char *)settings + type->lighting);
}

void virga_effect_default_settings(const virga_effect_type *type, void *settings)
{
    fill_defaults(&type->settings, settings);
    if (type->lighting)
        *lighting_of(type, settings) = virga_default_lighting();
    if (type->fill_settings)
        type->fill_settings(settings);
}

/* Copies a struct whose size and cookie are right, and applies its rows to the copy. */
static virga_result copy_checked(const virga_log *log, const virga_effect_struct *kind, const void *given, void *copy,
                                 bool *changed)
{
    const uint32_t *head = given;
    const virga_result result = virga_settings_check(log, kind->name, head[0], kind->size, head[1]);
    if (result)
        return result;
    memcpy(copy, given, kind->size);
    return virga_settings_apply_rows(log, kind->rows, kind->row_count, copy, changed);
}

static virga_result check_def(const virga_log *log, const virga_effect_type *type, const void *given, void *def)
{
    const virga_result result = copy_checked(log, &type->def, given, def, NULL);
    return !result && type->check_def ? type->check_def(log, def) : result;
}

/* ---- estimate */

VkDeviceSize virga_texel_bytes(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R8_UINT:
    case VK_FORMAT_R8_UNORM: return 1;
    case VK_FORMAT_R16G16B16A16_SFLOAT: return 8;
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT: return 16;
    default: return 4;
    }
}

static VkDeviceSize image_bytes(const virga_effect_image *row, const effect_counts counts)
{
    return counts[row->width] * counts[row->height] * (row->layers ? row->layers : 1) * virga_texel_bytes(row->format);
}

VkDeviceSize virga_effect_estimate(const virga_effect_type *type, const void *given)
{
    _Alignas(16) char def[VIRGA_EFFECT_MAX_DEF];
    effect_counts counts;
    if (!given || check_def(NULL, type, given, def))
        return 0;
    fill_counts(type, def, counts);
    const uint32_t views = views_of(type, def);
    VkDeviceSize sum = VIRGA_JOURNAL_BYTES + (VkDeviceSize)type->readback_bytes * VIRGA_MAX_FRAMES_IN_FLIGHT;
    for (uint32_t i = 0; i < type->buffer_count; i++)
        sum += buffer_bytes(&type->buffers[i], counts) * (type->buffers[i].per_view ? views : 1);
    for (uint32_t i = 0; i < type->ring_count; i++)
        sum += ring_bytes(&type->rings[i], counts, VIRGA_MAX_FRAMES_IN_FLIGHT);
    for (uint32_t i = 0; i < type->image_count; i++)
        sum += image_bytes(&type->images[i], counts) * (type->images[i].per_view ? views : 1);
    return sum + (type->extra_bytes ? type->extra_bytes(def) : 0);
}

/* ---- create */

static virga_result create_buffers(virga_effect *effect, const effect_counts counts)
{
    const virga_effect_type *type = effect->type;
    virga_context *context = effect->context;
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < type->buffer_count; i++) {
        const virga_effect_buffer *row = &type->buffers[i];
        const VkDeviceSize size = buffer_bytes(row, counts);
        for (uint32_t k = 0; size && k < virga_effect_copies(effect, row->per_view); k++)
            TRY(virga_buffer_create(context, size, row->usage, row->heap, row->name,
                                    virga_effect_copy(effect, row->member, row->per_view, k)));
    }
    for (uint32_t i = 0; i < type->ring_count; i++) {
        const virga_effect_ring *row = &type->rings[i];
        virga_ring *ring = virga_effect_member(effect, row->member);
        ring->block_bytes = (uint32_t)row->block;
        ring->blocks_per_frame = (uint32_t)counts[row->count];
        TRY(virga_buffer_create(context, ring_bytes(row, counts, context->frames_in_flight), row->usage,
                                VIRGA_HEAP_UPLOAD, row->name, &ring->buffer));
    }
    if (type->readback_bytes)
        TRY(virga_buffer_create(context, (VkDeviceSize)type->readback_bytes * context->frames_in_flight,
                                VK_BUFFER_USAGE_TRANSFER_DST_BIT, VIRGA_HEAP_READBACK, type->readback_name,
                                &effect->readback));
    TRY(virga_journal_create(context, &effect->journal));
error:
    return result;
}

static virga_result create_images(virga_effect *effect, const effect_counts counts)
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < effect->type->image_count; i++) {
        const virga_effect_image *row = &effect->type->images[i];
        const VkExtent2D extent = {(uint32_t)counts[row->width], (uint32_t)counts[row->height]};
        const bool wanted = extent.width && extent.height;
        for (uint32_t k = 0; wanted && k < virga_effect_copies(effect, row->per_view); k++)
            TRY(virga_image_create_seen_as(effect->context, row->format, row->seen_as, extent, row->layers, row->usage,
                                           row->aspect, row->name,
                                           virga_effect_copy(effect, row->member, row->per_view, k)));
    }
error:
    return result;
}

static virga_bindings *layout_of(const virga_effect *effect, uint32_t index)
{
    return *(virga_bindings **)virga_effect_member(effect, effect->type->layouts[index].member);
}

static virga_result create_layouts(virga_effect *effect)
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < effect->type->layout_count; i++) {
        const virga_effect_layout *row = &effect->type->layouts[i];
        TRY(virga_bindings_create(effect->context, row->rows, row->row_count, row->sets_per_frame, row->push_bytes,
                                  virga_effect_member(effect, row->member)));
    }
error:
    return result;
}

static uint32_t form_count(const virga_effect_pass *row)
{
    return row->forms ? row->forms : 1;
}

/* Those that are used with these settings and are not there yet. */
static virga_result create_passes(virga_effect *effect, const void *settings)
{
    const virga_effect_type *type = effect->type;
    const uint32_t common = type->pass_constant ? type->pass_constant(effect) : 0;
    const uint32_t lanes = virga_shuffled_lanes(effect->context);
    const bool shuffles = lanes && lanes % 8 == 0;
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < type->pass_count; i++) {
        const virga_effect_pass *row = &type->passes[i];
        virga_pipeline **pipelines = virga_effect_member(effect, row->member);
        if (row->shuffles && !shuffles)
            continue;
        virga_compute_def def = {.shader = row->shader,
                                 .layout = layout_of(effect, row->layout)->shared,
                                 .group = &effect->passes,
                                 .name = row->name};
        for (uint32_t form = 0; form < form_count(row); form++) {
            if (pipelines[form] || (type->form_used && !type->form_used(effect, settings, row, form)))
                continue;
            def.constant = common | (row->constant + form);
            TRY(virga_compute_pipeline_create(effect->context, &def, &pipelines[form]));
        }
    }
error:
    return result;
}

static virga_result init(virga_effect *effect)
{
    const virga_effect_type *type = effect->type;
    effect_counts counts;
    virga_result result = VIRGA_OK, fitted = VIRGA_OK;
    if (type->fit_device)
        fitted = type->fit_device(effect->context, virga_effect_member(effect, type->def.member));
    fill_counts(type, def_of(effect), counts);
    effect->max_views = views_of(type, def_of(effect));
    if (type->init)
        TRY(type->init(effect));
    TRY(create_buffers(effect, counts));
    TRY(create_images(effect, counts));
    virga_effect_select(effect, 0);
    TRY(create_layouts(effect));
    TRY(virga_effect_create_fills(effect));
    if (type->create)
        TRY(type->create(effect));
    TRY(create_passes(effect, virga_effect_member(effect, type->settings.member)));
    TRY(virga_recording_result(effect->context));
    if (type->fill)
        TRY(type->fill(effect));
error:
    return result < 0 ? result : fitted;
}

/* Creates an object from a definition that was checked. */
static virga_result make(virga_context *context, const virga_effect_type *type, const void *def, virga_effect **made)
{
    virga_effect *effect = virga_alloc(&context->heap, type->size);
    if (!effect)
        return virga_out_of_host_memory(context, type->name);
    effect->type = type;
    effect->context = context;
    memcpy(virga_effect_member(effect, type->def.member), def, type->def.size);
    virga_effect_default_settings(type, virga_effect_member(effect, type->settings.member));
    effect->serial = ++context->effect_serial;
    effect->next_effect = context->first_effect;
    context->first_effect = effect;
    context->effects++;
    virga_context_join(context);
    const virga_result result = init(effect);
    if (result < 0) {
        virga_effect_destroy(effect);
        effect = NULL;
    }
    *made = effect;
    return result;
}

static void log_created(const virga_effect *effect)
{
    char line[VIRGA_LOG_LINE];
    const virga_context *context = effect->context;
    effect->type->describe(effect, line, sizeof line);
    virga_log_write(&context->log, VIRGA_LOG_INFO, VIRGA_LOG_CREATED, "%s, %.1f MB of device memory in use", line,
                    (double)context->device_used * 1e-6);
}

virga_result virga_effect_create(virga_context *context, const virga_effect_type *type, const char *call,
                                 const void *given, void **object)
{
    _Alignas(16) char def[VIRGA_EFFECT_MAX_DEF];
    if (object)
        *object = NULL;
    virga_result result = virga_context_check_create(context, given && object, call);
    if (!result)
        result = check_def(&context->log, type, given, def);
    if (result)
        return result;
    virga_effect *made = NULL;
    virga_budget_try attempt;
    virga_budget_begin(context, type, def, &attempt);
    do
        result = make(context, type, def, &made);
    while (virga_budget_retry(context, &attempt, result));
    if (result < 0)
        return result;
    if (virga_budget_log(context, &attempt))
        result = VIRGA_DEGRADED;
    log_created(made);
    *object = made;
    return result;
}

/* ---- destroy */

static void retire_passes(virga_effect *effect)
{
    for (uint32_t i = 0; i < effect->type->pass_count; i++) {
        const virga_effect_pass *row = &effect->type->passes[i];
        virga_pipeline **pipelines = virga_effect_member(effect, row->member);
        for (uint32_t form = 0; form < form_count(row); form++)
            VIRGA_RETIRE(effect->context, pipelines[form]);
    }
}

static void retire_rows(virga_effect *effect)
{
    const virga_effect_type *type = effect->type;
    virga_context *context = effect->context;
    for (uint32_t i = 0; i < type->buffer_count; i++) {
        const virga_effect_buffer *row = &type->buffers[i];
        for (uint32_t k = 0; k < virga_effect_copies(effect, row->per_view); k++) {
            virga_buffer **buffer = virga_effect_copy(effect, row->member, row->per_view, k);
            VIRGA_RETIRE(context, *buffer);
        }
    }
    for (uint32_t i = 0; i < type->ring_count; i++) {
        virga_ring *ring = virga_effect_member(effect, type->rings[i].member);
        VIRGA_RETIRE(context, ring->buffer);
    }
    VIRGA_RETIRE(context, effect->readback);
    VIRGA_RETIRE(context, effect->journal.marks);
    VIRGA_RETIRE(context, effect->fill_pass);
    VIRGA_RETIRE(context, effect->fill_bindings);
    for (uint32_t i = 0; i < type->image_count; i++) {
        const virga_effect_image *row = &type->images[i];
        for (uint32_t k = 0; k < virga_effect_copies(effect, row->per_view); k++) {
            virga_image_2d **image = virga_effect_copy(effect, row->member, row->per_view, k);
            VIRGA_RETIRE(context, *image);
        }
    }
    for (uint32_t i = 0; i < type->layout_count; i++) {
        virga_bindings **layout = virga_effect_member(effect, type->layouts[i].member);
        VIRGA_RETIRE(context, *layout);
    }
}

static void leave_context(virga_effect *effect)
{
    virga_effect **at = &effect->context->first_effect;
    while (*at != effect)
        at = &(*at)->next_effect;
    *at = effect->next_effect;
    effect->context->effects--;
}

void virga_effect_destroy(virga_effect *effect)
{
    if (!effect)
        return;
    virga_context *context = effect->context;
    leave_context(effect);
    if (effect->type->destroy)
        effect->type->destroy(effect);
    virga_effect_retire_targets(effect);
    retire_passes(effect);
    retire_rows(effect);
    virga_free(&context->heap, effect);
    virga_context_leave(context);
}

void virga_effect_destroy_by_host(virga_effect *effect, const char *call)
{
    if (effect->of_scene)
        virga_wrong_argument(&effect->context->log, "%s: it belongs to a scene, and is destroyed with that", call);
    else
        virga_effect_destroy(effect);
}

/* ---- settings */

virga_result virga_effect_set(virga_effect *effect, const char *call, const void *given)
{
    const virga_effect_type *type = effect->type;
    const virga_log *log = &effect->context->log;
    _Alignas(16) char settings[VIRGA_EFFECT_MAX_SETTINGS];
    bool changed = false;
    virga_result result = VIRGA_OK;
    if (!given)
        return virga_wrong_argument(log, "%s: NULL argument", call);
    if (effect->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    TRY(copy_checked(log, &type->settings, given, settings, &changed));
    if (type->lighting)
        TRY(virga_lighting_check(log, type->log_name, lighting_of(type, settings), &changed));
    if (type->check_settings)
        TRY(type->check_settings(effect, settings, &changed));
    if (type->apply_settings)
        TRY(type->apply_settings(effect, settings));
    if (type->wanted_draws)
        TRY(virga_effect_want_draws(effect, settings));
    if (type->form_used)
        TRY(create_passes(effect, settings));
    memcpy(virga_effect_member(effect, type->settings.member), settings, type->settings.size);
    return changed ? VIRGA_DEGRADED : VIRGA_OK;
error:
    return result;
}

virga_result virga_effect_set_lighting(virga_effect *effect, const virga_lighting *lighting)
{
    const virga_effect_type *type = effect->type;
    if (!type->lighting)
        return VIRGA_OK;
    _Alignas(16) char settings[VIRGA_EFFECT_MAX_SETTINGS];
    memcpy(settings, virga_effect_member(effect, type->settings.member), type->settings.size);
    *lighting_of(type, settings) = *lighting;
    return virga_effect_set(effect, "virga_scene_lighting_set", settings);
}
