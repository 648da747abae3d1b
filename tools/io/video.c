/* video.c - loads the module of FFmpeg with the first video. */
#include "video.h"

#include "file.h"
#include "video_table.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct video {
    char *path;
    void *stream;
    uint32_t count;
};

bool video_is_name(const char *name)
{
    static const char *const endings[] = {".mov", ".mp4", ".m4v", ".mkv", ".avi", ".mxf", ".webm"};
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++)
        if (!strcasecmp(dot, endings[i]))
            return true;
    return false;
}

#ifdef VIDEO_MODULE

#include <dlfcn.h>

#define TEXT_OF(name) #name
#define SYMBOL(name)  TEXT_OF(name)

static pthread_once_t once = PTHREAD_ONCE_INIT;
static const video_table *table; /* NULL: it cannot be loaded */

/* The module stays loaded until the program ends. */
static void load(void)
{
    void *module = dlopen(VIDEO_MODULE, RTLD_NOW | RTLD_LOCAL);
    table = module ? dlsym(module, SYMBOL(VIDEO_TABLE)) : NULL;
}

static const video_table *loaded(const char *path, char *error, size_t error_size)
{
    pthread_once(&once, load);
    if (!table)
        file_fail(error, error_size, "cannot read %s: video needs FFmpeg's libraries, which cannot be loaded", path);
    return table;
}

#else

static const video_table *const table = NULL;

static const video_table *loaded(const char *path, char *error, size_t error_size)
{
    file_fail(error, error_size, "cannot read %s: this program was built without FFmpeg, which video needs", path);
    return NULL;
}

#endif

bool video_open(video **v, const char *path, char *error, size_t error_size)
{
    char reason[512];
    *v = NULL;
    if (!loaded(path, error, error_size))
        return false;
    video *opened = calloc(1, sizeof *opened);
    if (opened)
        opened->path = strdup(path);
    if (!opened || !opened->path) {
        free(opened);
        return file_fail(error, error_size, "cannot read %s: no memory", path);
    }
    opened->stream = table->open(path, &opened->count, reason, sizeof reason);
    *v = opened;
    if (opened->stream)
        return true;
    video_close(v);
    return file_fail(error, error_size, "cannot read %s: %s", path, reason);
}

void video_close(video **v)
{
    if (*v && (*v)->stream)
        table->close((*v)->stream);
    if (*v)
        free((*v)->path);
    free(*v);
    *v = NULL;
}

uint32_t video_count(const video *v)
{
    return v->count;
}

bool video_read(video *v, uint32_t index, picture *p, char *error, size_t error_size)
{
    char reason[512];
    *p = (picture){.rgb = NULL};
    if (index >= v->count)
        return file_fail(error, error_size, "%s has %u frames, expected frame %u", v->path, v->count, index);
    return table->read(v->stream, index, p, reason, sizeof reason) ||
           file_fail(error, error_size, "cannot read frame %u of %s: %s", index, v->path, reason);
}
