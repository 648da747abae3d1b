/* writer.c - the thread that encodes and writes frames. */
#include "frame/writer.h"

#include "frame/files.h"

#include <string.h>

bool frame_writer_open(frame_writer *w, const shot *s, const char *directory, uint32_t layers, bool preview,
                       picture_format format, char *error, size_t error_size)
{
    *w = (frame_writer){.shot = s, .directory = directory, .layers = layers, .preview = preview, .format = format};
    return host_drawn_create(s->frame.width, s->frame.height, &w->drawn, error, error_size);
}

static void *write_frame(void *data)
{
    frame_writer *w = data;
    const size_t size = sizeof w->error;
    w->failed = (w->format.bits &&
                 !frame_write_picture(w->shot, &w->drawn, w->directory, w->frame, w->format, w->error, size)) ||
                (w->preview && !frame_write_preview(w->shot, &w->drawn, w->directory, w->frame, w->error, size)) ||
                !frame_write_exr(w->shot, &w->drawn, &w->camera, w->directory, w->frame, w->layers, w->error, size);
    w->written += !w->failed;
    if (!w->failed && w->on_written)
        w->on_written(w->user, w->frame);
    return NULL;
}

/* Without a thread the frame is written at once. */
void frame_writer_begin(frame_writer *w, shot *s, const host_camera *camera, uint32_t frame)
{
    const host_drawn drawn = s->frame;
    s->frame = w->drawn;
    w->drawn = drawn;
    w->camera = *camera;
    w->frame = frame;
    w->busy = pthread_create(&w->thread, NULL, write_frame, w) == 0;
    if (!w->busy)
        write_frame(w);
}

bool frame_writer_wait(frame_writer *w, char *error, size_t error_size)
{
    if (w->busy)
        pthread_join(w->thread, NULL);
    w->busy = false;
    return !w->failed || host_fail(error, error_size, "%s", w->error);
}

void frame_writer_close(frame_writer *w)
{
    char ignored[256];
    frame_writer_wait(w, ignored, sizeof ignored);
    host_drawn_destroy(&w->drawn);
    memset(w, 0, sizeof *w);
}
