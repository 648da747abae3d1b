/* picture.h - other people's pictures as code values: PNG and TIFF of 8 and 16 bits and of floats, JPEG, OpenEXR.
 * PNG, JPEG and TIFF go through OpenImageIO, where the program was built with it. */
#ifndef VIRGA_IO_PICTURE_H
#define VIRGA_IO_PICTURE_H

#include "transfer.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PICTURE_MAX_SIDE 16384 /* pixels; larger pictures are refused, read or written */

typedef enum picture_kind { PICTURE_EXR, PICTURE_PNG, PICTURE_JPEG, PICTURE_TIFF, PICTURE_KINDS } picture_kind;

typedef struct picture_format {
    picture_kind kind;
    uint32_t bits; /* of a sample: 8 or 16 (whole numbers), 32 (floats) */
} picture_format;

typedef struct picture {
    picture_format format;
    uint32_t width, height;
    uint32_t channels; /* in the file */
    /* 3 (RGB) values a pixel, rows from the top, to be freed by free(). Whole numbers are divided by their largest,
     * 255 or 65535. Grey is three times the same. Alpha is left out, and nothing is divided by it. */
    float *rgb;
} picture;

/* Whether PNG, JPEG and TIFF can be read and written. */
bool picture_has_codecs(void);

/* By the ending of a name, in either case: .exr, .png, .jpg, .jpeg, .tif, .tiff. False for others. */
bool picture_kind_of(const char *name, picture_kind *kind);

/* "png", as endings of names without the dot. */
const char *picture_ending(picture_kind kind);

/* Reads a picture of the kind that its name says. A picture turned by EXIF stays as it is stored. On failure p->rgb is
 * NULL and `error` has one line. NaN becomes 0 and infinity 65504; of EXR values below zero become 0 too. */
bool picture_read(const char *path, picture *p, char *error, size_t error_size);

/* What light the curve stands for: TRANSFER_AUTO is replaced by the curve of the format. */
transfer_curve picture_curve(transfer_curve curve, picture_format format);

/* Code values to linear light, in place: count values. */
void picture_to_light(float *values, size_t count, transfer_curve curve, picture_format format);

/* Linear light (RGBA; alpha is left out) to samples of a format: 3 a pixel, uint8_t, uint16_t or float by its bits.
 * Whole numbers are clamped. With 8 bits, noise of one code's width is added before rounding (dither), so that a mean
 * over pixels is that of the light. It depends on `seed` and the place alone. A value within 1/256 of a code gets that
 * code, so that what nothing was added to stays as it was; so does a pixel for which `changed` is 0, also where it was
 * not undone and done again as exactly. `changed` NULL: all may be. */
void picture_from_light(const float *rgba, const uint8_t *changed, size_t pixels, transfer_curve curve,
                        picture_format format, uint64_t seed, void *samples);

/* Writes 3 samples a pixel, under a temporary name, and renames. JPEG has quality 95 without subsampling. Not for
 * EXR. The bytes depend on the samples alone. */
bool picture_write(const char *path, picture_format format, uint32_t width, uint32_t height, const void *samples,
                   char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
