/* start.c - restarts the rain with changed settings. If that fails, it restarts with the previous settings: pools may
 * be too large for the device, and the window should stay open then. */
#include "view/view.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A setting that applies from a restart on, with its value at the last successful start. */
struct view_started {
    char path[96];
    char value[200];
};

bool view_remember_start(viewer *v)
{
    free(v->started);
    v->started_count = 0;
    v->started = calloc(v->setting_count + 1, sizeof *v->started);
    if (!v->started) {
        snprintf(v->error, sizeof v->error, "out of memory");
        return false;
    }
    for (size_t i = 0; i < v->setting_count; i++) {
        const scene_setting *setting = &v->settings[i];
        view_started *kept = &v->started[v->started_count];
        if (!setting->restarts || setting->kind == SCENE_SETTING_TEXT)
            continue;
        memcpy(kept->path, setting->path, sizeof kept->path);
        scene_setting_print(setting, kept->value, sizeof kept->value);
        v->started_count++;
    }
    return true;
}

/* Skips settings of list entries that no longer exist. */
static void restore_settings(viewer *v)
{
    char error[400];
    for (size_t i = 0; i < v->started_count; i++) {
        const view_started *kept = &v->started[i];
        scene_setting *setting = scene_settings_find(v->settings, v->setting_count, kept->path);
        if (setting)
            scene_setting_parse(setting, kept->value, error, sizeof error);
    }
}

bool view_start_again(viewer *v)
{
    char why[sizeof v->error];
    memset(&v->numbers, 0, sizeof v->numbers);
    v->shot.focus_picked = false;
    if (shot_live_restart(&v->shot, v->error, sizeof v->error))
        return view_remember_start(v);
    snprintf(why, sizeof why, "%s", v->error);
    restore_settings(v);
    if (!shot_live_restart(&v->shot, v->error, sizeof v->error))
        return false;
    fprintf(stderr, "virga view: %s; started as before\n", why);
    view_print(v, "%s; started as before", why);
    return true;
}

bool view_seek(viewer *v)
{
    uint32_t from;
    memset(&v->numbers, 0, sizeof v->numbers);
    if (!shot_live_seek(&v->shot, v->checkpoints, v->seek_to, &from, v->error, sizeof v->error))
        return false;
    if (from == UINT32_MAX)
        view_print(v, "frame %u", v->seek_to);
    else if (from + 1 == v->scene->frames.first)
        view_print(v, "frame %u, from the checkpoint after the pre-roll", v->seek_to);
    else
        view_print(v, "frame %u, from the checkpoint of frame %u", v->seek_to, from);
    if (v->script)
        fprintf(stderr, "%s\n", v->message);
    return true;
}
