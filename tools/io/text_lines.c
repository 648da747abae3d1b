/* text_lines.c - reads a text file line by line. */
#include "text_lines.h"

#include "file.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool text_lines_open(text_lines *r, const char *path, char *error, size_t error_size)
{
    *r = (text_lines){.path = path, .error = error, .error_size = error_size, .file = fopen(path, "r")};
    return r->file || file_error(error, error_size, "cannot read", path, errno);
}

bool text_lines_next(text_lines *r)
{
    size_t length = 0;
    int c;
    r->is_long = false;
    while ((c = getc_unlocked(r->file)) != EOF && c != '\n') {
        const bool blank = c == '\t' || c == '\r';
        if (length + 1 < sizeof r->line)
            r->line[length++] = blank ? ' ' : c < ' ' || c > '~' ? '?' : (char)c;
        else
            r->is_long = true;
    }
    while (length && r->line[length - 1] == ' ')
        length--;
    r->line[length] = 0;
    if (c == EOF && !length)
        return false;
    r->number++;
    return true;
}

bool text_lines_next_full(text_lines *r)
{
    do {
        if (!text_lines_next(r))
            return false;
    } while (!r->line[strspn(r->line, " ")] || r->line[strspn(r->line, " ")] == '#');
    return true;
}

void text_lines_rewind(text_lines *r)
{
    rewind(r->file);
    r->number = 0;
}

bool text_lines_close(text_lines *r, bool good)
{
    const int failure = ferror(r->file) ? EIO : 0;
    fclose(r->file);
    return good && (!failure || file_error(r->error, r->error_size, "cannot read", r->path, failure));
}

bool text_lines_wrong(const text_lines *r, const char *expected, const char *got)
{
    return r->number
               ? file_fail(r->error, r->error_size, "%s:%u: expected %s, got %.60s", r->path, r->number, expected, got)
               : file_fail(r->error, r->error_size, "%s: expected %s, got %.60s", r->path, expected, got);
}

bool text_lines_wrong_number(const text_lines *r, const char *expected, const char *format, double got)
{
    char text[64];
    snprintf(text, sizeof text, format, got);
    return text_lines_wrong(r, expected, text);
}

bool text_lines_numbers(const text_lines *r, const char *at, uint32_t count, const char *expected, double *numbers,
                        const char **rest)
{
    char word[48];
    for (uint32_t i = 0; i < count; i++) {
        char *end;
        at += strspn(at, " ");
        numbers[i] = strtod(at, &end);
        if (!*at)
            return text_lines_wrong_number(r, expected, "%.0f numbers", i);
        if (end == at || (*end && *end != ' ') || !isfinite(numbers[i])) {
            snprintf(word, sizeof word, "'%.*s'", (int)strcspn(at, " ") < 40 ? (int)strcspn(at, " ") : 40, at);
            return text_lines_wrong(r, expected, word);
        }
        at = end;
    }
    *rest = at + strspn(at, " ");
    return true;
}

bool text_lines_all_numbers(const text_lines *r, const char *at, uint32_t count, const char *expected, double *numbers)
{
    const char *rest;
    return text_lines_numbers(r, at, count, expected, numbers, &rest) &&
           (!*rest || text_lines_wrong(r, expected, "more"));
}
