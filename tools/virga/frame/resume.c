/* resume.c - reads the headers of frames that are there, and removes lines that will be written again from
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

/* The most specific difference first: a different seed also changes the scene hash. */
static bool matches_request(const resume_request *request, const char *path, const exr_header *header,
                            const exr_text *texts, char *error, size_t error_size)
{
    char has[256], expected[256];
    snprintf(expected, sizeof expected, "%u", tool_seed(request->scene));
    if (differs(path, "seed", texts[0].text, expected, error, error_size))
        return false;
    snprintf(has, sizeof has, "%ux%u", header->width, header->height);
    snprintf(expected, sizeof expected, "%ux%u", request->width, request->height);
    if (differs(path, "size", has, expected, error, error_size))
        return false;
    snprintf(expected, sizeof expected, "%u", request->samples);
    if (differs(path, "samples", texts[1].text, expected, error, error_size))
        return false;
    frame_layers_print(frame_layers_in(header->channels), has, sizeof has);
    frame_layers_print(request->layers, expected, sizeof expected);
    if (differs(path, "layers", has, expected, error, error_size))
        return false;
    if (differs(path, "plate", texts[3].text, request->plate ? request->plate : "", error, error_size))
        return false;
    if (differs(path, "depth", texts[5].text, request->depth ? request->depth : "", error, error_size))
        return false;
    if (differs(path, "mask", texts[6].text, request->ground_mask ? request->ground_mask : "", error, error_size))
        return false;
    expected[0] = 0;
    if (request->water_velocity)
        snprintf(expected, sizeof expected, "%u", request->water_velocity);
    if (differs(path, "water velocity", texts[4].text, expected, error, error_size))
        return false;
    snprintf(expected, sizeof expected, "%016llx", (unsigned long long)scene_file_hash(request->scene));
    return !differs(path, "scene hash", texts[2].text, expected, error, error_size);
}

/* The files beside frame.%04d.exr. */
static bool has_files(const resume_request *request, uint32_t frame)
{
    char path[4096];
    const char *name;
    snprintf(path, sizeof path, "%s/preview.%04u.png", request->directory, frame);
    bool has = !request->preview || has_file(path);
    if (request->picture.bits) {
        frame_picture_path(request->directory, request->picture.kind, frame, path, sizeof path);
        has = has && has_file(path);
    }
    for (uint32_t i = 0; request->points && (name = frame_points_name(request->scene, i)); i++) {
        frame_points_path(request->directory, name, frame, path, sizeof path);
        has = has && has_file(path);
    }
    for (uint32_t i = 0; request->meshes && (name = frame_mesh_name(request->scene, i)); i++) {
        frame_points_path(request->directory, name, frame, path, sizeof path);
        has = has && has_file(path);
    }
    for (uint32_t i = 0; request->volumes && (name = frame_volume_name(request->scene, i)); i++) {
        frame_volume_path(request->directory, name, frame, path, sizeof path);
        has = has && has_file(path);
    }
    return has;
}

/* A frame's EXR is written last, so where it is there, all files that its run wrote are there too. */
static bool find_frame(const resume_request *request, uint32_t frame, bool *there, char *error, size_t error_size)
{
    char path[4096], damage[1024];
    exr_header header;
    exr_text texts[] = {{.name = "seed"},          {.name = "samples"},    {.name = "sceneHash"}, {.name = "plate"},
                        {.name = "waterVelocity"}, {.name = "plateDepth"}, {.name = "groundMask"}};
    *there = false;
    snprintf(path, sizeof path, "%s/frame.%04u.exr", request->directory, frame);
    struct stat info;
    if (stat(path, &info))
        return true;
    if (!exr_read_header(path, &header, texts, sizeof texts / sizeof texts[0], damage, sizeof damage)) {
        fprintf(stderr, "virga render: %s; the frame is rendered again\n", damage);
        return true;
    }
    *there = has_files(request, frame);
    return matches_request(request, path, &header, texts, error, error_size);
}

bool resume_find(const resume_request *request, bool **there, char *error, size_t error_size)
{
    *there = calloc((size_t)request->last - request->first + 1, sizeof **there);
    if (!*there) {
        snprintf(error, error_size, "no memory for %u frames", request->last - request->first + 1);
        return false;
    }
    for (uint32_t frame = request->first; frame <= request->last; frame++)
        if (!find_frame(request, frame, &(*there)[frame - request->first], error, error_size))
            return false;
    return true;
}

/* ---- stats.jsonl */

typedef struct trim {
    const resume_request *request;
    const bool *there;
    bool *kept; /* a line of the frame has stayed */
} trim;

static bool keep_line(void *user, const char *line)
{
    trim *t = user;
    unsigned frame;
    const size_t length = strlen(line);
    if (sscanf(line, "{\"frame\":%u,", &frame) != 1 || line[length - 1] != '}')
        return false;
    if (frame < t->request->first || frame > t->request->last)
        return true;
    const uint32_t i = frame - t->request->first;
    if (!t->there[i] || t->kept[i])
        return false;
    return t->kept[i] = true;
}

bool resume_trim_stats(const resume_request *request, bool *there, char *error, size_t error_size)
{
    char path[4096];
    const size_t count = (size_t)request->last - request->first + 1;
    if (!request->stats)
        return true;
    trim t = {.request = request, .there = there, .kept = calloc(count, sizeof(bool))};
    if (!t.kept) {
        snprintf(error, error_size, "no memory for %zu frames", count);
        return false;
    }
    snprintf(path, sizeof path, "%s/stats.jsonl", request->directory);
    const bool trimmed = jsonl_filter(path, keep_line, &t, error, error_size);
    if (trimmed)
        memcpy(there, t.kept, count * sizeof(bool));
    free(t.kept);
    return trimmed;
}
