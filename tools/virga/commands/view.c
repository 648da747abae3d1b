/* view.c - `virga view`: a scene in a window, with a panel of all its settings. */
#include "view/view.h"

#include "commands/commands.h"
#include "effect.h"
#include "options.h"
#include "progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

static const option_row rows[] = {
    {"--window", 0, "WxH", "size of the window in pixels. Default 1600x900", false},
    {"--downscale", 0, "N", "1, 2 or 4: divides the picture's width and height. Default 1; on software Vulkan 2",
     false},
    {"--checkpoints", 0, "DIR",
     "folder with checkpoints of virga render --checkpoint-every: going to a frame starts from the nearest one", false},
    {"--script", 0, "FILE", "run the commands in a file, see below", false},
    {"--seed", 0, "N", "seed of all that is random. Default: the scene's", false},
    {"--device", 0, "N|cpu|gpu|NAME", "the Vulkan device, see virga info. Default: the best", false},
    {"--set", 0, "KEY=VALUE", "override a key of the scene, e.g. rain.rate_mm_h=50. May be repeated", true},
};

#define HELP_COLUMNS 100
#define ROW_COUNT    (sizeof rows / sizeof rows[0])

static void print_views(void)
{
    size_t column = (size_t)printf("\nViews:") - 1;
    for (uint32_t mode = 0; view_mode(mode); mode++) {
        const char *name = view_mode(mode)->name, *comma = view_mode(mode + 1) ? "," : "\n";
        if (column + strlen(name) + 2 > HELP_COLUMNS)
            column = (size_t)printf("\n      ") - 1;
        column += (size_t)printf(" %s%s", name, comma);
    }
}

void view_help(void)
{
    printf("virga view SCENE.yaml [options]\n\n"
           "Shows a scene in a window, with all of its settings on a panel. The mouse and W A S D move the\n"
           "camera. Save writes the changed scene as a YAML file for virga render. Comments of the original\n"
           "file are lost.\n\n");
    options_print(rows, ROW_COUNT);
    printf("\nKeys:\n");
    for (uint32_t line = 0; view_key_help(line); line++)
        printf("  %s\n", view_key_help(line));
    print_views();
    printf("\nCommands of a script, one per line; '#' starts a comment. Each drawn frame is a frame of the scene:\n");
    view_script_help();
    printf("\nExamples:\n"
           "  virga view assets/scenes/street.yaml\n"
           "  virga view assets/scenes/windshield.yaml --downscale 2 --set rain.rate_mm_h=60\n"
           "  xvfb-run -a virga view assets/scenes/street.yaml --script tour.txt --device cpu\n\n"
           "Exit codes: 0 closed, 1 failed (no display, device lost), 2 wrong command line, scene or script.\n");
}

/* ---- opening */

/* Numbers and files that are wrong are said before a window opens. */
static bool read_options(viewer *v, options *parsed, uint32_t window[2], int argc, char **argv)
{
    if (!options_parse(parsed, "view", rows, ROW_COUNT, argc, argv))
        return false;
    if (parsed->argument_count != 1)
        return options_complain("view", "expected one scene file, got %zu; see virga help view",
                                parsed->argument_count);
    const char *script = options_value(parsed, "--script");
    v->path = parsed->arguments[0];
    v->checkpoints = options_value(parsed, "--checkpoints");
    if (!options_pair(parsed, "--window", 'x', false, 320, 8192, window) ||
        !options_uint(parsed, "--downscale", 1, 4, &v->divide))
        return false;
    return !script || view_script_load(script, &v->script, v->error, sizeof v->error) ||
           options_complain("view", "%s", v->error);
}

/* --seed is one more override. */
static bool load_scene(viewer *v, const options *parsed, const char *overrides[257], char seed[64])
{
    uint32_t value = 0;
    memcpy(overrides, parsed->repeated, parsed->repeated_count * sizeof overrides[0]);
    v->overrides = overrides;
    v->override_count = parsed->repeated_count;
    if (options_value(parsed, "--seed")) {
        if (!options_uint(parsed, "--seed", 0, UINT32_MAX, &value))
            return false;
        snprintf(seed, 64, "%s=%u", tool_seed_key(), value);
        overrides[v->override_count++] = seed;
    }
    if (!scene_file_load(v->path, tool_effect_sections, overrides, v->override_count, &v->loaded, v->error,
                         sizeof v->error) ||
        !scene_file_load(v->path, tool_effect_sections, overrides, v->override_count, &v->scene, v->error,
                         sizeof v->error)) {
        fprintf(stderr, "%s\n", v->error);
        return false;
    }
    return view_list_settings(v) || options_complain("view", "out of memory");
}

static bool open_shot(viewer *v, const options *parsed, const uint32_t window[2])
{
    shot_options how = {.device = options_value(parsed, "--device"),
                        .width = window[0] / 2,
                        .height = window[1] / 2,
                        .samples = 1,
                        .draw = true,
                        .stats = true,
                        .live = true};
    how.window_extensions = view_window_extensions(&how.window_extension_count);
    if (!shot_open(&v->shot, v->scene, &how, v->error, sizeof v->error))
        return false;
    if (!v->divide)
        v->divide = v->shot.info.type == VK_PHYSICAL_DEVICE_TYPE_CPU ? 2 : 1;
    return true;
}

static void on_key(GLFWwindow *glfw, int key, int scancode, int action, int mods)
{
    (void)scancode;
    viewer *v = glfwGetWindowUserPointer(glfw);
    if (action == GLFW_PRESS && !view_panel_has_keys())
        view_key(v, key, mods & GLFW_MOD_SHIFT);
}

static bool open_all(viewer *v, const options *parsed, const uint32_t window[2])
{
    char title[600];
    char *error = v->error;
    const size_t size = sizeof v->error;
    snprintf(title, sizeof title, "virga view - %.500s", v->path);
    if (!view_window_open(&v->window, title, window[0], window[1], error, size) || !open_shot(v, parsed, window) ||
        !view_window_attach(&v->window, &v->shot.instance, &v->shot.device, error, size) ||
        !view_picture_create(&v->shot.device, &v->window, &v->picture, error, size))
        return false;
    /* Before the panel, which calls on what was there before it. */
    glfwSetWindowUserPointer(v->window.glfw, v);
    glfwSetKeyCallback(v->window.glfw, on_key);
    return view_panel_open(v, error, size);
}

static void close_all(viewer *v)
{
    if (v->shot.device.device)
        vkDeviceWaitIdle(v->shot.device.device);
    view_panel_close(v);
    view_picture_destroy(&v->picture);
    view_window_detach(&v->window);
    if (v->shot.scene)
        shot_close(&v->shot);
    view_window_close(&v->window);
}

/* ---- the command */

static int run_window(viewer *v, const options *parsed, const uint32_t window[2])
{
    bool good = open_all(v, parsed, window) && view_remember_start(v);
    const bool opened = good, input_wrong = v->shot.input_wrong;
    v->wall_s = good ? glfwGetTime() : 0;
    while (good && !v->quit && !interrupt_requested())
        good = view_frame(v);
    close_all(v);
    if (good)
        return EXIT_OK;
    options_complain("view", "%s", v->error);
    const bool by_script = opened && !strncmp(v->error, "script", 6);
    return (!opened && input_wrong) || by_script ? EXIT_USAGE : EXIT_FAILED;
}

int view_run(int argc, char **argv)
{
    options parsed;
    const char *overrides[257];
    char seed[64];
    uint32_t window[2] = {1600, 900};
    int code = EXIT_USAGE;
    viewer *v = calloc(1, sizeof *v);
    if (!v)
        return EXIT_FAILED;
    v->speed = 1;
    v->panel = true;
    v->samples = 1;
    if (read_options(v, &parsed, window, argc, argv) && load_scene(v, &parsed, overrides, seed))
        code = run_window(v, &parsed, window);
    view_script_free(v->script);
    free(v->settings);
    free(v->started);
    scene_file_free(v->scene);
    scene_file_free(v->loaded);
    free(v);
    return code;
}
