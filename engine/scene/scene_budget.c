/* scene/scene_budget.c - how many ticks fit into a frame's time budget, by the times of passes that were measured. */
#include "scene/scene_internal.h"

#include "gpu/context.h"

#include <string.h>

/* The passes that run once for each tick. All others run once for a frame or a view, however long the frame was. */
static const char *const passes_of_ticks[] = {"rain.wind",   "rain.step",    "rain.impacts", "ground.land",
                                              "ground.flow", "ground.spawn", "splash.spawn", "splash.step",
                                              "glass.spawn", "glass.motion", "glass.wipe",   "glass.particles"};

static bool is_of_ticks(const char *name)
{
    for (size_t i = 0; i < VIRGA_ROWS(passes_of_ticks); i++)
        if (!strcmp(name, passes_of_ticks[i]))
            return true;
    return false;
}

static uint32_t ticks_in(const virga_scene *scene, uint64_t frame)
{
    const uint32_t slot = (uint32_t)(frame % SCENE_KNOWN_FRAMES);
    return scene->ticks_of[slot].frame == frame ? scene->ticks_of[slot].ticks : 0;
}

/* The time of all passes of a tick in the newest frame that had one; 0: none was measured. Water flows in some ticks
 * only: a frame without it would be too cheap, so each pass counts with the newest frame that had it. */
static double tick_ms(const virga_scene *scene)
{
    const virga_timers *timers = &scene->context->timers;
    double sum = 0;
    for (uint32_t i = 0; i < timers->pass_count; i++) {
        const virga_pass_time *pass = &timers->pass_times[i];
        const uint32_t ticks = ticks_in(scene, pass->frame_index);
        if (ticks && is_of_ticks(pass->name))
            sum += pass->milliseconds / ticks;
    }
    return sum;
}

uint32_t scene_ticks_in_budget(virga_scene *scene, float budget_ms)
{
    if (!(budget_ms > 0) || !scene->context->timers.enabled)
        return 0;
    const double one = tick_ms(scene), fit = one > 0 ? (double)budget_ms / one : 1;
    return fit < 1 ? 1 : fit > 64 ? 64 : (uint32_t)fit;
}

void scene_note_ticks(virga_scene *scene, uint32_t ticks)
{
    const uint64_t frame = scene->context->frame_index;
    const uint32_t slot = (uint32_t)(frame % SCENE_KNOWN_FRAMES);
    if (scene->ticks_of[slot].frame != frame)
        scene->ticks_of[slot].ticks = 0;
    scene->ticks_of[slot].frame = frame;
    scene->ticks_of[slot].ticks += ticks;
}
