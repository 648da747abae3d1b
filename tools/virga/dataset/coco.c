/* coco.c - annotations in the format of COCO (Lin et al. 2014, cocodataset.org/#format-data). What COCO has no field
 * for is in objects named "virga". */
#include "dataset/output.h"

#include "effect.h"
#include "file.h"
#include "rain.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FORMAT    (JSON_COMPACT | JSON_REAL_PRECISION(9))
#define MAX_BYTES ((size_t)1 << 30)
#define HEAD      512 /* the hash is within so many bytes */

/* Contrast is 5 % there: the meteorological optical range (WMO-No. 8). */
#define OPTICAL_RANGE 2.995732274 /* -log(0.05) */

/* Hundredths of a pixel are enough, and files stay small. */
static json_t *number(double value, double per_unit)
{
    return isfinite(value) ? json_real(round(value * per_unit) / per_unit) : json_null();
}

static json_t *numbers(const double *values, uint32_t count, double per_unit)
{
    json_t *array = json_array();
    for (uint32_t i = 0; i < count; i++)
        json_array_append_new(array, number(values[i], per_unit));
    return array;
}

/* ---- parts of a file */

static json_t *info_of(const dataset_output *out, const char *hash)
{
    char text[128];
    snprintf(text, sizeof text, "rain of %g mm/h, by virga dataset", out->rate_mm_h);
    json_t *own = hash ? json_pack("{s:s}", "settings_hash", hash) : json_object();
    json_object_set_new(own, "rate_mm_h", json_real(out->rate_mm_h));
    json_object_set_new(own, "seed", json_integer(tool_seed(out->scene)));
    json_object_set_new(own, "min_coverage", json_real(out->min_coverage));
    return json_pack("{s:o,s:s,s:s}", "virga", own, "version", virga_version(), "description", text);
}

static json_t *categories(void)
{
    return json_pack("[{s:i,s:s,s:s}]", "id", 1, "name", "rain streak", "supercategory", "rain");
}

static json_t *image_of(const dataset_output *out, const shot *s, uint32_t index, const dataset_weather *weather)
{
    const dataset_picture *p = &out->list->pictures[index];
    /* Half: what drops diffract is not lost for a picture, see haze in virga/rain.h. */
    const double extinction = out->haze * 0.5 * virga_rain_extinction(out->rate_mm_h);
    const int stem = (int)(strrchr(p->name, '.') - p->name);
    char file[4096];
    double focal[2], center[2];
    host_camera_intrinsics(&s->path, s->options.width, s->options.height, focal, center);
    focal[0] *= s->options.width;
    focal[1] *= s->options.height;
    json_t *own = json_object();
    json_object_set_new(own, "rate_mm_h", json_real(out->rate_mm_h));
    json_object_set_new(own, "extinction_per_m", number(extinction, 1e6));
    json_object_set_new(own, "visibility_m", number(extinction > 0 ? OPTICAL_RANGE / extinction : INFINITY, 10));
    json_object_set_new(own, "has_depth", json_boolean(p->depth));
    json_object_set_new(own, "wind_m_s", numbers(weather->wind_m_s, 3, 1000));
    json_object_set_new(own, "speed_m_s", number(weather->speed_m_s, 1000));
    json_object_set_new(own, "focal_px", numbers(focal, 2, 1000));
    json_object_set_new(own, "shutter_s", number(s->scene->frames.shutter_deg / 360 / s->scene->frames.fps, 1e6));
    snprintf(file, sizeof file, "%.*s.exr", stem, p->name);
    json_object_set_new(own, "layer", json_string(file));
    snprintf(file, sizeof file, "%.*s.png", stem, p->name);
    json_object_set_new(own, "mask", json_string(file));
    return json_pack("{s:I,s:s,s:i,s:i,s:o}", "id", (json_int_t)index + 1, "file_name", p->name, "width",
                     (int)s->frame.width, "height", (int)s->frame.height, "virga", own);
}

static json_t *annotation_of(const streak *streak, uint32_t id, uint32_t image)
{
    json_t *own = json_pack("{s:I}", "drop", (json_int_t)streak->id);
    json_object_set_new(own, "diameter_mm", number(streak->diameter_mm, 1000));
    json_object_set_new(own, "distance_m", number(streak->distance_m, 1000));
    json_object_set_new(own, "width_px", number(streak->width_px, 100));
    json_object_set_new(own, "length_px", number(streak->length_px, 100));
    json_object_set_new(own, "coverage", number(streak->coverage, 1e4));
    json_object_set_new(own, "drops", number(streak->drops, 100));
    return json_pack("{s:I,s:I,s:i,s:o,s:o,s:[o],s:i,s:o}", "id", (json_int_t)id, "image_id", (json_int_t)image,
                     "category_id", 1, "bbox", numbers(streak->box, 4, 100), "area", number(streak->area, 100),
                     "segmentation", numbers(streak->corners[0], 2 * streak->corner_count, 100), "iscrowd", 0, "virga",
                     own);
}

/* ---- one picture */

static bool write_json(file_writer *file, const json_t *value)
{
    char *text = value ? json_dumps(value, FORMAT) : NULL;
    const bool written = text && file_write(file, text, strlen(text));
    free(text);
    return written;
}

static bool write_text(file_writer *file, const char *text)
{
    return file_write(file, text, strlen(text));
}

bool coco_write(const dataset_output *out, const char *path, const shot *s, uint32_t index,
                const dataset_weather *weather, const streak *streaks, uint32_t count, char *error, size_t error_size)
{
    char hash[32];
    file_writer file;
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)dataset_hash(out, index));
    json_t *annotations = json_array();
    for (uint32_t i = 0; i < count; i++)
        json_array_append_new(annotations, annotation_of(&streaks[i], i + 1, index + 1));
    json_t *root = json_pack("{s:o,s:[],s:[o],s:o,s:o}", "info", info_of(out, hash), "licenses", "images",
                             image_of(out, s, index, weather), "annotations", annotations, "categories", categories());
    bool written = root && json_array_size(annotations) == count;
    if (!written)
        host_fail(error, error_size, "no memory for %u boxes", count);
    if (written && (written = file_start(&file, path, error, error_size))) {
        const bool whole = write_json(&file, root) && write_text(&file, "\n");
        written = file_finish(&file, error, error_size) && (whole || host_fail(error, error_size, "no memory"));
    }
    json_decref(root);
    return written;
}

bool coco_has_hash(const char *path, uint64_t hash)
{
    char head[HEAD + 1], wanted[64];
    FILE *file = fopen(path, "rb");
    if (!file)
        return false;
    head[fread(head, 1, HEAD, file)] = 0;
    fclose(file);
    snprintf(wanted, sizeof wanted, "\"settings_hash\":\"%016llx\"", (unsigned long long)hash);
    return strstr(head, wanted);
}

/* ---- all pictures */

typedef struct join {
    const dataset_output *out;
    file_writer file;
    bool first; /* nothing stands before the next value */
    json_int_t id;
} join;

static bool add_value(join *j, const json_t *value)
{
    const bool written =
        (j->first || write_text(&j->file, ",")) && write_text(&j->file, "\n") && write_json(&j->file, value);
    j->first = false;
    return written;
}

/* Those of one picture: `key` is "images" or "annotations". */
static bool add_values(join *j, uint32_t index, const char *key, char *error, size_t error_size)
{
    char path[4096];
    json_error_t reason;
    void *text;
    size_t size, at;
    json_t *value;
    if (!dataset_path(j->out, "boxes", index, "json", path) ||
        !file_read(path, MAX_BYTES, &text, &size, error, error_size))
        return false;
    json_t *root = json_loadb(text, size, 0, &reason);
    free(text);
    if (!root)
        return host_fail(error, error_size, "%s:%d: %s", path, reason.line, reason.text);
    bool written = true;
    json_array_foreach(json_object_get(root, key), at, value)
    {
        if (!strcmp(key, "annotations"))
            json_object_set_new(value, "id", json_integer(++j->id));
        written = written && add_value(j, value);
    }
    json_decref(root);
    return written || host_fail(error, error_size, "cannot write boxes of %s", path);
}

static bool add_list(join *j, const char *key, char *error, size_t error_size)
{
    bool written = write_text(&j->file, ",\n\"") && write_text(&j->file, key) && write_text(&j->file, "\":[");
    j->first = true;
    for (uint32_t i = 0; written && i < j->out->list->count; i++)
        if (!add_values(j, i, key, error, error_size))
            return false;
    return (written && write_text(&j->file, "]")) || host_fail(error, error_size, "cannot write coco.json");
}

bool coco_join(const dataset_output *out, const char *path, char *error, size_t error_size)
{
    join j = {.out = out};
    if (!file_start(&j.file, path, error, error_size))
        return false;
    json_t *info = info_of(out, NULL), *kinds = categories();
    bool written =
        write_text(&j.file, "{\"info\":") && write_json(&j.file, info) && write_text(&j.file, ",\n\"licenses\":[]");
    if (!written)
        host_fail(error, error_size, "cannot write %s", path);
    written = written && add_list(&j, "images", error, error_size) && add_list(&j, "annotations", error, error_size);
    if (written) {
        write_text(&j.file, ",\n\"categories\":");
        write_json(&j.file, kinds);
        write_text(&j.file, "}\n");
    }
    json_decref(info);
    json_decref(kinds);
    if (written)
        return file_finish(&j.file, error, error_size);
    file_abandon(&j.file);
    return false;
}
