/* plate.h - footage that replaces the scene that a shot draws: pictures, one a frame, or one for all. */
#ifndef VIRGA_TOOL_PLATE_H
#define VIRGA_TOOL_PLATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "picture.h"

typedef struct plate {
    const char
        *pattern;   /* "shot/bg.%04d.exr", numbered as the frames are; a folder, whose pictures in the order of their
                          * names are the scene's frames; or one picture. NULL: none */
    uint32_t first; /* scene frame of a folder's first picture */
    char **files;   /* of a folder */
    uint32_t file_count;
    bool numbered;
    transfer_curve curve;
    uint32_t loaded; /* frame that `rgba` holds; UINT32_MAX: none */
    float *rgba;     /* linear light: width x height, rows from the top, alpha 1 */
    uint32_t width, height;
    bool warned; /* that pictures are resampled */
} plate;

/* Format and size of the first picture of a pattern, whose frames are as plate_open has them. */
bool plate_peek(const char *pattern, uint32_t scene_first, const uint32_t frames[2], picture_format *format,
                uint32_t size[2], char *error, size_t error_size);

/* Looks whether there is a picture for each of the frames, which need not be drawn all. One line in `error` where
 * not. */
bool plate_open(plate *p, const char *pattern, transfer_curve curve, uint32_t scene_first, const uint32_t frames[2],
                uint32_t width, uint32_t height, char *error, size_t error_size);
void plate_close(plate *p);

/* Loads the picture of a frame into p->rgba, resampled to the shot's size where it has another; the first time that
 * is said in a line on standard error. */
bool plate_load(plate *p, uint32_t frame, char *error, size_t error_size);

#endif
