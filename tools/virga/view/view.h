/* view.h - a scene in a window, played with: what the files of `virga view` share. commands/view.c opens it and runs
 * the loop; here are:
 *
 *   frame.c     one frame: time, picture, panel, screenshots
 *   actions.c   what keys, buttons and scripts do
 *   start.c     starting the rain anew
 *   camera.c    the camera that flies
 *   script.c    lines that drive it
 *   panel.cpp   the panel; C++ as Dear ImGui is, with its parts in panel_*.cpp
 *   picture.c   what is shown beside it
 *   modes.c     the list of what can be shown
 *   presets.c   the list of presets
 *   window.c    window and swapchain
 */
#ifndef VIRGA_VIEW_H
#define VIRGA_VIEW_H

#ifdef __cplusplus
extern "C" {
#endif

#include "scene_changes.h"
#include "scene_lists.h"
#include "scene_settings.h"
#include "shot/shot.h"
#include "view/picture.h"
#include "view/presets.h"
#include "view/window.h"

#define VIEW_HISTORY    180 /* frames that graphs show */
#define VIEW_MAX_TIMES  64
#define VIEW_MAX_COUNTS 32
#define VIEW_PANEL_PX   430

/* The newest VIEW_HISTORY values of something, the oldest first from `next` on. */
typedef struct view_graph {
    float values[VIEW_HISTORY];
    uint32_t next;
} view_graph;

typedef struct view_pass {
    const char *name;
    view_graph milliseconds;
    double newest;
} view_pass;

/* The data of graphs and numbers, read from the library after each frame. */
typedef struct view_numbers {
    view_pass passes[VIEW_MAX_TIMES];
    uint32_t pass_count;
    view_graph frame_ms, device_ms, memory_mib;
    view_graph counts[VIEW_MAX_COUNTS]; /* of all effects, in their order */
    double frame_now_ms, device_now_ms;
    virga_memory_stats memory;
} view_numbers;

/* The free camera. */
typedef struct view_camera {
    bool free; /* false: on the scene's path */
    double position_m[3];
    double yaw, pitch; /* rad; 0 looks along -Z, positive is to the left and up */
    double speed_m_s;
    host_camera_key last; /* its position a frame ago */
    bool looking;         /* the mouse rotates it */
    double mouse[2];
} view_camera;

typedef struct view_script view_script;
typedef struct view_started view_started;

typedef struct viewer {
    scene_file *scene, *loaded; /* as changed by the user; as loaded from the file and the command line */
    const char *path;           /* of the file */
    const char *checkpoints;    /* folder of checkpoints, or NULL */
    const char *const *overrides;
    size_t override_count;
    scene_setting *settings; /* of `scene` */
    size_t setting_count;
    view_started *started; /* settings that need a restart, with their values at the newest start */
    size_t started_count;

    shot shot;
    view_window window;
    view_picture picture;
    view_numbers numbers;
    view_camera camera;
    host_camera seen; /* of the newest frame */

    /* Time. */
    bool paused;
    uint32_t steps; /* frames to advance while paused */
    double speed;   /* relative to real time, [0.05; 1] */
    double wall_s;  /* start of the newest frame */

    /* What is shown. */
    uint32_t mode, item; /* see modes.h */
    bool panel;
    uint32_t divide; /* 1, 2 or 4: the picture's sides are the window's divided by it */
    char unfold[40]; /* title of a part of the panel to open or close; true: open */
    bool unfold_open;
    char message[512]; /* one line for the user */
    double message_s;  /* time at which it disappears */

    /* Focus. */
    bool mouse_down, picking; /* the left button is down; the pixel below is to be focused on */
    uint32_t pick_at[2];      /* px of the picture */

    /* Work to do between frames. */
    bool restart, quit;
    bool seeks; /* to the frame `seek_to` */
    uint32_t seek_to;
    bool needs_restart;     /* a changed setting needs a restart */
    char window_shot[1024]; /* file for a picture of the window, or empty */
    char shot_file[1024];   /* file for a picture of the scene, or empty */
    uint32_t shots;         /* screenshots saved by key so far; part of their names */
    uint32_t samples;       /* of screenshots */

    view_script *script; /* NULL: none */
    uint64_t frame;      /* frames drawn so far */
    char error[1024];
    bool failed;
} viewer;

/* ---- actions.c: each says what it did, or why not, in v->message; false where it could not */

void view_print(viewer *v, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool view_assign(viewer *v, const char *assignment);

/* Loads the scene with all changes, as a saved file would have them. NULL with one line in `error` if it is not valid.
 * */
scene_file *view_load_tuned(viewer *v, char *error, size_t error_size);

/* Whether the changed scene is valid. Shows the reason if not. */
bool view_check(viewer *v);

/* Appends or removes an entry at the end of a list, if the scene stays valid. */
bool view_list_add(viewer *v, const char *path);
bool view_list_drop(viewer *v, const char *path);

/* Whether keys of the scene animate settings, with a hint for the user; stops the animation. */
bool view_is_animated(const viewer *v, const char **hint);
void view_stop_animation(viewer *v);

bool view_preset_apply(viewer *v, const char *name);
bool view_show(viewer *v, const char *mode, uint32_t item);
void view_show_next(viewer *v, int step);
bool view_save(viewer *v, const char *path);

/* Saves a picture of the scene between frames: "name.png" or "name.exr". */
bool view_shoot(viewer *v, const char *path);

/* A key, by its GLFW number. */
void view_key(viewer *v, int key, bool shift);

/* A line of the keyboard help; NULL after the last. */
const char *view_key_help(uint32_t line);

/* Lists the settings again, after lists of the scene have changed. */
bool view_list_settings(viewer *v);

/* ---- start.c */

/* Stores the settings that the rain has started with. False: v->error has the reason. */
bool view_remember_start(viewer *v);

/* Restarts the rain between frames. If it can not start with the changed settings, it starts with the previous ones and
 * the reason is shown. False: both failed, see v->error. */
bool view_start_again(viewer *v);

/* Goes to the frame v->seek_to between frames, see shot_live_seek. */
bool view_seek(viewer *v);

/* ---- frame.c */

/* One iteration of the loop. False: it can not continue, v->error says why. */
bool view_frame(viewer *v);

/* ---- camera.c */

void view_camera_to_path(viewer *v);
void view_camera_place(viewer *v, const double position_m[3], double yaw_deg, double pitch_deg);

/* Moves the camera by keys and mouse for `wall_s` of real time, and sets it in the shot, which advances by `dt_s`. */
void view_camera_move(viewer *v, double wall_s, double dt_s);

/* ---- focus.c */

/* Focuses on what is at a share of the picture, right and down, from the next frame on. */
bool view_focus_at(viewer *v, double x, double y);

/* Reads the mouse, and moves the focus towards what was picked. `area` is where the picture lies. */
void view_focus_move(viewer *v, const float area[4], double time_s);

/* After a frame that has copied the picked pixel. False: v->error says why. */
bool view_focus_pick(viewer *v);

/* ---- script.c */

/* Reads a script; false with one line in `error`. */
bool view_script_load(const char *path, view_script **script, char *error, size_t error_size);
void view_script_free(view_script *script);

/* Runs the next lines, before a frame is drawn. False: v->error names the line that failed. */
bool view_script_run(viewer *v);
void view_script_help(void);

/* ---- panel.cpp */

bool view_panel_open(viewer *v, char *error, size_t error_size);
void view_panel_close(viewer *v);

/* Builds the panel of this frame, and carries out the user's input. */
void view_panel_build(viewer *v);
void view_panel_draw(VkCommandBuffer cmd);

/* panel_parts.cpp: whether the panel uses the mouse or the keyboard now. */
bool view_panel_has_mouse(void);
bool view_panel_has_keys(void);

#ifdef __cplusplus
}
#endif
#endif
