/* file.h - writes files that are whole or absent, and reads small files at once.
 *
 * A file is written under a temporary name in its folder and renamed when it is whole. A reader never sees half of it,
 * and an older file stays until the new one is complete. What is not a regular file (a pipe, /dev/full) is written
 * directly. Errors are one line: what failed, the path, and the system's reason.
 *
 * A temporary file is locked while it is written. So file_clean can remove those of killed programs and keep those of
 * running ones, also on another machine that shares the folder. */
#ifndef VIRGA_IO_FILE_H
#define VIRGA_IO_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct file_writer {
    char *path;      /* the final name */
    char *temporary; /* its name while it is written; NULL if the file is written directly */
    int descriptor;
    int failure; /* errno of the first write that failed; 0: none */
} file_writer;

/* Writes one line into `error` (may be NULL) and returns false, so that callers can `return file_fail(...)`. */
bool file_fail(char *error, size_t error_size, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Writes "`what` `path`: reason of `code`" and returns false. */
bool file_error(char *error, size_t error_size, const char *what, const char *path, int code);

/* Starts a file. After success call file_finish or file_abandon once; after failure, neither. */
bool file_start(file_writer *file, const char *path, char *error, size_t error_size);

/* Appends, or writes at an offset. False after a failure, which file_finish then reports.
 * Calls for one file must not overlap in time. */
bool file_write(file_writer *file, const void *data, size_t size);
bool file_write_at(file_writer *file, const void *data, size_t size, uint64_t offset);

/* Closes and renames the file. On any failure, also of an earlier write, it removes the temporary file and writes the
 * reason into `error`. */
bool file_finish(file_writer *file, char *error, size_t error_size);

/* Removes what was written so far. */
void file_abandon(file_writer *file);

/* Makes a folder and those above it, where they are missing. On failure errno says why. */
bool file_make_folder(const char *path);

/* Removes temporary files of killed programs from a folder. Returns their number. */
uint32_t file_clean(const char *folder);

/* Reads a whole file, to be freed by free(). A 0 byte follows the data. Refuses files larger than `limit` bytes. */
bool file_read(const char *path, size_t limit, void **data, size_t *size, char *error, size_t error_size);

#endif
