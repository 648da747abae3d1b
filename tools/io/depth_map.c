/* depth_map.c - reads numbers of several formats, and makes them metres. */
#include "depth_map.h"

#include "exr.h"
#include "file.h"
#include "npy.h"
#include "picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static bool is_npy(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && !strcasecmp(dot, ".npy");
}

bool depth_map_is_name(const char *name)
{
    picture_kind kind;
    return is_npy(name) || (picture_kind_of(name, &kind) && kind != PICTURE_JPEG);
}

/* The numbers that the file has, without a scale. *whole: they are whole numbers. */
static bool read_numbers(const char *path, uint32_t *width, uint32_t *height, float **numbers, bool *whole, char *error,
                         size_t error_size)
{
    picture_kind kind;
    picture p;
    *whole = false;
    if (is_npy(path))
        return npy_read(path, width, height, numbers, error, error_size);
    if (!depth_map_is_name(path) || !picture_kind_of(path, &kind))
        return file_fail(error, error_size, "cannot read %s: expected a name that ends in .exr, .png, .tif or .npy",
                         path);
    if (kind == PICTURE_EXR) {
        exr_request z = {.name = "Z", .type = EXR_SAMPLE_FLOAT};
        const bool read = exr_read_channels(path, width, height, &z, 1, error, error_size);
        *numbers = z.data;
        return read;
    }
    if (!picture_read(path, &p, error, error_size))
        return false;
    *whole = p.format.bits < 32;
    const float largest = p.format.bits == 8 ? 255 : p.format.bits == 16 ? 65535 : 1;
    for (size_t i = 0; i < (size_t)p.width * p.height; i++)
        p.rgb[i] = *whole ? rintf(p.rgb[i * 3] * largest) : p.rgb[i * 3];
    *numbers = p.rgb;
    *width = p.width;
    *height = p.height;
    return true;
}

/* How much longer the ray of a pixel is than its way along the axis. */
static double ray_length(const depth_map_def *def, uint32_t width, uint32_t height, size_t i)
{
    const double x = (((double)(i % width) + 0.5) / width - def->center[0]) / def->focal[0];
    const double y = (((double)(i / width) + 0.5) / height - def->center[1]) / def->focal[1];
    double xy[2] = {x, y};
    if (distortion_is_given(&def->lens) && !distortion_undo(&def->lens, (const double[]){x, y}, xy))
        return 1; /* not on a picture that the lens can be undone over */
    return sqrt(1 + xy[0] * xy[0] + xy[1] * xy[1]);
}

bool depth_map_read(const char *path, const depth_map_def *def, uint32_t *width, uint32_t *height, float **metres,
                    char *error, size_t error_size)
{
    bool whole;
    *metres = NULL;
    if (!read_numbers(path, width, height, metres, &whole, error, error_size))
        return false;
    const double scale = def->scale > 0 ? def->scale : whole ? 1.0 / 256 : 1;
    const bool disparity = def->kind == DEPTH_MAP_DISPARITY;
    for (size_t i = 0; i < (size_t)*width * *height; i++) {
        const double number = (double)(*metres)[i];
        const bool known = !whole || number > 0;
        double value = known ? scale * (whole && disparity ? number - 1 : number) : 0;
        if (disparity)
            value = value > 0 ? def->baseline_m * def->focal_px / value : 0;
        else if (def->kind == DEPTH_MAP_RAY)
            value /= ray_length(def, *width, *height, i);
        (*metres)[i] = isfinite(value) && value > 0 && value < 1e6 ? (float)value : 0;
    }
    return true;
}

/* ---- holes */

/* The highest row of each column that has a known pixel, or one of `REACH` columns to its sides has. */
static bool find_tops(const float *metres, uint32_t width, uint32_t height, uint32_t *tops)
{
    enum { REACH = 8 };
    uint32_t *own = malloc(width * sizeof *own);
    if (!own)
        return false;
    for (uint32_t x = 0; x < width; x++)
        for (own[x] = 0; own[x] < height && !(metres[(size_t)own[x] * width + x] > 0);)
            own[x]++;
    for (uint32_t x = 0; x < width; x++) {
        tops[x] = height;
        for (uint32_t at = x > REACH ? x - REACH : 0; at < width && at <= x + REACH; at++)
            tops[x] = own[at] < tops[x] ? own[at] : tops[x];
    }
    free(own);
    return true;
}

/* Known pixels spread, one step to each of their four neighbors in a round, in the order in which they were reached. */
static void spread(float *metres, uint32_t width, uint32_t height, const uint32_t *tops, size_t *queue)
{
    const size_t pixels = (size_t)width * height;
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++)
        if (metres[i] > 0)
            queue[count++] = i;
    for (size_t next = 0; next < count; next++) {
        const size_t at = queue[next], x = at % width, y = at / width;
        const size_t around[4] = {at - 1, at + 1, at - width, at + width};
        const bool inside[4] = {x > 0, x + 1 < width, y > 0, y + 1 < height};
        for (int k = 0; k < 4; k++) {
            if (!inside[k] || metres[around[k]] > 0 || around[k] / width < tops[around[k] % width])
                continue;
            metres[around[k]] = metres[at];
            queue[count++] = around[k];
        }
    }
}

bool depth_map_fill(float *metres, uint32_t width, uint32_t height)
{
    uint32_t *tops = malloc(width * sizeof *tops);
    size_t *queue = malloc((size_t)width * height * sizeof *queue);
    const bool filled = tops && queue && find_tops(metres, width, height, tops);
    if (filled)
        spread(metres, width, height, tops, queue);
    free(tops);
    free(queue);
    return filled;
}
