/* picture_codec.h - decodes and encodes PNG, JPEG and TIFF in memory. Internal; for picture.c. */
#ifndef VIRGA_IO_PICTURE_CODEC_H
#define VIRGA_IO_PICTURE_CODEC_H

#include "picture.h"

#ifdef __cplusplus
extern "C" {
#endif

/* False: the program was built without OpenImageIO, and the other two only write so into `reason`. */
bool picture_codec_is_there(void);

/* Fills all of `p` but p->format.kind, which says what is expected. `reason` gets one line without the path. */
bool picture_decode(const void *data, size_t size, picture *p, char *reason, size_t reason_size);

/* *data: to be freed by free(). */
bool picture_encode(picture_format format, uint32_t width, uint32_t height, const void *samples, void **data,
                    size_t *size, char *reason, size_t reason_size);

#ifdef __cplusplus
}
#endif
#endif
