/* files.h - what a rendered frame leaves on disk: layered EXR, point caches, preview, a line of statistics. */
#ifndef VIRGA_TOOL_FRAME_FILES_H
#define VIRGA_TOOL_FRAME_FILES_H

#include "jsonl.h"
#include "picture.h"
#include "shot/shot.h"

/* Writes a picture that the shot drew as DIR/frame.%04u.exr. What these functions read of the shot stays the same while
 * it is open. */
bool frame_write_exr(const shot *s, const host_drawn *picture, const host_camera *camera, const char *directory,
                     uint32_t frame, uint32_t layers, char *error, size_t error_size);

/* The same under any name. */
bool frame_save_exr(const shot *s, const host_drawn *picture, const host_camera *camera, const char *path,
                    uint32_t frame, uint32_t layers, char *error, size_t error_size);
bool frame_save_preview(const shot *s, const host_drawn *picture, const char *path, char *error, size_t error_size);

/* Writes DIR/preview.%04u.png. */
bool frame_write_preview(const shot *s, const host_drawn *picture, const char *directory, uint32_t frame, char *error,
                         size_t error_size);

/* The beauty: layers over the plate, linear RGBA. */
void frame_compose(const shot *s, const host_drawn *picture, float *beauty);

/* Writes the beauty as DIR/picture.%04u.png, .jpg or .tif, with the transfer curve of the plate: picture.c. */
bool frame_write_picture(const shot *s, const host_drawn *drawn, const char *directory, uint32_t frame,
                         picture_format format, char *error, size_t error_size);

/* The same under any name; `seed` is that of the dither. */
bool frame_save_picture(const shot *s, const host_drawn *drawn, const char *path, uint64_t seed, picture_format format,
                        char *error, size_t error_size);
void frame_picture_path(const char *directory, picture_kind kind, uint32_t frame, char *path, size_t size);

/* Reads the value of --picture, `word` (NULL: not given). `plate` is the format of the plate, NULL without one.
 * to->bits is 0 where no picture is to be written. Prints one line and returns false for a wrong word. */
bool frame_picture_parse(const char *word, const picture_format *plate, picture_format *to);

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

/* The same for volumes. */
const char *frame_volume_name(const scene_file *scene, uint32_t index);
void frame_volume_path(const char *directory, const char *name, uint32_t frame, char *path, size_t size);
void frame_volumes_help(void);
bool frame_write_volumes(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size);

/* Adds the frame's line to stats.jsonl: stats.c. */
bool frame_write_stats(shot *s, jsonl *stats, uint32_t frame, char *error, size_t error_size);

#endif
