/* plate.c - reads and resamples the pictures and the depth of a plate. */
#include "shot/plate.h"

#include "host.h"
#include "shot/distort.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool is_picture(const char *name)
{
    picture_kind kind;
    return picture_kind_of(name, &kind);
}

static plate_files pictures_of(const char *pattern, uint32_t first)
{
    return (plate_files){.option = "--plate",
                         .endings = "EXR, PNG, JPEG or TIFF",
                         .takes = is_picture,
                         .pattern = pattern,
                         .first = first};
}

static plate_files depths_of(const char *pattern, uint32_t first)
{
    return (plate_files){.option = "--depth",
                         .endings = "EXR, PNG, TIFF or NumPy",
                         .takes = depth_map_is_name,
                         .pattern = pattern,
                         .first = first};
}

/* Finds out what the pattern is, and whether there is a picture for each of the frames. A video's first frame is that
 * of the scene. */
static bool open_pictures(plate_files *files, video **movie, const uint32_t frames[2], char *error, size_t error_size)
{
    char reason[1024];
    if (!video_is_name(files->pattern) || strchr(files->pattern, '%'))
        return plate_files_open(files, frames, error, error_size);
    if (!video_open(movie, files->pattern, reason, sizeof reason))
        return host_fail(error, error_size, "--plate: %s", reason);
    const uint32_t count = video_count(*movie), wrong = frames[0] < files->first ? frames[0] : frames[1];
    return (frames[0] >= files->first && frames[1] - files->first < count) ||
           host_fail(error, error_size, "--plate: %u frames in %s, none for frame %u", count, files->pattern, wrong);
}

static bool read_picture(const plate_files *files, video *movie, uint32_t frame, char path[4096], picture *p,
                         char *error, size_t error_size)
{
    char reason[1024];
    return plate_files_name(files, frame, path, error, error_size) &&
           ((movie ? video_read(movie, frame - files->first, p, reason, sizeof reason)
                   : picture_read(path, p, reason, sizeof reason)) ||
            host_fail(error, error_size, "--plate: %s", reason));
}

bool plate_peek(const char *pattern, uint32_t scene_first, const uint32_t frames[2], picture_format *format,
                uint32_t size[2], char *error, size_t error_size)
{
    plate_files files = pictures_of(pattern, scene_first);
    char path[4096];
    picture first = {.rgb = NULL};
    video *movie = NULL;
    const bool read = open_pictures(&files, &movie, frames, error, error_size) &&
                      read_picture(&files, movie, frames[0], path, &first, error, error_size);
    *format = first.format;
    size[0] = first.width;
    size[1] = first.height;
    free(first.rgb);
    video_close(&movie);
    plate_files_close(&files);
    return read;
}

/* Memory for pictures of the shot's size, and for what the pinhole sees of them. */
static bool allocate(plate *p)
{
    const distortion_map *map = p->def.distortion ? &p->def.distortion->map : NULL;
    const size_t pixels = (size_t)p->def.width * p->def.height;
    const size_t seen = map ? (size_t)map->pinhole_size[0] * map->pinhole_size[1] : 0;
    p->picture = malloc(pixels * 4 * sizeof *p->picture);
    p->distance = p->has_depth ? malloc(pixels * sizeof *p->distance) : NULL;
    p->rgba = map ? malloc(seen * 4 * sizeof *p->rgba) : p->picture;
    p->depth = map && p->has_depth ? malloc(seen * sizeof *p->depth) : p->distance;
    return p->picture && p->rgba && (!p->has_depth || (p->distance && p->depth));
}

bool plate_open(plate *p, const plate_def *def, uint32_t scene_first, const uint32_t frames[2], char *error,
                size_t error_size)
{
    *p = (plate){.def = *def,
                 .pictures = pictures_of(def->pictures, scene_first),
                 .depths = depths_of(def->depths, scene_first),
                 .loaded = UINT32_MAX};
    p->has_depth = def->depths || def->depth_m > 0 || def->keeps_depth;
    if (!def->stills && (!open_pictures(&p->pictures, &p->movie, frames, error, error_size) ||
                         (def->depths && !plate_files_open(&p->depths, frames, error, error_size))))
        return false;
    return allocate(p) || host_fail(error, error_size, "no memory for a plate of %u x %u", def->width, def->height);
}

void plate_close(plate *p)
{
    video_close(&p->movie);
    plate_files_close(&p->pictures);
    plate_files_close(&p->depths);
    free(p->picture);
    free(p->distance);
    if (p->rgba != p->picture)
        free(p->rgba);
    if (p->depth != p->distance)
        free(p->depth);
    free(p->given.rgb);
    *p = (plate){0};
}

bool plate_replace(plate *p, const plate_def *def, const picture *given, char *error, size_t error_size)
{
    plate_def next = p->def;
    next.pictures = def->pictures;
    next.depths = def->depths;
    next.depth = def->depth;
    next.fills_depth = def->fills_depth;
    next.width = def->width;
    next.height = def->height;
    if (next.width != p->def.width || next.height != p->def.height) {
        plate_close(p);
        const bool opened = plate_open(p, &next, 0, (const uint32_t[]){0, 0}, error, error_size);
        p->given = *given;
        return opened;
    }
    free(p->given.rgb);
    p->given = *given;
    p->def = next;
    p->pictures.pattern = next.pictures;
    p->depths.pattern = next.depths;
    p->loaded = UINT32_MAX;
    return true;
}

bool plate_has(const plate *p, uint32_t frame)
{
    char path[4096], ignored[256];
    if (p->movie)
        return frame - p->pictures.first < video_count(p->movie);
    return plate_files_name(&p->pictures, frame, path, ignored, sizeof ignored) && !access(path, R_OK);
}

/* ---- resampling */

/* Resamples a line of `from` values to `to` values by a tent filter. The tent spans two of the larger pixels. */
static void resample_line(const float *in, size_t in_step, uint32_t from, float *out, size_t out_step, uint32_t to)
{
    const double scale = (double)from / to, reach = fmax(scale, 1);
    for (uint32_t i = 0; i < to; i++) {
        const double middle = (i + 0.5) * scale - 0.5;
        double sum[3] = {0}, weights = 0;
        for (int k = (int)ceil(middle - reach); k <= (int)floor(middle + reach); k++) {
            const double weight = 1 - fabs(k - middle) / reach;
            const size_t at = (size_t)(k < 0 ? 0 : k >= (int)from ? (int)from - 1 : k);
            for (size_t c = 0; c < 3; c++)
                sum[c] += weight * (double)in[at * in_step + c];
            weights += weight;
        }
        for (size_t c = 0; c < 3; c++)
            out[i * out_step + c] = (float)(sum[c] / weights);
    }
}

static bool resample(plate *p, const float *rgb, uint32_t width, uint32_t height)
{
    float *rows_done = malloc((size_t)p->def.width * height * 3 * sizeof *rows_done);
    for (uint32_t row = 0; rows_done && row < height; row++)
        resample_line(rgb + (size_t)row * width * 3, 3, width, rows_done + (size_t)row * p->def.width * 3, 3,
                      p->def.width);
    for (uint32_t column = 0; rows_done && column < p->def.width; column++)
        resample_line(rows_done + column * 3, (size_t)p->def.width * 3, height, p->picture + column * 4,
                      (size_t)p->def.width * 4, p->def.height);
    free(rows_done);
    return rows_done;
}

static bool copy_picture(plate *p, const char *path, const float *rgb, uint32_t width, uint32_t height, char *error,
                         size_t error_size)
{
    const size_t pixels = (size_t)p->def.width * p->def.height;
    if (width == p->def.width && height == p->def.height) {
        for (size_t i = 0; i < pixels; i++)
            memcpy(p->picture + i * 4, rgb + i * 3, 3 * sizeof *rgb);
    } else {
        if (!p->warned)
            fprintf(stderr, "virga: --plate: %s is %u x %u, resampled to %u x %u\n", path, width, height, p->def.width,
                    p->def.height);
        p->warned = true;
        if (!resample(p, rgb, width, height))
            return host_fail(error, error_size, "no memory for a plate of %u x %u", width, height);
    }
    for (size_t i = 0; i < pixels; i++)
        p->picture[i * 4 + 3] = 1;
    return true;
}

/* ---- depth */

/* As a depth buffer has it, see host_camera_distance. What is farther than the far plane is drawn before it. */
float plate_buffer_depth(const plate *p, double metres)
{
    const double near_m = p->def.near_m, far_m = p->def.far_m;
    if (!(metres > 0))
        return 1;
    const double depth = far_m * (metres - near_m) / (metres * (far_m - near_m));
    return fminf(fmaxf((float)depth, 0), nextafterf(1, 0));
}

/* Each pixel gets the depth of one pixel of the map, as a mean of two depths is neither. */
static bool load_depth(plate *p, uint32_t frame, char *error, size_t error_size)
{
    char path[4096], reason[1024];
    uint32_t width = 1, height = 1;
    float *metres = NULL;
    if (p->def.depths && !plate_files_name(&p->depths, frame, path, error, error_size))
        return false;
    if (p->def.depths && !depth_map_read(path, &p->def.depth, &width, &height, &metres, reason, sizeof reason))
        return host_fail(error, error_size, "--depth: %s", reason);
    if (p->def.fills_depth && !depth_map_fill(metres, width, height)) {
        free(metres);
        return host_fail(error, error_size, "no memory for a depth of %u x %u", width, height);
    }
    for (uint32_t y = 0; y < p->def.height; y++)
        for (uint32_t x = 0; x < p->def.width; x++) {
            const size_t row = (2 * (size_t)y + 1) * height / (2 * (size_t)p->def.height);
            const size_t column = (2 * (size_t)x + 1) * width / (2 * (size_t)p->def.width);
            const double known = metres ? (double)metres[row * width + column] : 0;
            p->distance[(size_t)y * p->def.width + x] = plate_buffer_depth(p, known > 0 ? known : p->def.depth_m);
        }
    free(metres);
    return true;
}

bool plate_load(plate *p, uint32_t frame, char *error, size_t error_size)
{
    char path[4096];
    picture now;
    if (p->loaded == frame || (p->def.stills && p->loaded != UINT32_MAX))
        return true;
    p->loaded = UINT32_MAX;
    if (p->given.rgb) {
        now = p->given;
        p->given.rgb = NULL;
        snprintf(path, sizeof path, "%s", p->def.pictures);
    } else if (!read_picture(&p->pictures, p->movie, frame, path, &now, error, error_size)) {
        return false;
    }
    const size_t pixels = (size_t)now.width * now.height;
    if (p->def.color_space)
        color_space_to_light(p->def.color_space, now.rgb, pixels, 3);
    else
        picture_to_light(now.rgb, pixels * 3, p->def.curve, now.format);
    const bool loaded = copy_picture(p, path, now.rgb, now.width, now.height, error, error_size) &&
                        (!p->has_depth || load_depth(p, frame, error, error_size));
    free(now.rgb);
    if (loaded && p->def.distortion)
        shot_distortion_undo_color(p->def.distortion, p->picture, p->rgba);
    if (loaded && p->def.distortion && p->has_depth)
        shot_distortion_undo_nearest(p->def.distortion, p->distance, p->depth);
    p->loaded = loaded ? frame : UINT32_MAX;
    return loaded;
}
