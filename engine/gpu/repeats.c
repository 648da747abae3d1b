/* gpu/repeats.c - see repeats.h. */
#include "gpu/repeats.h"

#include "gpu/context.h"

#include <stdio.h>
#include <string.h>

#define FORGET_FRAMES 1000 /* a line that was not logged for so long is new again */
#define SETUP_LINES   8    /* times that a line is passed on before the first frame, when objects are created */

/* These are logged once by themselves, or only by calls that are rare. */
static bool is_counted(virga_log_level level, virga_log_id id)
{
    return level != VIRGA_LOG_INFO && id != VIRGA_LOG_NOT_DRAWN && id != VIRGA_LOG_FRAME_LOST &&
           id != VIRGA_LOG_SHRUNK && id != VIRGA_LOG_LIVE_OBJECTS && id != VIRGA_LOG_DEVICE_LOST;
}

/* FNV-1a. Numbers differ from frame to frame and are left out. */
static uint64_t key_of(virga_log_id id, const char *text)
{
    uint64_t hash = 14695981039346656037u ^ (uint64_t)id;
    for (; *text; text++)
        if (!strchr("0123456789.+-", *text))
            hash = (hash ^ (unsigned char)*text) * 1099511628211u;
    return hash ? hash : 1;
}

/* The entry of a line, which may replace the oldest one. */
static virga_repeat *entry_of(virga_context *context, uint64_t key)
{
    virga_repeat *oldest = &context->repeats[0];
    for (uint32_t i = 0; i < VIRGA_REPEATS; i++) {
        virga_repeat *entry = &context->repeats[i];
        if (entry->key == key && context->frame_index - entry->last_frame <= FORGET_FRAMES)
            return entry;
        if (entry->key == key || entry->last_frame < oldest->last_frame)
            oldest = entry;
        if (entry->key == key)
            break;
    }
    *oldest = (virga_repeat){.key = key, .first_frame = context->frame_index};
    return oldest;
}

static bool is_power_of_ten(uint64_t count)
{
    while (count >= 10 && count % 10 == 0)
        count /= 10;
    return count == 1;
}

void virga_repeats_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    virga_context *context = user;
    const virga_log *host = &context->host_log;
    char counted[VIRGA_LOG_LINE + 40];
    if (!host->fn)
        return;
    if (!is_counted(level, id)) {
        host->fn(host->user, level, id, text);
        return;
    }
    virga_repeat *entry = entry_of(context, key_of(id, text));
    entry->last_frame = context->frame_index;
    entry->count++;
    const bool in_setup = !context->frame_index && id != VIRGA_LOG_FRAME_ORDER;
    const bool is_new = entry->count <= (in_setup ? SETUP_LINES : 1);
    if (is_new)
        host->fn(host->user, level, id, text);
    else if (is_power_of_ten(entry->count)) {
        snprintf(counted, sizeof counted, "%s (%llu times so far)", text, (unsigned long long)entry->count);
        host->fn(host->user, level, id, counted);
    }
}
