/* png.h - 8 bit pictures: PNG out, PNG and JPEG in, PNG as numbers, and the tone curve of previews. */
#ifndef VIRGA_IO_PNG_H
#define VIRGA_IO_PNG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PNG_MAX_SIDE 16384 /* pixels; larger pictures are refused, read or written */

/* Writes 3 (RGB) or 4 (RGBA) bytes per pixel, top row first, under a temporary name, and renames. */
bool png_write(const char *path, uint32_t width, uint32_t height, uint32_t channels, const uint8_t *pixels, char *error,
               size_t error_size);

/* Reads a PNG or JPEG file as RGBA, alpha 255 where it has none, to be freed by free(). */
bool png_read(const char *path, uint32_t *width, uint32_t *height, uint8_t **rgba, char *error, size_t error_size);

/* The same from memory; `what` names the picture in errors. */
bool png_read_memory(const void *data, size_t size, const char *what, uint32_t *width, uint32_t *height, uint8_t **rgba,
                     char *error, size_t error_size);

/* Reads a PNG file whose pixels are numbers rather than colours, one byte each, to be freed by free(): the number of
 * the palette's entry where it has a palette, else the first channel as it stands. 16 bits a channel are refused. */
bool png_read_numbers(const char *path, uint32_t *width, uint32_t *height, uint8_t **numbers, char *error,
                      size_t error_size);

/* Display bytes of linear light: exposure in stops, the tone curve of png_tone, sRGB. Alpha is dropped: a preview shows
 * what the camera sees. NaN and negative light show as black. `rgb` holds 3 bytes per pixel. */
void png_from_linear(const float *rgba, size_t pixels, float exposure_ev, uint8_t *rgb);

/* The tone curve alone: linear light in, linear display light [0; 1] out. Identity up to 0.6, then a rational shoulder
 * that leaves it with the same slope and meets 1 at 8 (three stops over white), so mid tones look as computed and
 * lamps keep their shape. Per channel, so very bright colours fade to white as they do on film. */
float png_tone(float linear);

#endif
