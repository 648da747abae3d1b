/* plate_files.h - the files of footage: one a frame, or one for all. */
#ifndef VIRGA_TOOL_PLATE_FILES_H
#define VIRGA_TOOL_PLATE_FILES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct plate_files {
    const char *option;              /* "--plate", for errors */
    const char *endings;             /* "EXR, PNG, JPEG or TIFF", for errors */
    bool (*takes)(const char *name); /* whether a name is that of such a picture */
    const char *pattern; /* "shot/bg.%04d.exr", numbered as the frames are; a folder, whose pictures in the order of
                          * their names are the scene's frames; or one picture */
    uint32_t first;      /* scene frame of a folder's first picture */
    char **files;        /* of a folder */
    uint32_t file_count;
    bool numbered;
} plate_files;

/* Finds out what the pattern is, and whether there is a picture for each of the frames. One line in `error` if not.
 * plate_files_close in both cases. */
bool plate_files_open(plate_files *p, const uint32_t frames[2], char *error, size_t error_size);
void plate_files_close(plate_files *p);

/* The picture of a frame. */
bool plate_files_name(const plate_files *p, uint32_t frame, char path[4096], char *error, size_t error_size);

#endif
