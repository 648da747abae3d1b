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
