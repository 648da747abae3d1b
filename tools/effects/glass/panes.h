/* panes.h - the panes of a shot: what the files of the effect `glass` share. */
#ifndef VIRGA_EFFECTS_GLASS_PANES_H
#define VIRGA_EFFECTS_GLASS_PANES_H

#include "effect.h"
#include "glass.h"

typedef struct glass_pane {
    const scene_pane *from;
    virga_glass *glass;
    virga_glass_settings settings;
    float *positions; /* columns x rows points in its own frame, see virga_glass_shape */
    uint32_t columns, rows;
    bool round;           /* its glass is the ellipse in it */
    virga_scene_pane now; /* at the frame that the simulation stands at */
    host_mesh frame;      /* around it; no vertices: none */
    host_mesh wipers;     /* likewise */
    shot_read read;
} glass_pane;

typedef struct glass_state {
    virga_glass_def *defs;
    glass_pane *panes;
    virga_scene_pane *placed; /* as the newest step has them */
    uint32_t count;
    scene_pane front; /* the drops on the lens, behind the scene's panes where it has them */
    scene_wiper front_wiper;
} glass_state;

/* ---- glass.c: the rows of panes */

const scene_group *scene_pane_group(void);
const scene_group *scene_wiper_group(void);

/* ---- condensation.c: fog */

extern const scene_group scene_condensation_group;
void glass_fill_condensation(const scene_condensation *from, double time_s, virga_glass_condensation *to);
/* Gives the library all breaths of a scene on a new pane. */
bool glass_breathe(shot *s, const glass_pane *pane, char *error, size_t error_size);

/* ---- front.c: the drops on the camera's lens */

/* Whether a scene has them. */
bool glass_has_front(const scene_file *scene);

/* Makes their pane from the section `lens`. It refers to `wiper` and to values of the scene. */
void glass_fill_front(const scene_file *scene, scene_pane *to, scene_wiper *wiper);

/* ---- settings.c */

/* Whether the contact angles of panes go together. */
bool glass_check(const scene_file *scene, char *error, size_t error_size);
bool glass_apply(shot *s, void *state, double time_s, char *error, size_t error_size);

/* ---- shape.c: shapes and pictures */

bool glass_check_pictures(const scene_file *scene, char *error, size_t error_size);
bool glass_check_files(const scene_file *scene, char *error, size_t error_size);

/* Fills pane->positions, columns and rows, and gives the library the pane's shape. */
bool glass_create_shape(shot *s, glass_pane *pane, uint32_t index, char *error, size_t error_size);

/* The point at (u, v) of a pane's shape in its own frame, also beyond its edges, and the outward normal. */
void glass_point(const glass_pane *pane, double u, double v, double point[3], double normal[3]);

/* ---- pose.c: where panes are */

/* The pose of a pane, for a camera at `time_s` of its path. */
void glass_pose(const shot *s, const scene_pane *pane, double time_s, virga_glass_pose *pose);

/* The current pose, and that of the previous frame. */
void glass_pose_moving(const shot *s, const scene_pane *pane, double camera_s, virga_glass_pose *pose);

/* The pose and the motion of a pane at a frame's time. */
void glass_place(const shot *s, const scene_pane *pane, double time_s, virga_scene_pane *out);

/* ---- wipers.c: what is seen of a pane beside its drops */

/* Creates pane->frame and pane->wipers and adds them to the renderer, where the pane has them. */
bool glass_create_mesh(shot *s, glass_pane *pane, char *error, size_t error_size);

/* Records the update of both for a sub-frame that ends at a time. Outside a render pass. */
bool glass_move_mesh(shot *s, const glass_pane *pane, VkCommandBuffer cmd, double time_s, char *error,
                     size_t error_size);

/* ---- view.c */

#define GLASS_VIEWS  2
#define GLASS_COUNTS 1

extern const tool_view glass_views[GLASS_VIEWS];
extern const tool_count glass_counts[GLASS_COUNTS];
bool glass_print_entry(const scene_file *scene, uint32_t entry, char *title, size_t size);
bool glass_main_setting(const scene_file *scene, uint32_t index, char *path, size_t path_size, char *caption,
                        size_t caption_size);
bool glass_fill_budget(const void *state, uint32_t index, tool_budget *budget);

/* ---- bench.c */

extern const tool_bench glass_bench;

/* ---- points.c */

extern const tool_points glass_points;

#endif
