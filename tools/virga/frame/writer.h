/* writer.h - frames are encoded and written by a thread while the next one is drawn. */
#ifndef VIRGA_TOOL_FRAME_WRITER_H
#define VIRGA_TOOL_FRAME_WRITER_H

#include "picture.h"
#include "shot/shot.h"

#include <pthread.h>

typedef struct frame_writer {
    const shot *shot;
    const char *directory;
    uint32_t layers;
    bool preview;
    picture_format format; /* of the beauty as a picture; bits 0: none */
    host_drawn drawn;      /* of the frame that is being written */
    host_camera camera;
    uint32_t frame, written;                        /* written: frames that are whole */
    void (*on_written)(void *user, uint32_t frame); /* called by the thread once a frame is whole; may be NULL */
    void *user;
    bool busy, failed; /* busy: `thread` runs, or has ended and was not waited for */
    pthread_t thread;
    char error[1024];
} frame_writer;

bool frame_writer_open(frame_writer *writer, const shot *s, const char *directory, uint32_t layers, bool preview,
                       picture_format format, char *error, size_t error_size);

/* Begins to write s->frame, the EXR as the last file, and gives the shot another picture to draw into. After
 * frame_writer_wait. */
void frame_writer_begin(frame_writer *writer, shot *s, const host_camera *camera, uint32_t frame);

/* Waits until the last frame is written. False, and one line in `error`: it is not. */
bool frame_writer_wait(frame_writer *writer, char *error, size_t error_size);

/* Waits as well. Accepts one that is all zero. */
void frame_writer_close(frame_writer *writer);

#endif
