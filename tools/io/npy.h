/* npy.h - arrays of floats as NumPy saves them (numpy.save). */
#ifndef VIRGA_IO_NPY_H
#define VIRGA_IO_NPY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads an array of two dimensions (others of length 1 are left out) as rows of floats, to be freed by free(). The
 * elements are float32 or float64, little-endian, in C order; others are refused with one line that says what the file
 * has. Format versions 1 to 3. A side has 1 to 16384 elements. */
bool npy_read(const char *path, uint32_t *width, uint32_t *height, float **values, char *error, size_t error_size);

#endif
