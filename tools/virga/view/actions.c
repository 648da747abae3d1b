/* actions.c - the actions on a scene in the window, for keys, the panel and scripts. */
#include "view/view.h"

#include "effect.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#define MESSAGE_S 6.0

void view_print(viewer *v, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(v->message, sizeof v->message, format, arguments);
    va_end(arguments);
    v->message_s = glfwGetTime() + MESSAGE_S;
}

bool view_list_settings(viewer *v)
{
    free(v->settings);
    v->settings = scene_settings_list(v->scene, &v->setting_count);
    return v->settings;
}

bool view_assign(viewer *v, const char *assignment)
{
    char error[400];
    if (scene_settings_assign(v->scene, assignment, &v->needs_restart, error, sizeof error))
        return true;
    view_print(v, "%s", error);
    return false;
}

/* The command line's overrides and all changes since. Only the array is for free(). NULL with a message on failure. */
static const char **all_changes(viewer *v, char ***changes, size_t *count)
{
    size_t tuned = 0;
    *changes = scene_settings_changes(v->scene, v->loaded, &tuned);
    const char **all = *changes ? malloc((v->override_count + tuned + 1) * sizeof *all) : NULL;
    if (!all) {
        free(*changes);
        *changes = NULL;
        return NULL;
    }
    memcpy(all, v->overrides, v->override_count * sizeof all[0]);
    memcpy(all + v->override_count, *changes, tuned * sizeof all[0]);
    *count = v->override_count + tuned;
    return all;
}

scene_file *view_load_tuned(viewer *v, char *error, size_t error_size)
{
    size_t count;
    char **changes;
    scene_file *tuned = NULL;
    const char **all = all_changes(v, &changes, &count);
    if (!all)
        snprintf(error, error_size, "out of memory");
    else
        scene_file_load(v->path, tool_effect_sections, all, count, &tuned, error, error_size);
    free(all);
    free(changes);
    return tuned;
}

bool view_check(viewer *v)
{
    char error[400];
    scene_file *tuned = view_load_tuned(v, error, sizeof error);
    const bool good = tuned && shot_check_scene(tuned, error, sizeof error);
    scene_file_free(tuned);
    if (!good)
        view_print(v, "%s", error);
    return good;
}

/* Whether the effect of a list restarts when the length of the list changes. */
static bool list_restarts(const char *path)
{
    for (uint32_t i = 0; tool_effects[i]; i++) {
        const size_t length = strlen(tool_effects[i]->name);
        if (tool_effects[i]->lists_restart && !strncmp(path, tool_effects[i]->name, length) && path[length] == '.')
            return true;
    }
    return false;
}

/* Changes the length of a list; tries it on a copy first. */
static bool change_list(viewer *v, const char *path,
                        bool (*change)(scene_file *scene, const char *path, char *error, size_t error_size))
{
    char error[400];
    scene_file *scene = v->scene, *tried = view_load_tuned(v, error, sizeof error);
    bool good = tried && change(tried, path, error, sizeof error);
    if (!good) {
        view_print(v, "%s", error);
    } else {
        v->scene = tried;
        good = view_check(v);
        v->scene = scene;
    }
    scene_file_free(tried);
    if (!good)
        return false;
    good = change(scene, path, error, sizeof error) && view_list_settings(v);
    if (!good)
        view_print(v, "%s", error);
    v->restart = v->restart || list_restarts(path);
    return good;
}

bool view_list_add(viewer *v, const char *path)
{
    return change_list(v, path, scene_list_add);
}

bool view_list_drop(viewer *v, const char *path)
{
    return change_list(v, path, scene_list_drop);
}

bool view_is_animated(const viewer *v, const char **hint)
{
    for (uint32_t i = 0; tool_effects[i]; i++) {
        *hint = tool_effects[i]->animation_hint;
        if (tool_effects[i]->is_animated && tool_effects[i]->is_animated(v->scene))
            return true;
    }
    return false;
}

void view_stop_animation(viewer *v)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->stop_animation)
            tool_effects[i]->stop_animation(v->scene, v->shot.camera_time_s);
}

/* Applies a preset. It replaces the animation by the scene's keys, and restarts the rain if needed. */
bool view_preset_apply(viewer *v, const char *name)
{
    size_t count;
    const view_preset *presets = view_presets(&count), *preset = presets;
    const bool waited = v->needs_restart;
    while (preset < presets + count && strcmp(preset->name, name))
        preset++;
    if (preset == presets + count) {
        view_print(v, "no preset '%.40s'; there are drizzle, shower, storm, carwash, window", name);
        return false;
    }
    view_stop_animation(v);
    v->needs_restart = false;
    for (uint32_t i = 0; i < VIEW_PRESET_SETTINGS && preset->settings[i]; i++)
        if (!view_assign(v, preset->settings[i]))
            return false;
    const double before = v->loaded->environment.intensity;
    v->restart = v->restart || (v->needs_restart && v->scene->environment.intensity != before);
    v->needs_restart = waited;
    view_list_settings(v);
    view_print(v, "%s: %s", preset->title, preset->help);
    return true;
}

bool view_show(viewer *v, const char *mode, uint32_t item)
{
    const uint32_t found = view_mode_find(mode);
    const view_mode_row *row = view_mode(found);
    if (!row) {
        view_print(v, "no view '%.40s'; the list of views has their names", mode);
        return false;
    }
    const uint32_t items = view_mode_items(&v->shot, found);
    if (item >= items) {
        view_print(v, items ? "%s: expected a number below %u" : "%s: this scene has none", row->title, items);
        return false;
    }
    v->mode = found;
    v->item = item;
    if (row->view && row->view->debug_map && !v->shot.options.debug_maps) {
        v->shot.options.debug_maps = true; /* effects are created with them or without */
        v->restart = true;
    }
    view_print(v, "%s: %s", row->title, row->help);
    return true;
}

/* Whether showing it needs no restart. */
static bool is_ready(const viewer *v, uint32_t mode)
{
    const tool_view *view = view_mode(mode)->view;
    return view_mode_items(&v->shot, mode) && (!view || !view->debug_map || v->shot.options.debug_maps);
}

void view_show_next(viewer *v, int step)
{
    uint32_t mode = v->mode;
    do
        mode = (mode + (uint32_t)((int)view_mode_count() + step)) % view_mode_count();
    while (!is_ready(v, mode));
    view_show(v, view_mode(mode)->name, 0);
}

bool view_save(viewer *v, const char *path)
{
    char error[400] = "out of memory";
    size_t count = 0;
    char **changes;
    const char **all = all_changes(v, &changes, &count);
    const bool saved = all && scene_settings_save(v->path, tool_effect_sections, all, count, path, error, sizeof error);
    free(all);
    free(changes);
    if (saved)
        view_print(v, "saved %s with %zu settings that are not the file's", path, count);
    else
        view_print(v, "%s", error);
    return saved;
}

bool view_shoot(viewer *v, const char *path)
{
    const char *dot = strrchr(path, '.');
    if (!dot || (strcmp(dot, ".png") && strcmp(dot, ".exr")) || strlen(path) >= sizeof v->shot_file) {
        view_print(v, "%.80s: expected a name that ends in .png or .exr", path);
        return false;
    }
    snprintf(v->shot_file, sizeof v->shot_file, "%s", path);
    return true;
}

/* ---- keys */

static const char *const key_lines[] = {
    "left mouse button: focus on what is there, if camera.aperture_f is above 0",
    "right mouse button: look around   W A S D, Q E: fly (Shift: faster)   C: back to the camera's path",
    "Space: pause     N: one frame on     [ ]: slower, faster     R: start anew     1 to 5: presets",
    "V, Shift V: next, previous view   B: picture   P: screenshot   F2: save   Tab: panel   Esc: quit",
};

const char *view_key_help(uint32_t line)
{
    return line < sizeof key_lines / sizeof key_lines[0] ? key_lines[line] : NULL;
}

static void change_speed(viewer *v, double factor)
{
    v->speed *= factor;
    v->speed = v->speed < 0.05 ? 0.05 : v->speed > 1 ? 1 : v->speed;
    view_print(v, "time goes at %.2f of its speed", v->speed);
}

static void shoot_by_key(viewer *v)
{
    char path[64];
    snprintf(path, sizeof path, "virga-%03u.exr", ++v->shots);
    view_shoot(v, path);
}

static void apply_numbered(viewer *v, int number)
{
    size_t count;
    const view_preset *presets = view_presets(&count);
    if ((size_t)number < count)
        view_preset_apply(v, presets[number].name);
}

void view_key(viewer *v, int key, bool shift)
{
    switch (key) {
    case GLFW_KEY_SPACE: v->paused = !v->paused; break;
    case GLFW_KEY_N:
        v->paused = true;
        v->steps++;
        break;
    case GLFW_KEY_LEFT_BRACKET: change_speed(v, 1 / 1.25); break;
    case GLFW_KEY_RIGHT_BRACKET: change_speed(v, 1.25); break;
    case GLFW_KEY_R: v->restart = true; break;
    case GLFW_KEY_C: view_camera_to_path(v); break;
    case GLFW_KEY_V: view_show_next(v, shift ? -1 : 1); break;
    case GLFW_KEY_B: view_show(v, "picture", 0); break;
    case GLFW_KEY_P: shoot_by_key(v); break;
    case GLFW_KEY_F2: view_save(v, "virga-tuned.yaml"); break;
    case GLFW_KEY_TAB: v->panel = !v->panel; break;
    case GLFW_KEY_ESCAPE: v->quit = true; break;
    default:
        if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9)
            apply_numbered(v, key - GLFW_KEY_1);
    }
}
