/* video_table.h - what the module of FFmpeg gives to video.c. */
#ifndef VIRGA_IO_VIDEO_TABLE_H
#define VIRGA_IO_VIDEO_TABLE_H

#include "video.h"

/* As in video.h; `reason` gets one line without the path. */
typedef struct video_table {
    void *(*open)(const char *path, uint32_t *count, char *reason, size_t reason_size);
    void (*close)(void *stream);
    bool (*read)(void *stream, uint32_t index, picture *p, char *reason, size_t reason_size);
} video_table;

#define VIDEO_TABLE virga_video
extern const video_table VIDEO_TABLE;

#endif
