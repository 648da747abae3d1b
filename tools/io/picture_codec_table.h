/* picture_codec_table.h - what the module of OpenImageIO gives to picture_codec.c. */
#ifndef VIRGA_IO_PICTURE_CODEC_TABLE_H
#define VIRGA_IO_PICTURE_CODEC_TABLE_H

#include "picture.h"

#ifdef __cplusplus
extern "C" {
#endif

/* As picture_decode and picture_encode in picture_codec.h. */
typedef struct picture_codec_table {
    bool (*decode)(const void *data, size_t size, picture *p, char *reason, size_t reason_size);
    bool (*encode)(picture_format format, uint32_t width, uint32_t height, const void *samples, void **data,
                   size_t *size, char *reason, size_t reason_size);
} picture_codec_table;

#define PICTURE_CODEC_TABLE virga_picture_codec
extern const picture_codec_table PICTURE_CODEC_TABLE;

#ifdef __cplusplus
}
#endif
#endif
