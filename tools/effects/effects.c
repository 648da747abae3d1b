/* effects.c - the register of effects. */
#include "effect.h"

const tool_effect *const tool_effects[] = {
#define EFFECT(name) &name##_effect,
#include "effect_list.h"
#undef EFFECT
    NULL,
};

const scene_section *const tool_effect_sections[] = {
#define EFFECT(name) &name##_effect.scene,
#include "effect_list.h"
#undef EFFECT
    NULL,
};

bool tool_effect_is_used(const tool_effect *effect, const scene_file *scene)
{
    return !effect->is_used || effect->is_used(scene);
}

uint32_t tool_seed(const scene_file *scene)
{
    uint32_t seed = 0;
    for (uint32_t i = 0; tool_effects[i]; i++)
        seed = tool_effects[i]->seed ? tool_effects[i]->seed(scene) : seed;
    return seed;
}

const char *tool_seed_key(void)
{
    const char *key = "";
    for (uint32_t i = 0; tool_effects[i]; i++)
        key = tool_effects[i]->seed_key ? tool_effects[i]->seed_key : key;
    return key;
}
