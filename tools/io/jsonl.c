/* jsonl.c - builds each line in memory and writes it at once. */
#include "jsonl.h"

#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define MAX_FILTERED ((size_t)2 << 30) /* bytes */

/* ---- the file ---- */

/* Length of the file up to its last line end. */
static bool whole_lines(int descriptor, off_t size, off_t *length)
{
    char block[4096];
    while (size > 0) {
        off_t start = size > (off_t)sizeof block ? size - (off_t)sizeof block : 0;
        ssize_t got = pread(descriptor, block, (size_t)(size - start), start);
        if (got != (ssize_t)(size - start))
            return false;
        const char *last = memrchr(block, '\n', (size_t)got);
        if (last) {
            *length = start + (last - block) + 1;
            return true;
        }
        size = start;
    }
    *length = 0;
    return true;
}

static bool cut_half_line(int descriptor)
{
    struct stat info;
    off_t length = 0;
    if (fstat(descriptor, &info) != 0)
        return false;
    if (!S_ISREG(info.st_mode) || !info.st_size)
        return true;
    return whole_lines(descriptor, info.st_size, &length) &&
           (length == info.st_size || ftruncate(descriptor, length) == 0);
}

/* Moves the kept lines to the front of the text and returns their length. */
static size_t filter_lines(char *text, size_t size, bool (*keep)(void *user, const char *line), void *user)
{
    size_t kept = 0;
    for (char *line = text, *stop; (stop = memchr(line, '\n', size - (size_t)(line - text))); line = stop + 1) {
        size_t length = (size_t)(stop - line) + 1;
        *stop = 0;
        /* A line that contains a 0 is invalid. Some file systems leave zeros after a power failure. */
        bool stays = strlen(line) + 1 == length && keep(user, line);
        *stop = '\n';
        if (!stays)
            continue;
        memmove(text + kept, line, length);
        kept += length;
    }
    return kept;
}

bool jsonl_filter(const char *path, bool (*keep)(void *user, const char *line), void *user, char *error,
                  size_t error_size)
{
    void *text;
    size_t size;
    file_writer file;
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode))
        return true; /* jsonl_open reports what cannot be opened for writing */
    if (!file_read(path, MAX_FILTERED, &text, &size, error, error_size))
        return false;
    size_t kept = filter_lines(text, size, keep, user);
    bool ok = kept == size;
    if (!ok && file_start(&file, path, error, error_size)) {
        file_write(&file, text, kept);
        ok = file_finish(&file, error, error_size);
    }
    free(text);
    return ok;
}

bool jsonl_open(jsonl *file, const char *path, jsonl_mode mode, char *error, size_t error_size)
{
    /* A pipe that is opened for reading as well would be its own reader. */
    struct stat info;
    bool regular = stat(path, &info) != 0 || S_ISREG(info.st_mode);
    int access = mode == JSONL_APPEND && regular ? O_RDWR : O_WRONLY;
    int flags = O_CREAT | O_APPEND | O_CLOEXEC | (mode == JSONL_TRUNCATE ? O_TRUNC : 0);
    int code = ENOMEM;
    *file = (jsonl){.descriptor = -1, .path = strdup(path), .plain = newlocale(LC_ALL_MASK, "C", (locale_t)0)};
    if (file->path && file->plain) {
        file->descriptor = open(path, access | flags, 0666);
        if (file->descriptor >= 0 && (mode == JSONL_TRUNCATE || cut_half_line(file->descriptor)))
            return true;
        code = errno;
    }
    jsonl_close(file);
    return file_error(error, error_size, "cannot write", path, code);
}

void jsonl_close(jsonl *file)
{
    if (file->descriptor >= 0)
        close(file->descriptor);
    if (file->plain)
        freelocale(file->plain);
    free(file->path);
    free(file->line);
    *file = (jsonl){.descriptor = -1};
}

/* ---- the line ---- */

static void put(jsonl *file, const char *text, size_t size)
{
    if (file->room - file->used < size) {
        size_t room = (file->used + size) * 2;
        char *line = realloc(file->line, room);
        if (!line) {
            file->failure = ENOMEM;
            return;
        }
        file->line = line;
        file->room = room;
    }
    memcpy(file->line + file->used, text, size);
    file->used += size;
}

/* Bytes of the UTF-8 character at `s`; 0 if it is invalid (truncated, overlong, a surrogate, too large). */
static size_t utf8_length(const unsigned char *s)
{
    size_t length = s[0] < 0x80                   ? 1
                    : s[0] >= 0xC2 && s[0] < 0xE0 ? 2
                    : (s[0] & 0xF0) == 0xE0       ? 3
                    : s[0] >= 0xF0 && s[0] < 0xF5 ? 4
                                                  : 0;
    for (size_t i = 1; i < length; i++)
        if ((s[i] & 0xC0) != 0x80)
            return 0;
    if ((s[0] == 0xE0 && s[1] < 0xA0) || (s[0] == 0xED && s[1] > 0x9F) || (s[0] == 0xF0 && s[1] < 0x90) ||
        (s[0] == 0xF4 && s[1] > 0x8F))
        return 0;
    return length;
}

static void put_character(jsonl *file, const char *at, size_t length)
{
    static const char shorts[] = "\b\f\n\r\t", letters[] = "bfnrt";
    char escape[8] = {'\\'};
    const char *known = length == 1 ? strchr(shorts, *at) : NULL;
    if (known) {
        escape[1] = letters[known - shorts];
        put(file, escape, 2);
    } else if (length == 1 && (unsigned char)*at < 0x20) {
        snprintf(escape, sizeof escape, "\\u%04x", (unsigned)*at);
        put(file, escape, 6);
    } else {
        if (length == 1 && (*at == '"' || *at == '\\'))
            put(file, "\\", 1);
        put(file, at, length);
    }
}

static void put_text(jsonl *file, const char *text)
{
    put(file, "\"", 1);
    while (*text) {
        size_t length = utf8_length((const unsigned char *)text);
        if (length)
            put_character(file, text, length);
        else
            put(file, "\xEF\xBF\xBD", 3);
        text += length ? length : 1;
    }
    put(file, "\"", 1);
}

/* Writes the comma and the key before a value. */
static void put_key(jsonl *file, const char *key)
{
    if (file->comma)
        put(file, ",", 1);
    if (key) {
        put_text(file, key);
        put(file, ":", 1);
    }
    file->comma = true;
}

static void open_bracket(jsonl *file, const char *opener, char closer)
{
    if (file->depth == JSONL_MAX_DEPTH) {
        file->failure = EOVERFLOW;
        return;
    }
    put(file, opener, 1);
    file->closers[file->depth++] = closer;
    file->comma = false;
}

void jsonl_begin(jsonl *file)
{
    file->used = 0;
    file->depth = 0;
    file->comma = false;
    file->failure = 0;
    open_bracket(file, "{", '}');
}

void jsonl_number(jsonl *file, const char *key, double value)
{
    char digits[40] = "null";
    locale_t before = uselocale(file->plain);
    for (int precision = 6; isfinite(value) && precision <= 17; precision++) {
        snprintf(digits, sizeof digits, "%.*g", precision, value);
        if (strtod(digits, NULL) == value)
            break;
    }
    uselocale(before);
    put_key(file, key);
    put(file, digits, strlen(digits));
}

void jsonl_uint64(jsonl *file, const char *key, uint64_t value)
{
    char digits[24];
    snprintf(digits, sizeof digits, "%llu", (unsigned long long)value);
    put_key(file, key);
    put(file, digits, strlen(digits));
}

void jsonl_string(jsonl *file, const char *key, const char *value)
{
    put_key(file, key);
    if (value)
        put_text(file, value);
    else
        put(file, "null", 4);
}

void jsonl_boolean(jsonl *file, const char *key, bool value)
{
    put_key(file, key);
    put(file, value ? "true" : "false", value ? 4 : 5);
}

void jsonl_begin_object(jsonl *file, const char *key)
{
    put_key(file, key);
    open_bracket(file, "{", '}');
}

void jsonl_begin_array(jsonl *file, const char *key)
{
    put_key(file, key);
    open_bracket(file, "[", ']');
}

void jsonl_end(jsonl *file)
{
    if (!file->depth)
        return;
    put(file, &file->closers[--file->depth], 1);
    file->comma = true;
}

/* Writes the line. If that fails, removes the part that was written. */
static int write_line(const jsonl *file)
{
    ssize_t done;
    do
        done = write(file->descriptor, file->line, file->used);
    while (done < 0 && errno == EINTR);
    if (done == (ssize_t)file->used)
        return 0;
    int code = done < 0 ? errno : ENOSPC;
    struct stat info;
    if (done > 0 && fstat(file->descriptor, &info) == 0 && S_ISREG(info.st_mode) &&
        ftruncate(file->descriptor, info.st_size - done) != 0)
        code = errno;
    return code;
}

static bool finish_line(jsonl *file, char *error, size_t error_size)
{
    put(file, "\n", 1);
    int code = file->failure ? file->failure : write_line(file);
    file->used = 0;
    file->failure = 0;
    return code == 0 || file_error(error, error_size, "cannot write", file->path, code);
}

bool jsonl_end_line(jsonl *file, char *error, size_t error_size)
{
    while (file->depth)
        jsonl_end(file);
    return finish_line(file, error, error_size);
}

bool jsonl_add_line(jsonl *file, const char *line, size_t length, char *error, size_t error_size)
{
    jsonl_begin(file);
    file->used = 0;
    file->depth = 0;
    put(file, line, length);
    return finish_line(file, error, error_size);
}
