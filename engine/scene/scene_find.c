/* scene/scene_find.c - the effects that a scene holds, by their kind. */
#include "scene/scene_internal.h"

#include "glass/glass.h"
#include "ground/ground.h"
#include "rain/rain.h"
#include "splash/splash.h"
#include "water/water.h"

virga_result scene_merge_results(virga_result a, virga_result b)
{
    return a < 0 ? a : b ? b : a;
}

void *scene_find(const virga_scene *scene, const virga_effect_type *type, uint32_t index)
{
    for (uint32_t i = 0; scene && i < scene->effect_count; i++)
        if (scene->effects[i].kind->type == type && scene->effects[i].index == index)
            return scene->effects[i].effect;
    return NULL;
}

virga_rain *virga_scene_rain(virga_scene *scene)
{
    return scene_find(scene, &rain_type, 0);
}

virga_ground *virga_scene_ground(virga_scene *scene)
{
    return scene_find(scene, &ground_type, 0);
}

virga_splash *virga_scene_splash(virga_scene *scene)
{
    return scene_find(scene, &splash_type, 0);
}

virga_glass *virga_scene_glass(virga_scene *scene, uint32_t index)
{
    return scene_find(scene, &glass_type, index);
}

virga_water *virga_scene_water(virga_scene *scene)
{
    return scene_find(scene, &water_type, 0);
}
