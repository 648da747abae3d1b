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
