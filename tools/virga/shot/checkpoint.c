/* checkpoint.c - see checkpoint.h. */
#include "shot/checkpoint.h"

#include "effect.h"
#include "packed_file.h"
#include "shot/internal.h"
#include "shot/plate_ground.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The head of a file. The same bytes need the same scene, and ground of its footage, on the same device and driver. */
typedef struct checkpoint_head {
    uint64_t scene_hash;
    uint32_t frame, driver_version;
    char device[256]; /* its name; that of software Vulkan has the vector width in it */
} checkpoint_head;

static void fill_head(const shot *s, uint32_t frame, checkpoint_head *head)
{
    VkPhysicalDeviceProperties properties;
    memset(head, 0, sizeof *head);
    vkGetPhysicalDeviceProperties(s->device.physical, &properties);
    head->scene_hash = scene_file_hash(s->scene) ^ (s->plate_ground ? s->plate_ground->hash : 0);
    head->frame = frame;
    head->driver_version = properties.driverVersion;
    snprintf(head->device, sizeof head->device, "%s", properties.deviceName);
}

static bool is_preroll(const shot *s, uint32_t frame)
{
    return frame + 1 == s->scene->frames.first;
}

static void print_path(const shot *s, const char *directory, uint32_t frame, char *path, size_t size)
{
    if (is_preroll(s, frame))
        snprintf(path, size, "%s/checkpoint.preroll.virga", directory);
    else
        snprintf(path, size, "%s/checkpoint.%04u.virga", directory, frame);
}

/* ---- the parts of a file: the state of the simulation, and those that effects have besides */

#define PART_ALIGNMENT 16

/* Part 0 is the simulation's, part 1 + i that of effect i. */
static VkDeviceSize part_bytes(const shot *s, uint32_t part)
{
    const tool_effect *effect = part ? tool_effects[part - 1] : NULL;
    const VkDeviceSize bytes = !part                 ? virga_scene_state_bytes(s->simulation)
                               : effect->saved_bytes ? effect->saved_bytes(s->states[part - 1])
                                                     : 0;
    return (bytes + PART_ALIGNMENT - 1) / PART_ALIGNMENT * PART_ALIGNMENT;
}

static bool is_part(uint32_t part)
{
    return !part || tool_effects[part - 1];
}

/* Opens the buffer that states are copied to and from. It stays for the life of the shot. */
static bool open_buffer(shot *s, char *error, size_t error_size)
{
    VkDeviceSize bytes = 0;
    for (uint32_t part = 0; is_part(part); part++)
        bytes += part_bytes(s, part);
    return s->state.buffer ||
           host_buffer_create(&s->device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                              HOST_BUFFER_READBACK, "saved state", &s->state, error, error_size);
}

/* ---- save */

static bool record_save(shot *s, VkCommandBuffer cmd, char *error, size_t error_size)
{
    virga_state_range range = {.buffer = s->state.buffer};
    for (uint32_t part = 0; is_part(part); part++, range.offset += range.size) {
        range.size = part_bytes(s, part);
        if (range.size && !(part ? tool_effects[part - 1]->save(s, s->states[part - 1], cmd, &range, error, error_size)
                                 : shot_ok(s, virga_scene_save(s->simulation, cmd, &range), "saving a checkpoint",
                                           error, error_size)))
            return false;
    }
    return true;
}

static bool seal(shot *s, char *error, size_t error_size)
{
    char *at = s->state.mapped;
    for (uint32_t part = 0; is_part(part); at += part_bytes(s, part), part++)
        if (part_bytes(s, part) && !shot_ok(s, virga_state_seal(at, part_bytes(s, part), s->device.frame, NULL),
                                            "sealing a checkpoint", error, error_size))
            return false;
    return true;
}

static bool read_state(shot *s, char *error, size_t error_size)
{
    VkCommandBuffer cmd;
    if (!shot_begin(s, &cmd, error, error_size) || !record_save(s, cmd, error, error_size) ||
        !host_submit(&s->device, error, error_size) || !host_wait(&s->device, error, error_size))
        return false;
    host_buffer_invalidate(&s->device, &s->state);
    return seal(s, error, error_size);
}

bool checkpoint_save(shot *s, const char *directory, char *error, size_t error_size)
{
    char path[4096];
    checkpoint_head head, there;
    fill_head(s, s->frame_index, &head);
    print_path(s, directory, s->frame_index, path, sizeof path);
    if (packed_read_head(path, &there, sizeof there, NULL, NULL, 0) && !memcmp(&head, &there, sizeof head))
        return true;
    return open_buffer(s, error, error_size) && read_state(s, error, error_size) &&
           packed_write(path, &head, sizeof head, s->state.mapped, s->state.size, error, error_size);
}

/* ---- find */

/* Why a file can not be used; NULL: it can. */
static const char *reason_against(const shot *s, const char *path, uint32_t frame, char *text, size_t size)
{
    checkpoint_head expected, head;
    fill_head(s, frame, &expected);
    if (!packed_read_head(path, &head, sizeof head, NULL, text, size))
        return text;
    if (head.scene_hash != expected.scene_hash || head.frame != frame)
        return "it is of another scene";
    if (memcmp(head.device, expected.device, sizeof head.device) || head.driver_version != expected.driver_version)
        return "it was saved on another device";
    return NULL;
}

/* The frame of a file's name. */
static bool frame_of(const shot *s, const char *name, uint32_t *frame)
{
    int end = 0;
    *frame = s->scene->frames.first - 1;
    if (!strcmp(name, "checkpoint.preroll.virga"))
        return true;
    return sscanf(name, "checkpoint.%u.virga%n", frame, &end) == 1 && end && !name[end];
}

static bool is_better(const shot *s, uint32_t frame, uint32_t before, bool has, uint32_t found)
{
    /* Frames are counted from the one before the first, which may be UINT32_MAX. */
    const uint32_t first = s->scene->frames.first - 1, now = s->frame_index - first;
    const bool later = s->began && !s->preroll ? frame - first > now : true;
    return frame - first < before - first && later && (!has || frame - first > found - first);
}

bool checkpoint_find(const shot *s, const char *directory, uint32_t before, uint32_t *found)
{
    DIR *folder = opendir(directory);
    bool has = false;
    char path[4096], text[512];
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        uint32_t frame;
        if (!frame_of(s, entry->d_name, &frame) || !is_better(s, frame, before, has, *found))
            continue;
        snprintf(path, sizeof path, "%s/%s", directory, entry->d_name);
        const char *reason = reason_against(s, path, frame, text, sizeof text);
        if (reason)
            fprintf(stderr, "virga: %s is not used: %s\n", path, reason);
        else {
            has = true;
            *found = frame;
        }
    }
    if (folder)
        closedir(folder);
    return has;
}

/* ---- load */

static bool record_load(shot *s, VkCommandBuffer cmd, double time_s, bool *torn, char *error, size_t error_size)
{
    virga_state_source from = {.bytes = s->state.mapped, .buffer = s->state.buffer};
    for (uint32_t part = 0; is_part(part); part++) {
        from.size = part_bytes(s, part);
        if (from.size &&
            !(part
                  ? tool_effects[part - 1]->load(s, s->states[part - 1], cmd, &from, time_s, error, error_size)
                  : shot_ok(s, virga_scene_load(s->simulation, cmd, &from), "loading a checkpoint", error, error_size)))
            return false;
        *torn = true;
        from.bytes = (const char *)from.bytes + from.size;
        from.offset += from.size;
    }
    *torn = false;
    return true;
}

static bool write_state(shot *s, double time_s, bool *torn, char *error, size_t error_size)
{
    VkCommandBuffer cmd;
    if (!shot_begin(s, &cmd, error, error_size))
        return false;
    const bool loaded = record_load(s, cmd, time_s, torn, error, error_size);
    return host_submit(&s->device, error, error_size) && host_wait(&s->device, error, error_size) && loaded;
}

static void go_on_from(shot *s, uint32_t frame, double time_s)
{
    s->frame_index = frame;
    s->preroll = 0;
    s->began = true;
    s->camera_time_s = time_s;
}

bool checkpoint_load(shot *s, const char *directory, uint32_t frame, bool *torn, char *error, size_t error_size)
{
    char path[4096];
    *torn = false;
    const double time_s =
        is_preroll(s, frame) ? shot_time(s, frame + 1) - 1 / s->scene->frames.fps : shot_time(s, frame);
    print_path(s, directory, frame, path, sizeof path);
    /* A state belongs to the settings of its time. */
    if (!open_buffer(s, error, error_size) ||
        !packed_read(path, sizeof(checkpoint_head), s->state.mapped, s->state.size, error, error_size) ||
        !shot_apply_settings(s, time_s, error, error_size) || !write_state(s, time_s, torn, error, error_size))
        return false;
    go_on_from(s, frame, time_s);
    return true;
}

/* ---- in memory */

bool checkpoint_keep(shot *s, char *error, size_t error_size)
{
    s->kept_frame = s->frame_index;
    return open_buffer(s, error, error_size) && read_state(s, error, error_size);
}

bool checkpoint_return(shot *s, char *error, size_t error_size)
{
    const double time_s = shot_time(s, s->kept_frame);
    bool torn = false;
    if (!shot_apply_settings(s, time_s, error, error_size) || !write_state(s, time_s, &torn, error, error_size))
        return false;
    go_on_from(s, s->kept_frame, time_s);
    return true;
}
