/* jsonl.h - JSON lines: one object per line, each written by a single write(). So a reader never sees half a line,
 * neither while the file grows nor after a crash. Calls between jsonl_begin and jsonl_end_line return no errors;
 * jsonl_end_line reports them. */
#ifndef VIRGA_IO_JSONL_H
#define VIRGA_IO_JSONL_H

#include <locale.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define JSONL_MAX_DEPTH 32

typedef enum jsonl_mode {
    JSONL_TRUNCATE, /* replaces the file */
    JSONL_APPEND,   /* continues after the last whole line; half a line that a crash left is removed */
} jsonl_mode;

typedef struct jsonl {
    char *path;
    int descriptor;
    locale_t plain; /* numbers have decimal points in every locale */
    char *line;
    size_t used, room;
    char closers[JSONL_MAX_DEPTH]; /* brackets to be closed, innermost last */
    uint32_t depth;
    bool comma;  /* the next value needs a comma before it */
    int failure; /* errno */
} jsonl;

/* Removes lines from a file: all that are not whole, and those for which `keep` returns false (`line` has no line end).
 * The file is replaced at once, or not changed if all lines stay. A missing file is no error. */
bool jsonl_filter(const char *path, bool (*keep)(void *user, const char *line), void *user, char *error,
                  size_t error_size);

/* After success call jsonl_close once. */
bool jsonl_open(jsonl *file, const char *path, jsonl_mode mode, char *error, size_t error_size);
void jsonl_close(jsonl *file);

/* Starts a line with its object. An unfinished line is discarded. */
void jsonl_begin(jsonl *file);

/* Members of the innermost object, or, with a NULL key, elements of the innermost array. Text is UTF-8; invalid bytes
 * become U+FFFD. Numbers have as few digits as read back as the same double. NaN, infinity and a NULL string become
 * null. */
void jsonl_number(jsonl *file, const char *key, double value);
void jsonl_uint64(jsonl *file, const char *key, uint64_t value);
void jsonl_string(jsonl *file, const char *key, const char *value);
void jsonl_boolean(jsonl *file, const char *key, bool value);
void jsonl_begin_object(jsonl *file, const char *key);
void jsonl_begin_array(jsonl *file, const char *key);
void jsonl_end(jsonl *file); /* the innermost object or array */

/* Closes all open brackets and writes the line. After a failure no part of the line is in the file. */
bool jsonl_end_line(jsonl *file, char *error, size_t error_size);

/* Writes a whole line that another jsonl made; `line` has no line end. An unfinished line is discarded. */
bool jsonl_add_line(jsonl *file, const char *line, size_t length, char *error, size_t error_size);

#endif
