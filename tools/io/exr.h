/* exr.h - OpenEXR pictures: writes layered frames, and reads pictures and headers. Writing uses OpenEXR's C core.
 * Reading uses its C++ library (exr_read.cpp), which supports all compressions. */
#ifndef VIRGA_IO_EXR_H
#define VIRGA_IO_EXR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXR_MAX_SIDE 16384 /* pixels; larger pictures are refused, read or written */
#define EXR_MAX_NAME 31    /* bytes in a channel's or attribute's name: longer ones are not read everywhere */

/* How a channel is stored. */
typedef enum exr_sample {
    EXR_SAMPLE_HALF,  /* from floats, rounded to nearest even; beyond +-65504 becomes +-65504, NaN becomes 0 */
    EXR_SAMPLE_FLOAT, /* from floats, bit for bit */
    EXR_SAMPLE_UINT,  /* from uint32_t */
} exr_sample;

typedef enum exr_packing {
    EXR_PACKING_ZIP, /* blocks of 16 lines, level 4: a good trade of time for size */
    EXR_PACKING_ZIPS,
    EXR_PACKING_RLE,
    EXR_PACKING_PIZ,
    EXR_PACKING_NONE,
} exr_packing;

typedef struct exr_channel {
    const char *name; /* "R", "rain.R", "Z" */
    exr_sample type;
    const void *data;  /* top left sample: float for half and float channels, else uint32_t */
    size_t stride;     /* bytes from a pixel to the next; 0: 4, tightly packed */
    size_t row_stride; /* bytes from a row to the row below; 0: width times stride */
} exr_channel;

typedef enum exr_attribute_kind {
    EXR_ATTRIBUTE_STRING,
    EXR_ATTRIBUTE_INT,
    EXR_ATTRIBUTE_FLOAT,
    EXR_ATTRIBUTE_DOUBLE,
    EXR_ATTRIBUTE_M44F,
    EXR_ATTRIBUTE_RATIONAL,
} exr_attribute_kind;

typedef struct exr_attribute {
    const char *name; /* e.g. the standard ones worldToCamera (M44F), framesPerSecond (RATIONAL), comments */
    exr_attribute_kind kind;
    union {
        const char *string;
        int32_t integer;
        float real;
        double real64;
        /* OpenEXR multiplies row vectors (p * M), so a column-major matrix for column vectors (GLSL, cglm) already has
         * the right order in memory. */
        float m44f[16];
        struct {
            int32_t numerator;
            uint32_t denominator;
        } rational;
    };
} exr_attribute;

#define EXR_UINT_DIGITS 11 /* size of the longest uint32_t as a decimal string */

/* An attribute that holds any uint32_t, e.g. the frames' `seed`. OpenEXR only has signed integers. So the attribute is
 * an int up to 2147483647, and above that a string of decimal digits. The digits are written to `digits`, which must
 * live until the frame is written. exr_read_header returns the same text for both. */
exr_attribute exr_attribute_uint(const char *name, uint32_t value, char digits[EXR_UINT_DIGITS]);

typedef struct exr_frame {
    uint32_t width, height;
    const exr_channel *channels; /* in any order; the file has them sorted by name */
    uint32_t channel_count;
    const exr_attribute *attributes;
    uint32_t attribute_count;
    exr_packing packing;
} exr_frame;

/* Writes the frame under a temporary name and renames it. Everything the frame points to is only read.
 * The bytes of the file depend on the frame alone.
 * Thread-safety: frames may be written by several threads at once; each call works with up to two of its own. */
bool exr_write(const char *path, const exr_frame *frame, char *error, size_t error_size);

/* Reads R, G and B (or only Y, as grey) as tightly packed RGB floats, top row first, to be freed by free(). NaN and
 * negative values become 0, infinity becomes 65504. `repaired` (may be NULL) is set to the number of such samples. */
bool exr_read_rgb(const char *path, uint32_t *width, uint32_t *height, float **rgb, uint64_t *repaired, char *error,
                  size_t error_size);

/* A channel that exr_read_channels reads. */
typedef struct exr_request {
    const char *name;
    exr_sample type; /* FLOAT (also for half channels in the file) or UINT */
    void *data;      /* output: width times height floats or uint32_t with unchanged bits, to be freed by free() */
} exr_request;

/* Reads named channels. On failure no request has data. */
bool exr_read_channels(const char *path, uint32_t *width, uint32_t *height, exr_request *requests, uint32_t count,
                       char *error, size_t error_size);

/* A string or int attribute that exr_read_header reads. */
typedef struct exr_text {
    const char *name;
    char text[256]; /* output; an int as decimal digits; "" if there is none, or if it has another kind */
} exr_text;

typedef struct exr_header {
    uint32_t width, height;
    char channels[1024]; /* names with a comma before and after each: ",A,B,G,R,"; truncated if there are too many */
} exr_header;

/* Reads the header of a picture, but no pixels. A picture with missing lines is refused. */
bool exr_read_header(const char *path, exr_header *header, exr_text *texts, uint32_t count, char *error,
                     size_t error_size);

#ifdef __cplusplus
}
#endif

#endif
