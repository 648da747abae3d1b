/* packed_file.h - a file of one block of bytes, compressed by zlib, behind a small head that can be read alone.
 *
 * A file is whole or absent, see file.h. Damage of either part is found when it is read. */
#ifndef VIRGA_IO_PACKED_FILE_H
#define VIRGA_IO_PACKED_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

bool packed_write(const char *path, const void *head, uint32_t head_size, const void *bytes, uint64_t size, char *error,
                  size_t error_size);

/* Reads the head, which must have that size. *size (may be NULL) gets the size of the block. */
bool packed_read_head(const char *path, void *head, uint32_t head_size, uint64_t *size, char *error, size_t error_size);

/* Reads the block, which must have that size. */
bool packed_read(const char *path, uint32_t head_size, void *bytes, uint64_t size, char *error, size_t error_size);

#endif
