/* gpu/effect.h - the life cycle of any effect: create, settings, destroy; and its public functions. Internal. */
#ifndef VIRGA_GPU_EFFECT_H
#define VIRGA_GPU_EFFECT_H

#include "gpu/effect_draw.h"
#include "gpu/effect_first.h"
#include "gpu/effect_record.h"
#include "gpu/effect_targets.h"
#include "gpu/effect_type.h"
#include "gpu/effect_views.h"

/* Creates an object. *object is NULL if that fails. `call` is the name of the public function for log lines. */
virga_result virga_effect_create(virga_context *context, const virga_effect_type *type, const char *call,
                                 const void *def, void **object);
void virga_effect_destroy(virga_effect *effect); /* accepts NULL */

/* The same for the public functions: a part of a scene is not destroyed, which is logged. */
void virga_effect_destroy_by_host(virga_effect *effect, const char *call);

/* Fill a definition or settings with the defaults. */
void virga_effect_default_def(const virga_effect_type *type, void *def);
void virga_effect_default_settings(const virga_effect_type *type, void *settings);

/* Upper bound of the device memory in bytes, with the maximum number of frames in flight. 0 for an invalid
 * definition. */
VkDeviceSize virga_effect_estimate(const virga_effect_type *type, const void *def);

/* Checks settings, clamps them and applies them. `call` is the name of the public function for log lines.
 * VIRGA_DEGRADED: some are clamped. An error changes nothing. */
virga_result virga_effect_set(virga_effect *effect, const char *call, const void *settings);

/* Replaces the lighting in the current settings. */
virga_result virga_effect_set_lighting(virga_effect *effect, const virga_lighting *lighting);

/* Fills the counts of the object's definition. */
void virga_effect_counts(const virga_effect *effect, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS]);

/* Bytes of a texel, for the formats that effects use. */
VkDeviceSize virga_texel_bytes(VkFormat format);

/* ---- public functions */

/* The public functions that are the same for all effects. They use <name>_type. */
#define VIRGA_EFFECT_FUNCTIONS(name)                                                                               \
    _Static_assert(sizeof(virga_##name##_settings) <= VIRGA_EFFECT_MAX_SETTINGS, "room for a copy of them");       \
    virga_##name##_def virga_default_##name##_def(void)                                                            \
    {                                                                                                              \
        virga_##name##_def def;                                                                                    \
        virga_effect_default_def(&name##_type, &def);                                                              \
        return def;                                                                                                \
    }                                                                                                              \
    virga_##name##_settings virga_default_##name##_settings(void)                                                  \
    {                                                                                                              \
        virga_##name##_settings settings;                                                                          \
        virga_effect_default_settings(&name##_type, &settings);                                                    \
        return settings;                                                                                           \
    }                                                                                                              \
    virga_result virga_##name##_set(virga_##name *object, const virga_##name##_settings *settings)                 \
    {                                                                                                              \
        return object ? virga_effect_set(&object->base, "virga_" #name "_set", settings) : VIRGA_ERROR_INVALID;    \
    }                                                                                                              \
    VkDeviceSize virga_##name##_estimate(const virga_##name##_def *def)                                            \
    {                                                                                                              \
        return virga_effect_estimate(&name##_type, def);                                                           \
    }                                                                                                              \
    virga_result virga_##name##_create(virga_context *context, const virga_##name##_def *def, virga_##name **made) \
    {                                                                                                              \
        void *object = NULL;                                                                                       \
        const virga_result result =                                                                                \
            virga_effect_create(context, &name##_type, "virga_" #name "_create", def, made ? &object : NULL);      \
        if (made)                                                                                                  \
            *made = object;                                                                                        \
        return result;                                                                                             \
    }                                                                                                              \
    void virga_##name##_destroy(virga_##name **object)                                                             \
    {                                                                                                              \
        if (object && *object)                                                                                     \
            virga_effect_destroy_by_host(&(*object)->base, "virga_" #name "_destroy");                             \
        if (object)                                                                                                \
            *object = NULL;                                                                                        \
    }                                                                                                              \
    void virga_##name##_get(const virga_##name *object, virga_##name##_settings *settings)                         \
    {                                                                                                              \
        if (object && settings)                                                                                    \
            *settings = object->settings;                                                                          \
    }                                                                                                              \
    virga_result virga_##name##_ready(const virga_##name *object)                                                  \
    {                                                                                                              \
        return object ? virga_effect_ready(&object->base) : VIRGA_ERROR_INVALID;                                   \
    }

/* The public reader of statistics, for effects that keep them in `stats` as the host gets them. */
#define VIRGA_EFFECT_STATISTICS_FUNCTION(name)                                       \
    void virga_##name##_stats_get(virga_##name *object, virga_##name##_stats *stats) \
    {                                                                                \
        if (object)                                                                  \
            virga_effect_read_statistics(&object->base);                             \
        if (stats)                                                                   \
            *stats = object ? object->stats : (virga_##name##_stats){0};             \
    }

/* The public draws of an effect. They use <name>_draw, which draws a prepared view for the public function `call`. */
#define VIRGA_EFFECT_VIEW_FUNCTIONS(name)                                                                              \
    virga_result virga_##name##_draw(virga_##name *object, VkCommandBuffer cmd, const virga_target *target)            \
    {                                                                                                                  \
        return object ? name##_draw(object, cmd, target, virga_effect_newest(&object->base), "virga_" #name "_draw")   \
                      : VIRGA_ERROR_INVALID;                                                                           \
    }                                                                                                                  \
    virga_result virga_##name##_draw_view(virga_##name *object, VkCommandBuffer cmd, const virga_target *target,       \
                                          virga_prepared prepared)                                                     \
    {                                                                                                                  \
        return object ? name##_draw(object, cmd, target, prepared, "virga_" #name "_draw_view") : VIRGA_ERROR_INVALID; \
    }                                                                                                                  \
    static virga_result name##_type_draw(void *object, VkCommandBuffer cmd, const virga_target *target,                \
                                         virga_prepared prepared)                                                      \
    {                                                                                                                  \
        return prepared == VIRGA_PREPARED_NEWEST ? virga_##name##_draw(object, cmd, target)                            \
                                                 : virga_##name##_draw_view(object, cmd, target, prepared);            \
    }

/* The same, and the attach. */
#define VIRGA_EFFECT_DRAW_FUNCTIONS(name)                                                                           \
    VIRGA_EFFECT_VIEW_FUNCTIONS(name)                                                                               \
    virga_result virga_##name##_attach(virga_##name *object, const virga_target *target)                            \
    {                                                                                                               \
        return object ? virga_effect_attach(&object->base, "virga_" #name "_attach", target) : VIRGA_ERROR_INVALID; \
    }

/* The public prepares of an effect, and the callback `prepare`. They use <name>_prepare. */
#define VIRGA_EFFECT_PREPARE_FUNCTIONS(name)                                                                    \
    virga_result virga_##name##_prepare_view(virga_##name *object, VkCommandBuffer cmd, const virga_view *view, \
                                             double time_s, virga_prepared *prepared)                           \
    {                                                                                                           \
        if (prepared)                                                                                           \
            *prepared = 0;                                                                                      \
        return object ? name##_prepare(object, cmd, view, time_s, prepared) : VIRGA_ERROR_INVALID;              \
    }                                                                                                           \
    virga_result virga_##name##_prepare(virga_##name *object, VkCommandBuffer cmd, const virga_view *view,      \
                                        double time_s)                                                          \
    {                                                                                                           \
        return virga_##name##_prepare_view(object, cmd, view, time_s, NULL);                                    \
    }                                                                                                           \
    static virga_result prepare(void *object, VkCommandBuffer cmd, const virga_view *view, double time_s,       \
                                virga_prepared *prepared)                                                       \
    {                                                                                                           \
        return virga_##name##_prepare_view(object, cmd, view, time_s, prepared);                                \
    }

#endif
