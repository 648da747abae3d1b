/* picture_codec_absent.c - no PNG, JPEG and TIFF: for builds without OpenImageIO. */
#include "picture_codec.h"

#include <stdio.h>

bool picture_codec_is_there(void)
{
    return false;
}

static bool refuse(char *reason, size_t reason_size)
{
    snprintf(reason, reason_size, "this program was built without OpenImageIO, which PNG, JPEG and TIFF need");
    return false;
}

bool picture_decode(const void *data, size_t size, picture *p, char *reason, size_t reason_size)
{
    (void)data;
    (void)size;
    (void)p;
    return refuse(reason, reason_size);
}

bool picture_encode(picture_format format, uint32_t width, uint32_t height, const void *samples, void **data,
                    size_t *size, char *reason, size_t reason_size)
{
    (void)format;
    (void)width;
    (void)height;
    (void)samples;
    (void)data;
    (void)size;
    return refuse(reason, reason_size);
}
