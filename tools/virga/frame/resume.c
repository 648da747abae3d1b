/* resume.c - reads the headers of frames that are there, and takes lines that will be written again out of
 * stats.jsonl. */
#include "frame/resume.h"

#include "exr.h"
#include "frame/files.h"
#include "frame/layers.h"
#include "jsonl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* ---- frames */

static bool has_file(const char *path)
{
    struct stat info;
    return !stat(path, &info) && S_ISREG(info.st_mode) && info.st_size > 0;
}

static bool differs(const char *path, const char *what, const char *has, const char *expected, char *error,
                    size_t error_size)
{
    if (!strcmp(has, expected))
        return false;
    snprintf(error, error_size, "--resume: %s has %s %s, expected %s; choose another folder or leave out --resume",
             path, what, has[0] ? has : "(none)", expected[0] ? expected : "(none)");
    return true;
}

/* The most telling difference first: another seed is another scene hash too. */
static bool is_of_wish(const resume_wish *wish, const char *path, const exr_header *header, const exr_text *texts,
                       char *error, size_t error_size)
{
    char has[256], expected[256];
    snprintf(expected, sizeof expected, "%u", tool_seed(wish->scene));
    if (differs(path, "seed", texts[0].text, expected, error, error_size))
        return false;
    snprintf(has, sizeof has, "%ux%u", header->width, header->height);
    snprintf(expected, sizeof expected, "%ux%u", wish->width, wish->height);
    if (differs(path, "size", has, expected, error, error_size))
        return false;
    snprintf(expected, sizeof expected, "%u", wish->samples);
    if (differs(path, "samples", texts[1].text, expected, error, error_size))
        return false;
    frame_layers_print(frame_layers_in(header->channels), has, sizeof has);
    frame_layers_print(wish->layers, expected, sizeof expected);
    if (differs(path, "layers", has, expected, error, error_size))
        return false;
    if (differs(path, "plate", texts[3].text, wish->plate ? wish->plate : "", error, error_size))
        return false;
    expected[0] = 0;
    if (wish->water_velocity)
        snprintf(expected, sizeof expected, "%u", wish->water_velocity);
    if (differs(path, "water velocity", texts[4].text, expected, error, error_size))
        return false;
    snprintf(expected, sizeof expected, "%016llx", (unsigned long long)scene_file_hash(wish->scene));
    return !differs(path, "scene hash", texts[2].text, expected, error, error_size);
}

/* The files beside frame.%04d.exr. */
static bool has_files(const resume_wish *wish, uint32_t frame)
{
    char path[4096];
    const char *name;
    snprintf(path, sizeof path, "%s/preview.%04u.png", wish->directory, frame);
    bool has = !wish->preview || has_file(path);
    for (uint32_t i = 0; wish->points && (name = frame_points_name(wish->scene, i)); i++) {
        frame_points_path(wish->directory, name, frame, path, sizeof path);
        has = has && has_file(path);
    }
    return has;
}

/* A frame's EXR is written last, so if it is there, then so is all that the run that wrote it was asked for. */
static bool find_frame(const resume_wish *wish, uint32_t frame, bool *there, char *error, size_t error_size)
{
    char path[4096], damage[1024];
    exr_header header;
    exr_text texts[] = {
        {.name = "seed"}, {.name = "samples"}, {.name = "sceneHash"}, {.name = "plate"}, {.name = "waterVelocity"}};
    *there = false;
    snprintf(path, sizeof path, "%s/frame.%04u.exr", wish->directory, frame);
    struct stat info;
    if (stat(path, &info))
        return true;
    if (!exr_read_header(path, &header, texts, 5, damage, sizeof damage)) {
        fprintf(stderr, "virga render: %s; the frame is rendered again\n", damage);
        return true;
    }
    *there = has_files(wish, frame);
    return is_of_wish(wish, path, &header, texts, error, error_size);
}

bool resume_find(const resume_wish *wish, bool **there, char *error, size_t error_size)
{
    *there = calloc((size_t)wish->last - wish->first + 1, sizeof **there);
    if (!*there) {
        snprintf(error, error_size, "no memory for %u frames", wish->last - wish->first + 1);
        return false;
    }
    for (uint32_t frame = wish->first; frame <= wish->last; frame++)
        if (!find_frame(wish, frame, &(*there)[frame - wish->first], error, error_size))
            return false;
    return true;
}

/* ---- stats.jsonl */

typedef struct trim {
    const resume_wish *wish;
    const bool *there;
    bool *told; /* a line of the frame has stayed */
} trim;

static bool keep_line(void *user, const char *line)
{
    trim *t = user;
    unsigned frame;
    const size_t length = strlen(line);
    if (sscanf(line, "{\"frame\":%u,", &frame) != 1 || line[length - 1] != '}')
        return false;
    if (frame < t->wish->first || frame > t->wish->last)
        return true;
    const uint32_t i = frame - t->wish->first;
    if (!t->there[i] || t->told[i])
        return false;
    return t->told[i] = true;
}

bool resume_trim_stats(const resume_wish *wish, bool *there, char *error, size_t error_size)
{
    char path[4096];
    const size_t count = (size_t)wish->last - wish->first + 1;
    if (!wish->stats)
        return true;
    trim t = {.wish = wish, .there = there, .told = calloc(count, sizeof(bool))};
    if (!t.told) {
        snprintf(error, error_size, "no memory for %zu frames", count);
        return false;
    }
    snprintf(path, sizeof path, "%s/stats.jsonl", wish->directory);
    const bool trimmed = jsonl_filter(path, keep_line, &t, error, error_size);
    if (trimmed)
        memcpy(there, t.told, count * sizeof(bool));
    free(t.told);
    return trimmed;
}
