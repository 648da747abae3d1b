/* frame_files.h - what a rendered frame leaves on disk: layered EXR, point cache, preview, a line of statistics. */
#ifndef VIRGA_TOOL_FRAME_FILES_H
#define VIRGA_TOOL_FRAME_FILES_H

#include "jsonl.h"
#include "shot.h"

/* Layers that may be asked for, in the order of --layers. */
enum {
    LAYER_BEAUTY = 1 << 0,   /* R G B A */
    LAYER_DEPTH = 1 << 1,    /* Z */
    LAYER_RAIN = 1 << 2,     /* rain.R G B A */
    LAYER_VELOCITY = 1 << 3, /* velocity.X Y */
    LAYER_NORMAL = 1 << 4,   /* normal.X Y Z */
    LAYER_ID = 1 << 5,       /* id.Y */
    LAYER_WETNESS = 1 << 6,  /* wetness.Y */
    LAYER_DEPTHS = 1 << 7,   /* waterdepth.Y */
    LAYER_ALL = (1 << 8) - 1,
};

/* Bits of a list such as "beauty,rain"; NULL: all. Says one line and returns false for a wrong name. */
bool frame_layers_parse(const char *list, uint32_t *layers);

/* Layers that a picture with these channels (as exr_header has them) holds, and their list as --layers takes it. */
uint32_t frame_layers_in(const char *channels);
void frame_layers_print(uint32_t layers, char *text, size_t size);

/* Writes s->frame as DIR/frame.%04u.exr. */
bool frame_write_exr(shot *s, const host_camera *camera, const char *directory, uint32_t frame, uint32_t layers,
                     char *error, size_t error_size);

/* Writes DIR/preview.%04u.png. */
bool frame_write_preview(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size);

/* Writes DIR/rain.%04u.ply. */
bool frame_write_points(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size);

/* Adds the frame's object to stats.jsonl. */
bool frame_write_stats(shot *s, jsonl *stats, uint32_t frame, char *error, size_t error_size);

#endif
