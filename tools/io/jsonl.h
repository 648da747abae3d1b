/* jsonl.h - JSON lines: one object per line, each line written whole by a single write().
 *
 * A reader that follows the file while it grows, or after a crash, never sees half a line. The calls between
 * jsonl_begin and jsonl_end_line cannot fail by themselves: what went wrong is reported by jsonl_end_line. */
#ifndef VIRGA_IO_JSONL_H
#define VIRGA_IO_JSONL_H

#include <locale.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define JSONL_MAX_DEPTH 32

typedef enum jsonl_mode {
    JSONL_TRUNCATE, /* starts anew */
    JSONL_APPEND,   /* goes on behind the last whole line; half a line that a crash left there is cut off */
} jsonl_mode;

typedef struct jsonl {
    char *path;
    int descriptor;
    locale_t plain; /* numbers have points, whatever the user's language */
    char *line;
    size_t used, room;
    char closers[JSONL_MAX_DEPTH]; /* brackets to close, innermost last */
    uint32_t depth;
    bool comma;  /* a value stands before the next one */
    int failure; /* errno */
} jsonl;

/* Leaves in a file only the whole lines that `keep` wants (`line` ends with 0 in place of its line end). The file is
 * replaced at once, or left alone where all may stay. A missing file is fine. */
bool jsonl_filter(const char *path, bool (*keep)(void *user, const char *line), void *user, char *error,
                  size_t error_size);

/* After success call jsonl_close once. */
bool jsonl_open(jsonl *file, const char *path, jsonl_mode mode, char *error, size_t error_size);
void jsonl_close(jsonl *file);

/* Starts a line with its object; what an unfinished one held is dropped. */
void jsonl_begin(jsonl *file);

/* Members of the innermost object, or with a NULL key elements of the innermost array. Text is UTF-8: what is not
 * becomes U+FFFD. Numbers have the fewest digits that read back as the same double; NaN, infinity and a NULL string
 * become null. */
void jsonl_number(jsonl *file, const char *key, double value);
void jsonl_uint64(jsonl *file, const char *key, uint64_t value);
void jsonl_string(jsonl *file, const char *key, const char *value);
void jsonl_boolean(jsonl *file, const char *key, bool value);
void jsonl_begin_object(jsonl *file, const char *key);
void jsonl_begin_array(jsonl *file, const char *key);
void jsonl_end(jsonl *file); /* the innermost object or array */

/* Closes what is open and writes the line. After a failure nothing of the line is in the file. */
bool jsonl_end_line(jsonl *file, char *error, size_t error_size);

#endif
