/* points.c - drops, droplets and what is on panes, read back for point caches. */
#include "shot/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <virga/shared/random.h>

/* Copies points that the step just recorded has left ready for it to where the host reads them. */
bool shot_record_read(shot *s, VkCommandBuffer cmd, VkBuffer from, VkDeviceSize offset, VkDeviceSize size,
                      shot_read *read, char *error, size_t error_size)
{
    if (!read->buffer.buffer &&
        !host_buffer_create(&s->device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "points read",
                            &read->buffer, error, error_size))
        return false;
    const VkBufferCopy copy = {offset, 0, size};
    const VkPipelineStageFlags copying = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkAccessFlags written = VK_ACCESS_TRANSFER_WRITE_BIT;
    host_memory_barrier(cmd, copying, written, copying, written);
    vkCmdCopyBuffer(cmd, from, read->buffer.buffer, 1, &copy);
    host_memory_barrier(cmd, copying, written, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    return true;
}

/* What is on the panes. */
static bool record_panes(shot *s, VkCommandBuffer cmd, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < scene_glass_of(s->scene)->pane_count; i++) {
        virga_glass_buffer drops;
        shot_read *read = &s->panes[i].read;
        virga_glass_drops(s->panes[i].glass, &drops, &read->count);
        if (!shot_record_read(s, cmd, drops.buffer, drops.offset, drops.size, read, error, error_size))
            return false;
    }
    return true;
}

bool shot_record_points(shot *s, VkCommandBuffer cmd, char *error, size_t error_size)
{
    virga_rain_buffer drops;
    virga_splash_buffer droplets;
    shot_read *read = &s->drops_read;
    if (!shot_ok(s, virga_rain_points(s->rain, cmd, &drops, &read->count, read->origin_m), "reading drops", error,
                 error_size) ||
        !shot_record_read(s, cmd, drops.buffer, drops.offset, drops.size, read, error, error_size))
        return false;
    read = &s->droplets_read;
    virga_splash_droplets(s->splash, &droplets, &read->count, read->origin_m);
    return (!s->splash ||
            shot_record_read(s, cmd, droplets.buffer, droplets.offset, droplets.size, read, error, error_size)) &&
           record_panes(s, cmd, error, error_size);
}

/* What was read back, and room for as many points of `size` bytes. */
static const void *open_read(shot *s, shot_read *read, size_t size, void **room, char *error, size_t error_size)
{
    *room = NULL;
    if (!read->buffer.buffer || !host_wait(&s->device, error, error_size)) {
        host_fail(error, error_size, "no points were read back");
        return NULL;
    }
    host_buffer_invalidate(&s->device, &read->buffer);
    *room = malloc(read->count * size + 1);
    if (*room)
        return read->buffer.mapped;
    host_fail(error, error_size, "no memory for %u points", read->count);
    return NULL;
}

/* To the world. */
static void place_point(const shot_read *read, const float position[3], float out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (float)((double)position[axis] + read->origin_m[axis]);
}

bool shot_points(shot *s, shot_point **points, uint32_t *count, char *error, size_t error_size)
{
    void *room;
    const virga_point_gpu *from = open_read(s, &s->drops_read, sizeof **points, &room, error, error_size);
    *points = room;
    *count = 0;
    if (!from)
        return false;
    for (uint32_t i = 0; i < s->drops_read.count; i++) {
        if (from[i].weight <= 0)
            continue;
        shot_point *to = &(*points)[(*count)++];
        place_point(&s->drops_read, from[i].position, to->position);
        memcpy(to->velocity, from[i].velocity, sizeof to->velocity);
        to->radius_m = 0.5f * from[i].diameter_m;
        to->id = from[i].id;
        to->age_s = from[i].age_s;
        to->weight = from[i].weight;
    }
    return true;
}

bool shot_droplets(shot *s, shot_droplet **droplets, uint32_t *count, char *error, size_t error_size)
{
    void *room;
    const virga_droplet_gpu *from = open_read(s, &s->droplets_read, sizeof **droplets, &room, error, error_size);
    *droplets = room;
    *count = 0;
    if (!from)
        return false;
    for (uint32_t i = 0; i < s->droplets_read.count; i++) {
        if (!(from[i].kind & VIRGA_DROPLET_ALIVE) || from[i].age_s < 0)
            continue;
        shot_droplet *to = &(*droplets)[(*count)++];
        place_point(&s->droplets_read, from[i].position, to->position);
        memcpy(to->velocity, from[i].velocity, sizeof to->velocity);
        to->radius_m = 0.5f * from[i].diameter_m;
        to->age_s = from[i].age_s;
        to->model = VIRGA_DROPLET_MODEL(from[i].kind);
        to->material = VIRGA_DROPLET_MATERIAL(from[i].kind);
        to->state = VIRGA_DROPLET_STATE(from[i].kind);
        to->parent = from[i].id;
        to->index = VIRGA_DROPLET_NUMBER(from[i].kind);
        to->id = virga_hash2(to->parent, to->index);
        to->water_ul = (float)(from[i].water_nl * 1e-3);
    }
    return true;
}

/* ---- what is on panes */

/* Radius of the base of a spherical cap, by its contact angle and water. */
static double base_radius(const virga_glass_settings *settings, double water_m3)
{
    const double angle = 0.5 * ((double)settings->advancing_deg + (double)settings->receding_deg) * M_PI / 180;
    const double c = cos(angle), sn = sin(angle);
    return cbrt(water_m3 * 3 * sn * sn * sn / (M_PI * (2 - 3 * c + c * c * c)));
}

/* From the pane's own frame to the world. */
static void turn_to_world(const virga_glass_pose *pose, const double local[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (double)pose->world_from_pane[i] * local[0] + (double)pose->world_from_pane[3 + i] * local[1] +
                 (double)pose->world_from_pane[6 + i] * local[2];
}

/* Along the pane, and with it. */
static void place_drop(const shot_pane *pane, const virga_glass_drop_gpu *from, shot_glass_drop *to)
{
    const double step = 1e-4;
    const double u = (double)from->position[0], v = (double)from->position[1];
    double at[3], along_u[3], along_v[3], normal[3], local[3], arm[3], slide[3];
    shot_pane_point(pane, u, v, at, normal);
    shot_pane_point(pane, u + step, v, along_u, normal);
    shot_pane_point(pane, u, v + step, along_v, normal);
    for (int i = 0; i < 3; i++)
        local[i] =
            ((along_u[i] - at[i]) * (double)from->velocity[0] + (along_v[i] - at[i]) * (double)from->velocity[1]) /
            step;
    turn_to_world(&pane->now.pose, at, arm);
    turn_to_world(&pane->now.pose, local, slide);
    for (int i = 0; i < 3; i++) {
        const int y = (i + 1) % 3, z = (i + 2) % 3;
        const double spin = (double)pane->now.turn_rad_s[y] * arm[z] - (double)pane->now.turn_rad_s[z] * arm[y];
        to->position[i] = (float)(pane->now.pose.position_m[i] + arm[i]);
        to->velocity[i] = (float)(slide[i] + (double)pane->now.velocity_m_s[i] + spin);
    }
}

static uint32_t take_drops(const shot_pane *pane, uint32_t index, shot_glass_drop *to)
{
    const virga_glass_drop_gpu *from = pane->read.buffer.mapped;
    uint32_t count = 0;
    for (uint32_t i = 0; i < pane->read.count; i++) {
        const uint32_t kind = from[i].kind & VIRGA_GLASS_KIND;
        if (kind == VIRGA_GLASS_FREE)
            continue;
        shot_glass_drop *drop = &to[count++];
        place_drop(pane, &from[i], drop);
        drop->radius_m = kind == VIRGA_GLASS_PARTICLE ? (float)(pane->from->particle_mm * 1e-3)
                                                      : (float)base_radius(&pane->settings, from[i].water_nl * 1e-12);
        drop->id = from[i].id;
        drop->age_s = from[i].age_s;
        drop->kind = kind;
        drop->flags = from[i].kind & ~(uint32_t)VIRGA_GLASS_KIND;
        drop->pane = index;
        drop->water_ul = (float)(from[i].water_nl * 1e-3);
    }
    return count;
}

bool shot_glass_drops(shot *s, shot_glass_drop **drops, uint32_t *count, char *error, size_t error_size)
{
    size_t room = 1;
    for (uint32_t i = 0; i < scene_glass_of(s->scene)->pane_count; i++)
        room += s->panes[i].read.count;
    *count = 0;
    *drops = malloc(room * sizeof **drops);
    if (!*drops)
        return host_fail(error, error_size, "no memory for %zu drops", room);
    if (!host_wait(&s->device, error, error_size))
        return false;
    for (uint32_t i = 0; i < scene_glass_of(s->scene)->pane_count; i++) {
        if (!s->panes[i].read.buffer.buffer)
            return host_fail(error, error_size, "no drops were read back");
        host_buffer_invalidate(&s->device, &s->panes[i].read.buffer);
        *count += take_drops(&s->panes[i], i, *drops + *count);
    }
    return true;
}
