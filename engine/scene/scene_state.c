/* scene/scene_state.c - saves and loads the state of all effects of a scene. */
#include "scene/scene_internal.h"

#include "gpu/state.h"

_Static_assert(SCENE_MAX_EFFECTS <= VIRGA_STATE_MAX_EFFECTS, "a state has room for all effects of a scene");

/* The effects that have a state. */
static uint32_t list(const virga_scene *scene, virga_state_effect effects[SCENE_MAX_EFFECTS])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->effect_count; i++)
        if (scene->effects[i].effect->type->state_row_count)
            effects[count++] = (virga_state_effect){scene->effects[i].effect, scene->effects[i].index};
    return count;
}

VkDeviceSize virga_scene_state_bytes(const virga_scene *scene)
{
    virga_state_effect effects[SCENE_MAX_EFFECTS];
    return scene ? virga_effects_state_bytes(effects, list(scene, effects)) : 0;
}

virga_result virga_scene_save(virga_scene *scene, VkCommandBuffer cmd, const virga_state_range *to)
{
    virga_state_effect effects[SCENE_MAX_EFFECTS];
    return scene ? virga_effects_save(effects, list(scene, effects), "virga_scene_save", cmd, to) : VIRGA_ERROR_INVALID;
}

virga_result virga_scene_load(virga_scene *scene, VkCommandBuffer cmd, const virga_state_source *from)
{
    virga_state_effect effects[SCENE_MAX_EFFECTS];
    return scene ? virga_effects_load(effects, list(scene, effects), "virga_scene_load", cmd, from)
                 : VIRGA_ERROR_INVALID;
}
