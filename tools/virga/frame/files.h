/* files.h - what a rendered frame leaves on disk: layered EXR, point caches, preview, a line of statistics. */
#ifndef VIRGA_TOOL_FRAME_FILES_H
#define VIRGA_TOOL_FRAME_FILES_H

#include "jsonl.h"
#include "shot/shot.h"

/* Writes s->frame as DIR/frame.%04u.exr. */
bool frame_write_exr(shot *s, const host_camera *camera, const char *directory, uint32_t frame, uint32_t layers,
                     char *error, size_t error_size);

/* The same under any name. */
bool frame_save_exr(shot *s, const host_camera *camera, const char *path, uint32_t frame, uint32_t layers, char *error,
                    size_t error_size);
bool frame_save_preview(shot *s, const char *path, char *error, size_t error_size);

/* Writes DIR/preview.%04u.png. */
bool frame_write_preview(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size);

/* Point caches of a scene's frame: their names, without frame and ending; NULL behind the last. */
const char *frame_points_name(const scene_file *scene, uint32_t index);

/* Path of the one with that name. */
void frame_points_path(const char *directory, const char *name, uint32_t frame, char *path, size_t size);

/* Prints what point caches there are: a line each. */
void frame_points_help(void);

/* Writes all of them to DIR. */
bool frame_write_points(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size);

/* The same for triangle meshes; frame_points_path is theirs, too. */
const char *frame_mesh_name(const scene_file *scene, uint32_t index);
void frame_meshes_help(void);
bool frame_write_meshes(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size);

/* Adds the frame's line to stats.jsonl: stats.c. */
bool frame_write_stats(shot *s, jsonl *stats, uint32_t frame, char *error, size_t error_size);

#endif
