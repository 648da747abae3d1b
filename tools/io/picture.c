/* picture.c - pictures as files, and their code values as light. */
#include "picture.h"

#include "exr.h"
#include "file.h"
#include "picture_codec.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define MAX_FILE ((size_t)1 << 30) /* bytes */

/* ---- files */

static const struct {
    const char *ending;
    picture_kind kind;
} endings[] = {
    {"exr", PICTURE_EXR},   {"png", PICTURE_PNG},  {"jpg", PICTURE_JPEG},
    {"jpeg", PICTURE_JPEG}, {"tif", PICTURE_TIFF}, {"tiff", PICTURE_TIFF},
};

bool picture_has_codecs(void)
{
    return picture_codec_is_there();
}

bool picture_kind_of(const char *name, picture_kind *kind)
{
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof endings / sizeof endings[0]; i++)
        if (!strcasecmp(dot + 1, endings[i].ending)) {
            *kind = endings[i].kind;
            return true;
        }
    return false;
}

const char *picture_ending(picture_kind kind)
{
    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++)
        if (endings[i].kind == kind)
            return endings[i].ending;
    return "";
}

static bool read_exr(const char *path, picture *p, char *error, size_t error_size)
{
    p->format.bits = 32;
    p->channels = 3;
    return exr_read_rgb(path, &p->width, &p->height, &p->rgb, NULL, error, error_size);
}

bool picture_read(const char *path, picture *p, char *error, size_t error_size)
{
    char reason[512];
    void *data;
    size_t size;
    *p = (picture){.rgb = NULL};
    if (!picture_kind_of(path, &p->format.kind))
        return file_fail(error, error_size, "cannot read %s: expected a name that ends in .exr, .png, .jpg or .tif",
                         path);
    if (p->format.kind == PICTURE_EXR)
        return read_exr(path, p, error, error_size);
    if (!file_read(path, MAX_FILE, &data, &size, error, error_size))
        return false;
    const bool read = picture_decode(data, size, p, reason, sizeof reason);
    free(data);
    return read || file_fail(error, error_size, "cannot read %s: %s", path, reason);
}

bool picture_write(const char *path, picture_format format, uint32_t width, uint32_t height, const void *samples,
                   char *error, size_t error_size)
{
    char reason[512];
    void *data;
    size_t size;
    file_writer file;
    if (!picture_encode(format, width, height, samples, &data, &size, reason, sizeof reason))
        return file_fail(error, error_size, "cannot write %s: %s", path, reason);
    bool written = file_start(&file, path, error, error_size);
    if (written) {
        file_write(&file, data, size);
        written = file_finish(&file, error, error_size);
    }
    free(data);
    return written;
}

/* ---- light */

transfer_curve picture_curve(transfer_curve curve, picture_format format)
{
    return curve != TRANSFER_AUTO ? curve : format.bits == 32 ? TRANSFER_LINEAR : TRANSFER_SRGB;
}

/* Whole numbers have few values, so each is computed once. */
static void look_up(float *values, size_t count, transfer_curve curve, uint32_t largest)
{
    float *table = malloc(((size_t)largest + 1) * sizeof *table);
    for (uint32_t code = 0; table && code <= largest; code++)
        table[code] = (float)transfer_to_light(curve, (double)code / largest);
    for (size_t i = 0; i < count; i++)
        values[i] =
            table ? table[lrint((double)values[i] * largest)] : (float)transfer_to_light(curve, (double)values[i]);
    free(table);
}

void picture_to_light(float *values, size_t count, transfer_curve curve, picture_format format)
{
    const transfer_curve used = picture_curve(curve, format);
    if (used == TRANSFER_LINEAR)
        return;
    if (format.bits == 8 || format.bits == 16)
        look_up(values, count, used, (1u << format.bits) - 1);
    else
        for (size_t i = 0; i < count; i++)
            values[i] = (float)transfer_to_light(used, (double)values[i]);
}

/* Uniform in [0; 1): the finalizer of SplitMix64 (Steele, Lea and Flood 2014). */
static double noise(uint64_t seed, uint64_t place)
{
    uint64_t x = seed + (place + 1) * UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((x ^ x >> 31) >> 11) * 0x1p-53;
}

static uint32_t round_code(double code, uint32_t largest, bool dither, uint64_t seed, uint64_t place)
{
    if (!(code > 0))
        return 0;
    if (code >= largest)
        return largest;
    const double nearest = rint(code);
    if (!dither || fabs(code - nearest) < 1.0 / 256)
        return (uint32_t)nearest;
    return (uint32_t)floor(code + noise(seed, place));
}

void picture_from_light(const float *rgba, const uint8_t *changed, size_t pixels, transfer_curve curve,
                        picture_format format, uint64_t seed, void *samples)
{
    const transfer_curve used = picture_curve(curve, format);
    const uint32_t largest = format.bits == 32 ? 1 : (1u << format.bits) - 1;
    uint8_t *bytes = samples;
    uint16_t *words = samples;
    float *floats = samples;
    for (size_t i = 0; i < pixels * 3; i++) {
        const double code = transfer_to_code(used, (double)rgba[i / 3 * 4 + i % 3]);
        if (format.bits == 8)
            bytes[i] = (uint8_t)round_code(code * largest, largest, !changed || changed[i / 3], seed, i);
        else if (format.bits == 16)
            words[i] = (uint16_t)round_code(code * largest, largest, false, seed, i);
        else
            floats[i] = (float)code;
    }
}
