/* output.c - see output.h. */
#include "dataset/output.h"

#include "effect.h"
#include "file.h"
#include "frame/files.h"
#include "frame/layers.h"
#include "png.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define VERSION 1 /* of what is written; another one makes everything anew */

static int base_path(const dataset_output *out, const char *below, char path[4096])
{
    return snprintf(path, 4096, "%s/%gmm/%s", out->directory, out->rate_mm_h, below);
}

bool dataset_path(const dataset_output *out, const char *kind, uint32_t index, const char *ending, char path[4096])
{
    const char *name = out->list->pictures[index].name, *dot = strrchr(name, '.');
    const int length = base_path(out, kind, path);
    return length < 4096 &&
           (ending ? snprintf(path + length, 4096 - (size_t)length, "/%.*s.%s", (int)(dot - name), name, ending)
                   : snprintf(path + length, 4096 - (size_t)length, "/%s", name)) < 4096 - length;
}

/* ---- what is there */

static uint64_t hash_bytes(uint64_t hash, const void *data, size_t size)
{
    const uint8_t *bytes = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * UINT64_C(0x100000001b3); /* FNV-1a */
    return hash;
}

static uint64_t hash_number(uint64_t hash, double number)
{
    return hash_bytes(hash, &number, sizeof number);
}

/* Two files of the same size count as the same: reading all photographs would take as long as decoding them. */
static uint64_t hash_file(uint64_t hash, const char *path)
{
    struct stat about;
    const int64_t size = path && !stat(path, &about) ? (int64_t)about.st_size : -1;
    return hash_bytes(hash, &size, sizeof size);
}

uint64_t dataset_hash(const dataset_output *out, uint32_t index)
{
    const dataset_picture *p = &out->list->pictures[index];
    const double numbers[] = {VERSION,
                              out->rate_mm_h,
                              out->min_coverage,
                              index,
                              p->right_m,
                              isnan(p->speed_m_s) ? -1e9 : p->speed_m_s,
                              p->calibration.focal_px[0],
                              p->calibration.focal_px[1],
                              p->calibration.center_px[0],
                              p->calibration.center_px[1],
                              p->depth_def.baseline_m,
                              p->depth_def.focal_px,
                              p->fills_depth};
    uint64_t hash = hash_bytes(UINT64_C(0xcbf29ce484222325), &out->scene_hash, sizeof out->scene_hash);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        hash = hash_number(hash, numbers[i]);
    hash = hash_bytes(hash, p->name, strlen(p->name));
    hash = hash_bytes(hash, p->place, strlen(p->place));
    return hash_file(hash_file(hash, p->path), p->depth);
}

bool dataset_is_done(const dataset_output *out, uint32_t index)
{
    static const char *const kinds[3][2] = {{"rain", NULL}, {"layer", "exr"}, {"mask", "png"}};
    char path[4096];
    for (int i = 0; i < 3; i++)
        if (!dataset_path(out, kinds[i][0], index, kinds[i][1], path) || access(path, R_OK))
            return false;
    return dataset_path(out, "boxes", index, "json", path) && coco_has_hash(path, dataset_hash(out, index));
}

/* ---- writing */

/* The path, in a folder that is there, without what killed programs have left in it. */
static bool make_path(dataset_output *out, int slot, const char *kind, uint32_t index, const char *ending,
                      char path[4096], char *error, size_t error_size)
{
    if (!dataset_path(out, kind, index, ending, path))
        return host_fail(error, error_size, "the name of %s is too long", out->list->pictures[index].path);
    char *made = out->made[slot], folder[4096];
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(path, '/') - path), path);
    if (!strcmp(made, folder))
        return true;
    if (!file_make_folder(folder))
        return host_fail(error, error_size, "cannot make the folder %s: %s", folder, strerror(errno));
    file_clean(folder);
    snprintf(made, sizeof folder, "%s", folder);
    return true;
}

static const float *rain_of(const shot *s)
{
    for (uint32_t i = 0; i < s->layer_count; i++)
        if (tool_effects[s->layers[i].effect] == &rain_effect && !strcmp(s->layers[i].layer->name, "rain"))
            return s->frame.layers[s->layers[i].output - HOST_LAYER];
    return NULL;
}

static bool write_mask(const dataset_output *out, const shot *s, const char *path, char *error, size_t error_size)
{
    const size_t pixels = (size_t)s->frame.width * s->frame.height;
    const float *rain = rain_of(s);
    uint8_t *mask = malloc(pixels);
    if (!mask)
        return host_fail(error, error_size, "no memory for a mask");
    for (size_t i = 0; i < pixels; i++)
        mask[i] = rain && rain[4 * i + 3] >= (float)out->min_coverage ? 255 : 0;
    const bool written = png_write(path, s->frame.width, s->frame.height, 1, mask, error, error_size);
    free(mask);
    return written;
}

static bool write_rain(const shot *s, const host_camera *camera, uint32_t frame, const char *path, uint64_t hash,
                       picture_format format, char *error, size_t error_size)
{
    uint32_t beauty;
    if (format.kind != PICTURE_EXR)
        return frame_save_picture(s, &s->frame, path, hash, format, error, error_size);
    return frame_layers_parse("beauty", &beauty) &&
           frame_save_exr(s, &s->frame, camera, path, frame, beauty, error, error_size);
}

bool dataset_write(dataset_output *out, shot *s, const host_camera *camera, uint32_t frame, uint32_t index,
                   picture_format format, const dataset_weather *weather, char *error, size_t error_size)
{
    char rain[4096], layer[4096], mask[4096], boxes[4096];
    streak *streaks = NULL;
    uint32_t layers, count;
    if (!make_path(out, 0, "rain", index, NULL, rain, error, error_size) ||
        !make_path(out, 1, "layer", index, "exr", layer, error, error_size) ||
        !make_path(out, 2, "mask", index, "png", mask, error, error_size) ||
        !make_path(out, 3, "boxes", index, "json", boxes, error, error_size))
        return false;
    unlink(boxes); /* it says that the other files are of these settings */
    const bool written = streaks_find(s, frame, out->min_coverage, &streaks, &count, error, error_size) &&
                         write_rain(s, camera, frame, rain, dataset_hash(out, index), format, error, error_size) &&
                         frame_layers_parse("haze,rain", &layers) &&
                         frame_save_exr(s, &s->frame, camera, layer, frame, layers, error, error_size) &&
                         write_mask(out, s, mask, error, error_size) &&
                         coco_write(out, boxes, s, index, weather, streaks, count, error, error_size);
    free(streaks);
    return written;
}

/* ---- all */

bool dataset_join(const dataset_output *out, char *error, size_t error_size)
{
    char path[4096];
    for (uint32_t i = 0; i < out->list->count; i++)
        if (!dataset_is_done(out, i))
            return true;
    base_path(out, "coco.json", path);
    return coco_join(out, path, error, error_size);
}
