/* options.h - command lines by table: each command lists its options once, for parsing and for help. */
#ifndef VIRGA_TOOL_OPTIONS_H
#define VIRGA_TOOL_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { EXIT_OK = 0, EXIT_FAILED = 1, EXIT_USAGE = 2, EXIT_GAVE_UP = 3, EXIT_INTERRUPTED = 130 };

typedef struct option_row {
    const char *name;  /* "--size"; `letter` is its short form */
    char letter;       /* 0: none */
    const char *value; /* "WxH", or NULL for a flag */
    const char *help;
    bool repeats;
} option_row;

#define OPTIONS_MAX 64

typedef struct options {
    const char *command;
    const option_row *rows;
    size_t row_count;
    const char *values[OPTIONS_MAX]; /* of each row; NULL if it was not given; "" for a flag that is set */
    const char *repeated[256];       /* values of the option that may be repeated */
    size_t repeated_count;
    const char *arguments[16]; /* arguments that are not options */
    size_t argument_count;
} options;

/* Parses a command line. On failure prints one line on standard error and returns false; the command then exits with
 * EXIT_USAGE. */
bool options_parse(options *parsed, const char *command, const option_row *rows, size_t row_count, int argc,
                   char **argv);

/* Value of an option; NULL if it was not given. */
const char *options_value(const options *parsed, const char *name);

/* Prints the table. */
void options_print(const option_row *rows, size_t row_count);

/* Parses a value such as "7", "1-48" or "1280x720" into whole numbers. `separator` is between them. If `one` is set,
 * the second may be missing; then it equals the first. Prints one line and returns false if they are not in [lo; hi].
 * */
bool options_uint(const options *parsed, const char *name, uint32_t lo, uint32_t hi, uint32_t *value);
bool options_pair(const options *parsed, const char *name, char separator, bool one, uint32_t lo, uint32_t hi,
                  uint32_t pair[2]);

/* Prints "virga COMMAND: ..." on standard error and returns false. */
bool options_complain(const char *command, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
