/* script.c - runs the viewer by commands in a file: for pictures of changed scenes, demonstrations and tests. */
#include "view/view.h"

#include "file.h"
#include "suggest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#define MAX_ARGUMENTS 8
#define MAX_BYTES     (1u << 20)

typedef struct script_line {
    uint32_t number; /* in the file, from 1 */
    uint32_t command, argument_count;
    char *arguments[MAX_ARGUMENTS]; /* after the command */
} script_line;

struct view_script {
    char *text;
    script_line *lines;
    size_t count, next;
    uint32_t wait; /* frames still to be drawn before the next line */
};

/* ---- commands: each returns whether it could be done; v->message says why not */

static bool read_count(viewer *v, const char *text, uint32_t low, uint32_t high, uint32_t *count)
{
    char *end;
    const unsigned long value = strtoul(text, &end, 10);
    if (*text < '0' || *text > '9' || *end || value < low || value > high) {
        view_print(v, "expected a whole number from %u to %u, got '%.40s'", low, high, text);
        return false;
    }
    *count = (uint32_t)value;
    return true;
}

static bool read_number(viewer *v, const char *text, double low, double high, double *number)
{
    char *end;
    const double value = strtod(text, &end);
    if (end == text || *end || !(value >= low && value <= high)) {
        view_print(v, "expected a number from %g to %g, got '%.40s'", low, high, text);
        return false;
    }
    *number = value;
    return true;
}

static bool read_switch(viewer *v, const char *text, bool *on)
{
    *on = !strcmp(text, "on");
    if (*on || !strcmp(text, "off"))
        return true;
    view_print(v, "expected on or off, got '%.40s'", text);
    return false;
}

static bool do_wait(viewer *v, const script_line *line)
{
    return read_count(v, line->arguments[0], 1, 1000000, &v->script->wait);
}

static bool do_set(viewer *v, const script_line *line)
{
    char assignment[600];
    size_t used = (size_t)snprintf(assignment, sizeof assignment, "%s=", line->arguments[0]);
    for (uint32_t i = 1; i < line->argument_count && used < sizeof assignment; i++)
        used +=
            (size_t)snprintf(assignment + used, sizeof assignment - used, "%s%s", i > 1 ? " " : "", line->arguments[i]);
    return view_assign(v, assignment);
}

static bool do_focus(viewer *v, const script_line *line)
{
    double at[2];
    return read_number(v, line->arguments[0], 0, 1, &at[0]) && read_number(v, line->arguments[1], 0, 1, &at[1]) &&
           view_focus_at(v, at[0], at[1]);
}

static bool do_add(viewer *v, const script_line *line)
{
    return view_list_add(v, line->arguments[0]);
}

static bool do_drop(viewer *v, const script_line *line)
{
    return view_list_drop(v, line->arguments[0]);
}

static bool do_preset(viewer *v, const script_line *line)
{
    return view_preset_apply(v, line->arguments[0]);
}

static bool do_view(viewer *v, const script_line *line)
{
    uint32_t layer = 0;
    return (line->argument_count < 2 || read_count(v, line->arguments[1], 0, 99, &layer)) &&
           view_show(v, line->arguments[0], layer);
}

static bool do_shot(viewer *v, const script_line *line)
{
    v->script->wait = 1;
    return view_shoot(v, line->arguments[0]);
}

static bool do_samples(viewer *v, const script_line *line)
{
    return read_count(v, line->arguments[0], 1, 256, &v->samples);
}

static bool do_window(viewer *v, const script_line *line)
{
    v->script->wait = 1;
    snprintf(v->window_shot, sizeof v->window_shot, "%s", line->arguments[0]);
    return true;
}

static bool do_save(viewer *v, const script_line *line)
{
    return view_save(v, line->arguments[0]);
}

static bool do_camera(viewer *v, const script_line *line)
{
    double numbers[5];
    for (int i = 0; i < 5; i++)
        if (!read_number(v, line->arguments[i], -1e6, 1e6, &numbers[i]))
            return false;
    view_camera_place(v, numbers, numbers[3], numbers[4]);
    return true;
}

static bool do_path(viewer *v, const script_line *line)
{
    (void)line;
    view_camera_to_path(v);
    return true;
}

static bool do_pause(viewer *v, const script_line *line)
{
    (void)line;
    v->paused = true;
    return true;
}

static bool do_play(viewer *v, const script_line *line)
{
    (void)line;
    v->paused = false;
    return true;
}

static bool do_step(viewer *v, const script_line *line)
{
    uint32_t count = 1;
    if (line->argument_count && !read_count(v, line->arguments[0], 1, 100000, &count))
        return false;
    v->paused = true;
    v->steps = count;
    v->script->wait = count;
    return true;
}

static bool do_speed(viewer *v, const script_line *line)
{
    return read_number(v, line->arguments[0], 0.05, 1, &v->speed);
}

static bool do_restart(viewer *v, const script_line *line)
{
    (void)line;
    v->restart = true;
    v->script->wait = 1;
    return true;
}

static bool do_seek(viewer *v, const script_line *line)
{
    if (!read_count(v, line->arguments[0], v->scene->frames.first, 999999, &v->seek_to))
        return false;
    v->paused = v->seeks = true;
    v->script->wait = 1;
    return true;
}

static bool do_resize(viewer *v, const script_line *line)
{
    uint32_t size[2];
    if (!read_count(v, line->arguments[0], 320, 8192, &size[0]) ||
        !read_count(v, line->arguments[1], 240, 8192, &size[1]))
        return false;
    glfwSetWindowSize(v->window.glfw, (int)size[0], (int)size[1]);
    v->script->wait = 3; /* until the display has done it */
    return true;
}

static bool do_panel(viewer *v, const script_line *line)
{
    return read_switch(v, line->arguments[0], &v->panel);
}

static bool do_unfold(viewer *v, const script_line *line)
{
    v->script->wait = 1;
    snprintf(v->unfold, sizeof v->unfold, "%s", line->arguments[0]);
    return read_switch(v, line->arguments[1], &v->unfold_open);
}

static bool do_divide(viewer *v, const script_line *line)
{
    return read_count(v, line->arguments[0], 1, 4, &v->divide);
}

/* Waits until the user has reached a state: for demonstrations, and for tests with real keys. */
static bool do_await(viewer *v, const script_line *line)
{
    const struct {
        const char *name;
        bool there;
    } states[] = {{"paused", v->paused},     {"playing", !v->paused}, {"flying", v->camera.free},
                  {"path", !v->camera.free}, {"panel", v->panel},     {"no-panel", !v->panel}};
    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++) {
        if (strcmp(states[i].name, line->arguments[0]))
            continue;
        if (!states[i].there) {
            v->script->wait = 1;
            v->script->next--; /* run this line again */
        }
        return true;
    }
    view_print(v, "expected paused, playing, flying, path, panel or no-panel, got '%.40s'", line->arguments[0]);
    return false;
}

static bool do_print(viewer *v, const script_line *line)
{
    (void)line;
    char state[80] = "";
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->print_state && !state[0])
            tool_effects[i]->print_state(v->scene, state, sizeof state);
    printf("time %.4f s, %s, %s, view %s, camera %s, %u x %u\n", v->shot.camera_time_s,
           v->paused ? "paused" : "playing", state, view_mode(v->mode)->name, v->camera.free ? "free" : "on its path",
           v->shot.target.width, v->shot.target.height);
    fflush(stdout);
    return true;
}

static bool do_quit(viewer *v, const script_line *line)
{
    (void)line;
    v->quit = true;
    return true;
}

static const struct {
    const char *name, *arguments, *help;
    uint32_t min_arguments, max_arguments;
    bool (*run)(viewer *v, const script_line *line);
} commands[] = {
    {"wait", "N", "draw N frames", 1, 1, do_wait},
    {"set", "KEY VALUE", "change a setting: set rain.rate_mm_h 50", 2, MAX_ARGUMENTS, do_set},
    {"add", "LIST", "append a copy of the last entry: add lights", 1, 1, do_add},
    {"drop", "LIST", "remove the last entry", 1, 1, do_drop},
    {"preset", "NAME", "drizzle, shower, storm, carwash or window", 1, 1, do_preset},
    {"view", "NAME [N]", "show a view, and which of its maps", 1, 2, do_view},
    {"shot", "FILE", "save the picture: .exr with all layers, or .png", 1, 1, do_shot},
    {"samples", "N", "sub-frames of saved pictures", 1, 1, do_samples},
    {"window", "FILE.png", "save the window with the panel", 1, 1, do_window},
    {"save", "FILE.yaml", "save the changed scene", 1, 1, do_save},
    {"camera", "X Y Z YAW PITCH", "move the camera (metres, degrees; 0 0 looks along -Z)", 5, 5, do_camera},
    {"focus", "X Y", "focus on that point: shares of width and height", 2, 2, do_focus},
    {"path", "", "back to the scene's camera path", 0, 0, do_path},
    {"pause", "", "stop time", 0, 0, do_pause},
    {"play", "", "continue", 0, 0, do_play},
    {"step", "[N]", "draw N frames, then stop time", 0, 1, do_step},
    {"speed", "X", "speed of time, 0.05 to 1", 1, 1, do_speed},
    {"restart", "", "restart the simulation with all settings", 0, 0, do_restart},
    {"seek", "FRAME", "go to that frame of the scene, and stop time", 1, 1, do_seek},
    {"resize", "W H", "resize the window, pixels", 2, 2, do_resize},
    {"panel", "on|off", "show or hide the panel", 1, 1, do_panel},
    {"unfold", "TITLE on|off", "open or close a part of the panel, by the start of its title", 2, 2, do_unfold},
    {"downscale", "1|2|4", "divide the picture's width and height", 1, 1, do_divide},
    {"await", "STATE", "wait for paused, playing, flying, path, panel or no-panel", 1, 1, do_await},
    {"print", "", "print the state on standard output", 0, 0, do_print},
    {"quit", "", "close the window; without this it stays open", 0, 0, do_quit},
};

#define COMMAND_COUNT (sizeof commands / sizeof commands[0])

void view_script_help(void)
{
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
        char left[64];
        snprintf(left, sizeof left, "%s %s", commands[i].name, commands[i].arguments);
        printf("      %-26s %s\n", left, commands[i].help);
    }
}

/* ---- reading */

static bool refuse(const char *path, uint32_t number, const char *word, char *error, size_t error_size)
{
    const char *names[COMMAND_COUNT], *near;
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        names[i] = commands[i].name;
    near = suggest_nearest(word, names, COMMAND_COUNT);
    return host_fail(error, error_size, "%s:%u: no command '%.40s'%s%s%s", path, number, word,
                     near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "");
}

/* Splits a line at spaces, up to a '#'. */
static bool read_line(const char *path, char *text, script_line *line, char *error, size_t error_size)
{
    char *at = NULL, *word = strtok_r(text, " \t\r", &at);
    line->command = 0;
    while (line->command < COMMAND_COUNT && strcmp(commands[line->command].name, word))
        line->command++;
    if (line->command == COMMAND_COUNT)
        return refuse(path, line->number, word, error, error_size);
    while ((word = strtok_r(NULL, " \t\r", &at)) && line->argument_count < MAX_ARGUMENTS)
        line->arguments[line->argument_count++] = word;
    if (word || line->argument_count < commands[line->command].min_arguments ||
        line->argument_count > commands[line->command].max_arguments)
        return host_fail(error, error_size, "%s:%u: expected %s %s", path, line->number, commands[line->command].name,
                         commands[line->command].arguments);
    return true;
}

static bool read_lines(view_script *script, const char *path, char *error, size_t error_size)
{
    uint32_t number = 1;
    for (char *text = script->text, *next; text; text = next, number++) {
        next = strchr(text, '\n');
        if (next)
            *next++ = 0;
        text[strcspn(text, "#")] = 0;
        text += strspn(text, " \t\r");
        if (!*text)
            continue;
        script_line *line = &script->lines[script->count++];
        line->number = number;
        if (!read_line(path, text, line, error, error_size))
            return false;
    }
    return true;
}

bool view_script_load(const char *path, view_script **script, char *error, size_t error_size)
{
    void *text = NULL;
    size_t size, max_lines = 2;
    *script = NULL;
    if (!file_read(path, MAX_BYTES, &text, &size, error, error_size))
        return false;
    view_script *made = calloc(1, sizeof *made);
    for (size_t i = 0; i < size; i++)
        max_lines += ((char *)text)[i] == '\n';
    if (made)
        made->lines = calloc(max_lines, sizeof *made->lines);
    if (!made || !made->lines) {
        free(text);
        free(made);
        return host_fail(error, error_size, "%s: out of memory", path);
    }
    made->text = text;
    *script = made;
    if (read_lines(made, path, error, error_size))
        return true;
    view_script_free(made);
    *script = NULL;
    return false;
}

void view_script_free(view_script *script)
{
    if (!script)
        return;
    free(script->lines);
    free(script->text);
    free(script);
}

/* ---- running */

bool view_script_run(viewer *v)
{
    view_script *script = v->script;
    if (script && script->wait) {
        script->wait--;
        if (script->wait)
            return true;
    }
    while (script && !script->wait && !v->quit && script->next < script->count) {
        const script_line *line = &script->lines[script->next++];
        if (!commands[line->command].run(v, line))
            return host_fail(v->error, sizeof v->error, "script, line %u: %s", line->number, v->message);
    }
    return true;
}
