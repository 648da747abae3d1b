/* options.c - command lines by table. */
#include "options.h"

#include "suggest.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool options_complain(const char *command, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "virga %s: ", command);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    return false;
}

static size_t find_row(const options *parsed, const char *text, size_t length)
{
    for (size_t i = 0; i < parsed->row_count; i++) {
        const option_row *row = &parsed->rows[i];
        if (strlen(row->name) == length && !strncmp(row->name, text, length))
            return i;
        if (length == 2 && text[0] == '-' && text[1] == row->letter && row->letter)
            return i;
    }
    return parsed->row_count;
}

static bool unknown(const options *parsed, const char *text, size_t length)
{
    const char *names[OPTIONS_MAX];
    char word[64];
    for (size_t i = 0; i < parsed->row_count; i++)
        names[i] = parsed->rows[i].name;
    snprintf(word, sizeof word, "%.*s", (int)length, text);
    const char *near = suggest_nearest(word, names, parsed->row_count);
    if (near)
        return options_complain(parsed->command, "no option %s; did you mean %s?", word, near);
    return options_complain(parsed->command, "no option %s; see virga help %s", word, parsed->command);
}

/* Reads the option at argv[*at]. Its value follows '=' or is the next argument. */
static bool read_option(options *parsed, int argc, char **argv, int *at)
{
    const char *text = argv[*at], *equals = strchr(text, '=');
    const size_t length = equals ? (size_t)(equals - text) : strlen(text);
    const size_t index = find_row(parsed, text, length);
    if (index == parsed->row_count)
        return unknown(parsed, text, length);
    const option_row *row = &parsed->rows[index];
    if (!row->value) {
        if (equals)
            return options_complain(parsed->command, "%s takes no value", row->name);
        parsed->values[index] = "";
        return true;
    }
    if (!equals && *at + 1 >= argc)
        return options_complain(parsed->command, "%s: expected %s behind it", row->name, row->value);
    const char *value = equals ? equals + 1 : argv[++*at];
    if (row->repeats) {
        if (parsed->repeated_count == sizeof parsed->repeated / sizeof parsed->repeated[0])
            return options_complain(parsed->command, "%s: more than 256 of them", row->name);
        parsed->repeated[parsed->repeated_count++] = value;
    } else if (parsed->values[index]) {
        return options_complain(parsed->command, "%s: given twice", row->name);
    }
    parsed->values[index] = value;
    return true;
}

bool options_parse(options *parsed, const char *command, const option_row *rows, size_t row_count, int argc,
                   char **argv)
{
    memset(parsed, 0, sizeof *parsed);
    parsed->command = command;
    parsed->rows = rows;
    parsed->row_count = row_count;
    for (int i = 0; i < argc; i++) {
        if (argv[i][0] == '-' && argv[i][1]) {
            if (!read_option(parsed, argc, argv, &i))
                return false;
        } else if (parsed->argument_count == sizeof parsed->arguments / sizeof parsed->arguments[0]) {
            return options_complain(command, "too many arguments from '%s' on", argv[i]);
        } else {
            parsed->arguments[parsed->argument_count++] = argv[i];
        }
    }
    return true;
}

const char *options_value(const options *parsed, const char *name)
{
    const size_t index = find_row(parsed, name, strlen(name));
    return index < parsed->row_count ? parsed->values[index] : NULL;
}

/* Prints the help of an option, wrapped and indented. */
static void print_wrapped(const char *text)
{
    enum { INDENT = 31, WIDTH = 100 };
    int column = INDENT;
    while (*text) {
        const int length = (int)strcspn(text, " ");
        if (column > INDENT && column + 1 + length > WIDTH) {
            printf("\n%*s", INDENT, "");
            column = INDENT;
        }
        column += printf("%s%.*s", column > INDENT ? " " : "", length, text);
        text += length + strspn(text + length, " ");
    }
    printf("\n");
}

void options_print(const option_row *rows, size_t row_count)
{
    for (size_t i = 0; i < row_count; i++) {
        char left[64];
        snprintf(left, sizeof left, "%c%c%s%s%s%s", rows[i].letter ? '-' : ' ', rows[i].letter ? rows[i].letter : ' ',
                 rows[i].letter ? ", " : "  ", rows[i].name, rows[i].value ? " " : "",
                 rows[i].value ? rows[i].value : "");
        printf("  %-28s ", left);
        print_wrapped(rows[i].help);
    }
}

static bool read_uint(const char *text, char **end, uint32_t *value)
{
    if (*text < '0' || *text > '9')
        return false;
    errno = 0;
    const unsigned long long read = strtoull(text, end, 10);
    *value = (uint32_t)read;
    return !errno && read <= UINT32_MAX;
}

bool options_uint(const options *parsed, const char *name, uint32_t lo, uint32_t hi, uint32_t *value)
{
    const char *text = options_value(parsed, name);
    char *end;
    if (!text)
        return true;
    if (!read_uint(text, &end, value) || *end || *value < lo || *value > hi)
        return options_complain(parsed->command, "%s: expected a whole number from %u to %u, got '%s'", name, lo, hi,
                                text);
    return true;
}

bool options_pair(const options *parsed, const char *name, char separator, bool one, uint32_t lo, uint32_t hi,
                  uint32_t pair[2])
{
    const char *text = options_value(parsed, name);
    char *end;
    if (!text)
        return true;
    bool right = read_uint(text, &end, &pair[0]);
    pair[1] = pair[0];
    if (right && *end == separator)
        right = read_uint(end + 1, &end, &pair[1]);
    else if (right)
        right = one;
    if (!right || *end || pair[0] < lo || pair[0] > hi || pair[1] < lo || pair[1] > hi)
        return options_complain(parsed->command, "%s: expected A%cB with whole numbers from %u to %u, got '%s'", name,
                                separator, lo, hi, text);
    return true;
}
