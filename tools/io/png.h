/* png.h - 8 bit pictures: writes PNG, reads PNG and JPEG, reads PNG as numbers; and the tone curve of previews. */
#ifndef VIRGA_IO_PNG_H
#define VIRGA_IO_PNG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PNG_MAX_SIDE 16384 /* pixels; larger pictures are refused, read or written */

/* Writes 1 (grey), 3 (RGB) or 4 (RGBA) bytes per pixel, top row first, under a temporary name, and renames. */
bool png_write(const char *path, uint32_t width, uint32_t height, uint32_t channels, const uint8_t *pixels, char *error,
               size_t error_size);

/* Reads a PNG or JPEG file as RGBA, to be freed by free(). Alpha is 255 if the file has none. */
bool png_read(const char *path, uint32_t *width, uint32_t *height, uint8_t **rgba, char *error, size_t error_size);

/* The same from memory; `what` names the picture in errors. */
bool png_read_memory(const void *data, size_t size, const char *what, uint32_t *width, uint32_t *height, uint8_t **rgba,
                     char *error, size_t error_size);

/* Reads a PNG file whose pixels are numbers, not colors, one byte each, to be freed by free(). A number is the index
 * into the palette if there is one, else the value of the first channel. 16 bits per channel are refused. */
bool png_read_numbers(const char *path, uint32_t *width, uint32_t *height, uint8_t **numbers, char *error,
                      size_t error_size);

/* How linear light [0; infinity) becomes linear display light [0; 1]. All are monotonic. */
typedef enum png_curve {
    /* Identity up to 0.6, then a rational shoulder that leaves it with the same slope and meets 1 at 8 (three stops
     * over white), so mid tones look as computed and lamps keep their shape. */
    PNG_CURVE_SHOULDER,
    /* Toe and shoulder of film: dark parts darker and with more contrast, bright colors towards white. The fit of
     * Narkowicz (2015) to the ACES reference transforms, with its exposure of 0.6. 0.18 becomes 0.140. */
    PNG_CURVE_FILMIC,
    PNG_CURVE_NONE, /* identity, clipped at 1 */
} png_curve;

/* Converts linear light to display values: exposure in stops, a tone curve, then sRGB. Ignores alpha. NaN and
 * negative values become black. `rgb` has 3 bytes per pixel. */
void png_from_linear(const float *rgba, size_t pixels, float exposure_ev, png_curve curve, uint8_t *rgb);

/* A tone curve alone: linear light in, linear display light [0; 1] out. For each channel by itself, so very bright
 * colors fade to white as they do on film. */
float png_tone(png_curve curve, float linear);

#endif
