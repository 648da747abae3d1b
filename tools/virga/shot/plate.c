/* plate.c - finds, reads and resamples the pictures of a plate. */
#include "shot/plate.h"

#include "host.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- which file */

static bool is_picture(const char *name)
{
    picture_kind kind;
    return name[0] != '.' && picture_kind_of(name, &kind);
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static bool add_file(plate *p, const char *name)
{
    char **more = realloc(p->files, (p->file_count + 1) * sizeof *more);
    if (more)
        p->files = more;
    if (!more || asprintf(&p->files[p->file_count], "%s/%s", p->pattern, name) < 0)
        return false;
    p->file_count++;
    return true;
}

static bool list_folder(plate *p, char *error, size_t error_size)
{
    DIR *folder = opendir(p->pattern);
    bool listed = folder;
    for (struct dirent *entry; listed && (entry = readdir(folder));)
        listed = !is_picture(entry->d_name) || add_file(p, entry->d_name);
    if (folder)
        closedir(folder);
    if (!listed)
        return host_fail(error, error_size, "--plate: cannot list the folder %s", p->pattern);
    if (!p->file_count)
        return host_fail(error, error_size, "--plate: no EXR, PNG, JPEG or TIFF pictures in the folder %s", p->pattern);
    qsort(p->files, p->file_count, sizeof *p->files, by_name);
    return true;
}

/* A pattern is what printf needs for one whole number, and nothing else: it comes from a command line. */
static bool check_pattern(plate *p, char *error, size_t error_size)
{
    const char *percent = strchr(p->pattern, '%');
    if (!percent)
        return true;
    p->numbered = true;
    const char *end = percent + 1 + strspn(percent + 1, "0123456789");
    if (*end == 'd' && end - percent <= 3 && !strchr(end, '%'))
        return true;
    return host_fail(error, error_size, "--plate: expected one number as in plate.%%04d.exr, got %s", p->pattern);
}

static bool name_of(const plate *p, uint32_t frame, char path[4096], char *error, size_t error_size)
{
    if (p->files && frame - p->first >= p->file_count)
        return host_fail(error, error_size, "--plate: %u pictures in %s, none for frame %u", p->file_count, p->pattern,
                         frame);
    if (p->files) {
        snprintf(path, 4096, "%s", p->files[frame - p->first]);
        return true;
    }
    const char *percent = p->numbered ? strchr(p->pattern, '%') : NULL;
    if (!percent) {
        snprintf(path, 4096, "%s", p->pattern);
        return true;
    }
    const int digits = atoi(percent + 1);
    snprintf(path, 4096, "%.*s%0*u%s", (int)(percent - p->pattern), p->pattern, digits, frame,
             strchr(percent, 'd') + 1);
    return true;
}

/* Finds out what the pattern is, and whether the pictures are there. */
static bool find_pictures(plate *p, const uint32_t frames[2], char *error, size_t error_size)
{
    struct stat about;
    const char *pattern = p->pattern;
    const bool folder = !stat(pattern, &about) && S_ISDIR(about.st_mode);
    if (folder ? !list_folder(p, error, error_size) : !check_pattern(p, error, error_size))
        return false;
    for (uint32_t frame = frames[0]; frame <= frames[1]; frame++) {
        char path[4096];
        if (!name_of(p, frame, path, error, error_size))
            return false;
        if (access(path, R_OK))
            return host_fail(error, error_size, "--plate: cannot read %s, for frame %u", path, frame);
    }
    return true;
}

bool plate_peek(const char *pattern, uint32_t scene_first, const uint32_t frames[2], picture_format *format,
                uint32_t size[2], char *error, size_t error_size)
{
    plate p = {.pattern = pattern, .first = scene_first};
    char path[4096], reason[1024];
    picture first = {.rgb = NULL};
    bool read = find_pictures(&p, frames, error, error_size) && name_of(&p, frames[0], path, error, error_size);
    if (read && !picture_read(path, &first, reason, sizeof reason))
        read = host_fail(error, error_size, "--plate: %s", reason);
    *format = first.format;
    size[0] = first.width;
    size[1] = first.height;
    free(first.rgb);
    plate_close(&p);
    return read;
}

bool plate_open(plate *p, const char *pattern, transfer_curve curve, uint32_t scene_first, const uint32_t frames[2],
                uint32_t width, uint32_t height, char *error, size_t error_size)
{
    *p = (plate){.pattern = pattern,
                 .curve = curve,
                 .first = scene_first,
                 .loaded = UINT32_MAX,
                 .width = width,
                 .height = height};
    if (!pattern)
        return true;
    if (!find_pictures(p, frames, error, error_size))
        return false;
    p->rgba = malloc((size_t)width * height * 4 * sizeof *p->rgba);
    return p->rgba || host_fail(error, error_size, "no memory for a plate of %u x %u", width, height);
}

void plate_close(plate *p)
{
    for (uint32_t i = 0; i < p->file_count; i++)
        free(p->files[i]);
    free(p->files);
    free(p->rgba);
    *p = (plate){0};
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
    float *rows_done = malloc((size_t)p->width * height * 3 * sizeof *rows_done);
    for (uint32_t row = 0; rows_done && row < height; row++)
        resample_line(rgb + (size_t)row * width * 3, 3, width, rows_done + (size_t)row * p->width * 3, 3, p->width);
    for (uint32_t column = 0; rows_done && column < p->width; column++)
        resample_line(rows_done + column * 3, (size_t)p->width * 3, height, p->rgba + column * 4, (size_t)p->width * 4,
                      p->height);
    free(rows_done);
    return rows_done;
}

static bool copy_picture(plate *p, const char *path, const float *rgb, uint32_t width, uint32_t height, char *error,
                         size_t error_size)
{
    const size_t pixels = (size_t)p->width * p->height;
    if (width == p->width && height == p->height) {
        for (size_t i = 0; i < pixels; i++)
            memcpy(p->rgba + i * 4, rgb + i * 3, 3 * sizeof *rgb);
    } else {
        if (!p->warned)
            fprintf(stderr, "virga: --plate: %s is %u x %u, resampled to %u x %u\n", path, width, height, p->width,
                    p->height);
        p->warned = true;
        if (!resample(p, rgb, width, height))
            return host_fail(error, error_size, "no memory for a plate of %u x %u", width, height);
    }
    for (size_t i = 0; i < pixels; i++)
        p->rgba[i * 4 + 3] = 1;
    return true;
}

bool plate_load(plate *p, uint32_t frame, char *error, size_t error_size)
{
    char path[4096], reason[1024];
    picture now;
    if (p->loaded == frame)
        return true;
    if (!name_of(p, frame, path, error, error_size))
        return false;
    if (!picture_read(path, &now, reason, sizeof reason))
        return host_fail(error, error_size, "--plate: %s", reason);
    picture_to_light(now.rgb, (size_t)now.width * now.height * 3, p->curve, now.format);
    const bool copied = copy_picture(p, path, now.rgb, now.width, now.height, error, error_size);
    free(now.rgb);
    p->loaded = copied ? frame : UINT32_MAX;
    return copied;
}
