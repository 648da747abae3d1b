/* files.h - what a rendered frame leaves on disk: layered EXR, point caches, preview, a line of statistics. */
#ifndef VIRGA_TOOL_FRAME_FILES_H
#define VIRGA_TOOL_FRAME_FILES_H

#include "jsonl.h"
#include "shot/shot.h"

/* Layers are bits; which there are is for files.c to know. Bits of a list such as "beauty,rain"; NULL: all. Says
 * one line and returns false for a wrong name. */
bool frame_layers_parse(const char *list, uint32_t *layers);

/* Leaves out the layers that the scene has nothing for. Says one line and returns false where none is left. */
bool frame_layers_narrow(const scene_file *scene, uint32_t *layers);

/* Layers that a picture with these channels (as exr_header has them) holds, and their list as --layers takes it. */
uint32_t frame_layers_in(const char *channels);
void frame_layers_print(uint32_t layers, char *text, size_t size);

/* Prints what layers there are: a line each, with channels. */
void frame_layers_help(void);

/* Writes s->frame as DIR/frame.%04u.exr. */
bool frame_write_exr(shot *s, const host_camera *camera, const char *directory, uint32_t frame, uint32_t layers,
                     char *error, size_t error_size);

/* The same under any name. */
bool frame_save_exr(shot *s, const host_camera *camera, const char *path, uint32_t frame, uint32_t layers, char *error,
                    size_t error_size);
bool frame_save_preview(shot *s, const char *path, char *error, size_t error_size);

/* Writes DIR/preview.%04u.png. */
bool frame_write_preview(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size);

/* Point caches of a scene's frame: "rain.%04u.ply", "splash.%04u.ply", "glass.%04u.ply"; NULL behind the last. */
const char *frame_points_name(const scene_file *scene, uint32_t system);

/* Writes all of them to DIR. */
bool frame_write_points(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size);

/* Adds the frame's object to stats.jsonl: stats.c. */
bool frame_write_stats(shot *s, jsonl *stats, uint32_t frame, char *error, size_t error_size);

#endif
