/* gpu/state.h - saves and loads the simulated state of effects, by the rows of their types. Internal. */
#ifndef VIRGA_GPU_STATE_H
#define VIRGA_GPU_STATE_H

#include "gpu/effect_type.h"

#include <virga/state.h>

#define VIRGA_STATE_MAX_EFFECTS 144

/* The effects that one state holds, in their order. `index` tells effects of one type apart. */
typedef struct virga_state_effect {
    virga_effect *effect;
    uint32_t index;
} virga_state_effect;

VkDeviceSize virga_effects_state_bytes(const virga_state_effect *effects, uint32_t count);

/* `call`: the name of the public function, for log lines. */
virga_result virga_effects_save(const virga_state_effect *effects, uint32_t count, const char *call,
                                VkCommandBuffer cmd, const virga_state_range *to);
virga_result virga_effects_load(const virga_state_effect *effects, uint32_t count, const char *call,
                                VkCommandBuffer cmd, const virga_state_source *from);

/* The public functions of one effect. */
#define VIRGA_EFFECT_STATE_FUNCTIONS(name)                                                                      \
    VkDeviceSize virga_##name##_state_bytes(const virga_##name *object)                                         \
    {                                                                                                           \
        const virga_state_effect one = {object ? (virga_effect *)&object->base : NULL, 0};                      \
        return object ? virga_effects_state_bytes(&one, 1) : 0;                                                 \
    }                                                                                                           \
    virga_result virga_##name##_save(virga_##name *object, VkCommandBuffer cmd, const virga_state_range *to)    \
    {                                                                                                           \
        const virga_state_effect one = {object ? &object->base : NULL, 0};                                      \
        return object ? virga_effects_save(&one, 1, "virga_" #name "_save", cmd, to) : VIRGA_ERROR_INVALID;     \
    }                                                                                                           \
    virga_result virga_##name##_load(virga_##name *object, VkCommandBuffer cmd, const virga_state_source *from) \
    {                                                                                                           \
        const virga_state_effect one = {object ? &object->base : NULL, 0};                                      \
        return object ? virga_effects_load(&one, 1, "virga_" #name "_load", cmd, from) : VIRGA_ERROR_INVALID;   \
    }
#endif
