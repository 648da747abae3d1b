/* make_exr.h - writes the kinds of OpenEXR files that the program reads but never writes, through OpenEXR's C++ API. */
#ifndef VIRGA_TESTS_IO_MAKE_EXR_H
#define VIRGA_TESTS_IO_MAKE_EXR_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct exr_recipe {
    int width, height;
    int left, top;        /* corner of the data window */
    int compression;      /* as OpenEXR numbers them: 0 none, 3 zip, 4 piz, 8 DWAA, 9 DWAB */
    int tile;             /* side of a tile; 0: scan lines */
    bool mip;             /* with all levels (only the first is filled) */
    bool half;            /* stored as half, else as float */
    int rows;             /* rows written; the rest is missing. 0: all */
    const char *channels; /* one letter each: "RGB", "Y", "RGA" */
    int sampling;         /* of every channel in both directions; 0: 1 */
    const float *samples; /* per pixel as many as there are letters */
} exr_recipe;

bool make_exr(const char *path, const exr_recipe *recipe);

/* Two parts, the first of them RGB, 4 x 2 pixels of 0.5. */
bool make_exr_parts(const char *path);

/* One deep channel Z, 2 x 2 pixels with a sample each. */
bool make_exr_deep(const char *path);

#ifdef __cplusplus
}
#endif

#endif
