/* small_state.h - the state of a scene, read back, and the conditions that it must always meet: all numbers are finite,
 * counts are in their ranges, water is conserved to the nanolitre. Does not depend on a test framework. */
#ifndef VIRGA_TESTS_SMALL_STATE_H
#define VIRGA_TESTS_SMALL_STATE_H

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "host.h"
#include "memory.h"

#include <virga/shared/drop.h>
#include <virga/virga.h>

enum { SMALL_MAX_PARTS = 8 };

typedef struct small_part {
    const char *name;
    VkBuffer buffer;
    VkDeviceSize from, size, to;
    uint32_t count; /* if the buffer does not contain it */
} small_part;

typedef struct small_state {
    small_part parts[SMALL_MAX_PARTS];
    uint32_t part_count;
    host_buffer copy;
    uint64_t rained_nl, dropped; /* of all steps so far */
    char wrong[256];             /* the first condition that failed; empty: none */
} small_state;

static inline void small_state_wrong(small_state *s, const char *format, ...)
{
    va_list arguments;
    if (s->wrong[0])
        return;
    va_start(arguments, format);
    vsnprintf(s->wrong, sizeof s->wrong, format, arguments);
    va_end(arguments);
}

/* ---- read-back */

static inline void small_state_list(small_state *s, virga_scene *scene)
{
    virga_rain_buffer impacts, drops;
    virga_splash_buffer droplets;
    small_part parts[SMALL_MAX_PARTS] = {
        {.name = "impacts"}, {.name = "drops"}, {.name = "spawns"}, {.name = "droplets"}};
    uint32_t count = 4;
    virga_rain_impacts(virga_scene_rain(scene), &impacts);
    virga_rain_drops(virga_scene_rain(scene), &drops, &parts[1].count, NULL);
    parts[0].buffer = impacts.buffer;
    parts[0].size = impacts.size;
    parts[1].buffer = drops.buffer;
    parts[1].size = drops.size;
    virga_ground_spawns(virga_scene_ground(scene), &parts[2].buffer, &parts[2].size);
    virga_splash_droplets(virga_scene_splash(scene), &droplets, &parts[3].count, NULL);
    parts[3].buffer = droplets.buffer;
    parts[3].size = droplets.size;
    for (; count < SMALL_MAX_PARTS && virga_scene_glass(scene, count - 4); count++) {
        virga_glass_buffer glass;
        parts[count].name = "pane";
        virga_glass_drops(virga_scene_glass(scene, count - 4), &glass, &parts[count].count);
        parts[count].buffer = glass.buffer;
        parts[count].size = glass.size;
    }
    VkDeviceSize to = 0;
    for (uint32_t i = 0; i < count; i++, to += parts[i - 1].size)
        parts[i].to = to;
    memcpy(s->parts, parts, sizeof parts);
    s->part_count = count;
}

static inline bool small_state_open(small_state *s, host_device *device, virga_scene *scene, char *error, size_t size)
{
    memset(s, 0, sizeof *s);
    small_state_list(s, scene);
    const small_part *last = &s->parts[s->part_count - 1];
    return host_buffer_create(device, last->to + last->size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK,
                              "state", &s->copy, error, size);
}

static inline void small_state_close(small_state *s, host_device *device)
{
    if (s->copy.buffer)
        host_buffer_destroy(device, &s->copy);
}

/* Call it after the scene's step, in the same command buffer. */
static inline void small_state_record(small_state *s, VkCommandBuffer cmd, virga_scene *scene)
{
    const VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                     .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT};
    small_state_list(s, scene); /* droplets change their buffer */
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &barrier, 0,
                         NULL, 0, NULL);
    for (uint32_t i = 0; i < s->part_count; i++) {
        const VkBufferCopy copy = {s->parts[i].from, s->parts[i].to, s->parts[i].size};
        vkCmdCopyBuffer(cmd, s->parts[i].buffer, s->copy.buffer, 1, &copy);
    }
}

/* ---- conditions */

static inline void small_state_finite(small_state *s, const char *name, uint32_t index, const void *at, uint32_t floats)
{
    const float *values = at;
    for (uint32_t i = 0; i < floats; i++)
        if (!isfinite(values[i]))
            small_state_wrong(s, "%s %u: float %u is %g", name, index, i, (double)values[i]);
}

static inline void small_state_impacts(small_state *s, const small_part *part)
{
    const virga_impacts_gpu *head = (const virga_impacts_gpu *)((const char *)s->copy.mapped + part->to);
    const virga_impact_gpu *impacts = (const virga_impact_gpu *)(head + 1);
    const uint32_t room = (uint32_t)((part->size - sizeof *head) / sizeof *impacts);
    small_state_finite(s, "origin of impacts", 0, head->origin, 3);
    if (head->count > room)
        small_state_wrong(s, "%u impacts in a buffer of %u", head->count, room);
    for (uint32_t i = 0; i < head->count && i < room; i++) {
        small_state_finite(s, "impact", i, impacts[i].position, 12);
        if (impacts[i].material > 255 || !(impacts[i].diameter_m > 0 && impacts[i].diameter_m < 0.01f))
            small_state_wrong(s, "impact %u: material %u, diameter %g m", i, impacts[i].material,
                              (double)impacts[i].diameter_m);
    }
}

static inline void small_state_drops(small_state *s, const small_part *part)
{
    const virga_drop_gpu *drops = (const virga_drop_gpu *)((const char *)s->copy.mapped + part->to);
    for (uint32_t i = 0; i < part->count; i++)
        small_state_finite(s, "drop", i, drops[i].position, 3);
}

static inline void small_state_spawns(small_state *s, const small_part *part)
{
    const virga_spawns_gpu *head = (const virga_spawns_gpu *)((const char *)s->copy.mapped + part->to);
    const virga_spawn_gpu *spawns = (const virga_spawn_gpu *)(head + 1);
    const uint32_t room = (uint32_t)((part->size - sizeof *head) / sizeof *spawns);
    small_state_finite(s, "near_m of spawns", 0, &head->near_m, 1);
    if (head->count > room)
        small_state_wrong(s, "%u spawns in a buffer of %u", head->count, room);
    for (uint32_t i = 0; i < head->count && i < room; i++)
        small_state_finite(s, "spawn", i, spawns[i].position, 14);
}

static inline void small_state_droplets(small_state *s, const small_part *part)
{
    const virga_droplet_gpu *droplets = (const virga_droplet_gpu *)((const char *)s->copy.mapped + part->to);
    for (uint32_t i = 0; i < part->count; i++)
        if (droplets[i].kind & VIRGA_DROPLET_ALIVE)
            small_state_finite(s, "droplet", i, droplets[i].position, 11);
}

static inline void small_state_pane(small_state *s, const small_part *part)
{
    const virga_glass_drop_gpu *drops = (const virga_glass_drop_gpu *)((const char *)s->copy.mapped + part->to);
    for (uint32_t i = 0; i < part->count; i++) {
        if ((drops[i].kind & VIRGA_GLASS_KIND) == VIRGA_GLASS_FREE)
            continue;
        small_state_finite(s, "drop on a pane", i, drops[i].position, 6);
        small_state_finite(s, "way on a pane", i, &drops[i].progress_m, 3);
    }
}

/* Water balance of the ground: all that arrived is still there or has left. All rain arrived, is somewhere else, or is
 * in flight. */
static inline void small_state_ground(small_state *s, virga_scene *scene)
{
    virga_ground_stats g;
    virga_ground_stats_get(virga_scene_ground(scene), &g);
    const uint64_t came = g.start_nl + g.landed_nl;
    const uint64_t is = g.film_nl + g.puddles_nl + g.held_nl + g.cached_nl + g.infiltrated_nl + g.run_off_nl +
                        g.evaporated_nl + g.evicted_nl;
    if (came != is)
        small_state_wrong(s, "%llu nl came to the ground, %llu nl are there or went", (unsigned long long)came,
                          (unsigned long long)is);
    const uint64_t met = g.landed_nl + g.off_ground_nl + g.flown_nl - g.returned_nl;
    if (s->dropped ? met > s->rained_nl : met != s->rained_nl)
        small_state_wrong(s, "%llu nl rained, %llu nl met something", (unsigned long long)s->rained_nl,
                          (unsigned long long)met);
    virga_splash_stats up;
    virga_splash_stats_get(virga_scene_splash(scene), &up);
    if (up.flown_nl != g.flown_nl || up.returned_nl > up.flown_nl || g.returned_nl > up.returned_nl)
        small_state_wrong(s, "splashes: %llu nl up of %llu, %llu back of %llu", (unsigned long long)up.flown_nl,
                          (unsigned long long)g.flown_nl, (unsigned long long)g.returned_nl,
                          (unsigned long long)up.returned_nl);
}

static inline void small_state_glass(small_state *s, const virga_glass *pane, const virga_glass_stats *g)
{
    uint32_t slots;
    virga_glass_drops(pane, NULL, &slots);
    const uint64_t came = g->landed_nl + g->touched_nl;
    const uint64_t is =
        g->drops_nl + g->particles_nl + g->film_nl + g->run_off_nl + g->wiped_nl + g->evaporated_nl + g->joined_nl;
    if (came != is)
        small_state_wrong(s, "%llu nl came to a pane, %llu nl are there or went", (unsigned long long)came,
                          (unsigned long long)is);
    if ((uint64_t)g->drops + g->particles > slots)
        small_state_wrong(s, "%u drops and %u particles in %u slots of a pane", g->drops, g->particles, slots);
}

/* Call it after the frame has completed, once per stepped frame. Returns false and fills `wrong` if a condition
 * fails. */
static inline bool small_state_check(small_state *s, const host_device *device, virga_scene *scene)
{
    static void (*const checks[])(small_state *, const small_part *) = {small_state_impacts, small_state_drops,
                                                                        small_state_spawns, small_state_droplets};
    virga_rain_stats rain;
    host_buffer_invalidate(device, &s->copy);
    for (uint32_t i = 0; i < s->part_count; i++)
        (i < 4 ? checks[i] : small_state_pane)(s, &s->parts[i]);
    virga_rain_stats_get(virga_scene_rain(scene), &rain);
    s->rained_nl = rain.total_water_nl;
    s->dropped += rain.impacts_dropped;
    small_state_finite(s, "wind", 0, rain.wind_m_s, 3);
    small_state_ground(s, scene);
    for (uint32_t i = 0; virga_scene_glass(scene, i); i++) {
        virga_glass_stats glass;
        virga_glass_stats_get(virga_scene_glass(scene, i), &glass);
        small_state_glass(s, virga_scene_glass(scene, i), &glass);
    }
    return !s->wrong[0];
}

#endif
