/* text_lines.h - text files of numbers, line by line. What is wrong is one line: file, line, what was expected. */
#ifndef VIRGA_IO_TEXT_LINES_H
#define VIRGA_IO_TEXT_LINES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct text_lines {
    const char *path;
    FILE *file;
    uint32_t number; /* of the line, from 1; 0: messages name no line */
    char line[4096];
    bool is_long; /* the line is cut */
    char *error;
    size_t error_size;
} text_lines;

/* The text of `path` and `error` must outlive it. After success call text_lines_close. */
bool text_lines_open(text_lines *r, const char *path, char *error, size_t error_size);

/* False behind the last line. What does not fit is left out, and bytes that do not print become question marks. */
bool text_lines_next(text_lines *r);

/* The same without comments (#) and empty lines. */
bool text_lines_next_full(text_lines *r);

/* Begins again with the first line. */
void text_lines_rewind(text_lines *r);

/* Closes the file, and reports if it could not be read to its end. Returns `good` otherwise. */
bool text_lines_close(text_lines *r, bool good);

/* Write "file:line: expected ..., got ..." and return false. `format` prints one double. */
bool text_lines_wrong(const text_lines *r, const char *expected, const char *got);
bool text_lines_wrong_number(const text_lines *r, const char *expected, const char *format, double got);

/* The first finite numbers of the line from `at` on. *rest is what follows them. */
bool text_lines_numbers(const text_lines *r, const char *at, uint32_t count, const char *expected, double *numbers,
                        const char **rest);

/* The same, and nothing may follow. */
bool text_lines_all_numbers(const text_lines *r, const char *at, uint32_t count, const char *expected, double *numbers);

#endif
