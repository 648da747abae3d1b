/* particle_stream.c - bytes, lines and words of a file. */
#include "particle_stream.h"

#include "file.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A file of some megabytes can unpack to a thousand times as much, so what is read has an end of its own. */
#define MAX_BYTES ((uint64_t)16 << 30)
#define MAX_WORD  63

bool stream_fail(particle_stream *stream, const char *format, ...)
{
    char what[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    for (char *c = what; *c; c++)
        *c = (unsigned char)*c < 32 || (unsigned char)*c > 126 ? '?' : *c;
    if (stream->error && stream->error_size && !stream->failed)
        snprintf(stream->error, stream->error_size, "cannot read %s: %s %llu: %s", stream->path,
                 stream->text ? "line" : "byte", (unsigned long long)(stream->text ? stream->line : stream->byte),
                 what);
    stream->failed = true;
    return false;
}

/* ---- open and close */

static bool open_file(particle_stream *stream, char *error, size_t error_size)
{
    struct stat info;
    int descriptor = open(stream->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0)
        return file_error(error, error_size, "cannot read", stream->path, errno);
    if (fstat(descriptor, &info) != 0 || !S_ISREG(info.st_mode)) {
        close(descriptor);
        return file_fail(error, error_size, "cannot read %s: expected a regular file", stream->path);
    }
    stream->file = gzdopen(descriptor, "rb");
    if (stream->file)
        return true;
    close(descriptor);
    return file_error(error, error_size, "cannot read", stream->path, ENOMEM);
}

bool stream_open(particle_stream *stream, const char *path, char *error, size_t error_size)
{
    memset(stream, 0, sizeof *stream);
    stream->path = path;
    stream->error = error;
    stream->error_size = error_size;
    stream->line = 1;
    if (!open_file(stream, error, error_size))
        return false;
    gzbuffer(stream->file, 1 << 17);
    stream->block = malloc(STREAM_BLOCK);
    stream->plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (stream->block && stream->plain)
        return true;
    stream_close(stream);
    return file_error(error, error_size, "cannot read", path, ENOMEM);
}

void stream_close(particle_stream *stream)
{
    if (stream->file)
        gzclose(stream->file);
    if (stream->plain)
        freelocale(stream->plain);
    free(stream->block);
    stream->file = NULL;
    stream->plain = (locale_t)0;
    stream->block = NULL;
}

/* ---- bytes */

static bool broken(particle_stream *stream)
{
    int code = Z_OK;
    const char *reason = gzerror(stream->file, &code);
    if (code == Z_OK || code == Z_STREAM_END)
        return false;
    stream->byte = stream->start + stream->end;
    stream->text = false;
    if (code == Z_BUF_ERROR)
        stream_fail(stream, "the gzip data ends too early");
    else if (code == Z_ERRNO)
        stream_fail(stream, "%s", strerror(errno));
    else
        stream_fail(stream, "damaged gzip data (%s)", reason);
    return true;
}

/* Reads behind what is in the block. False at the end of the file, and after an error. */
static bool fill(particle_stream *stream)
{
    memmove(stream->block, stream->block + stream->at, stream->end - stream->at);
    stream->start += stream->at;
    stream->end -= stream->at;
    stream->at = 0;
    if (stream->start + stream->end > MAX_BYTES)
        return stream_fail(stream, "more than %llu GiB, expected less", (unsigned long long)(MAX_BYTES >> 30));
    const int got = gzread(stream->file, stream->block + stream->end, (unsigned)(STREAM_BLOCK - stream->end));
    if (got <= 0)
        return broken(stream), false;
    stream->end += (size_t)got;
    return true;
}

const uint8_t *stream_peek(particle_stream *stream, size_t *size)
{
    while (stream->end - stream->at < STREAM_BLOCK && fill(stream))
        ;
    *size = stream->end - stream->at;
    return stream->block + stream->at;
}

const uint8_t *stream_take(particle_stream *stream, size_t size)
{
    stream->byte = stream->start + stream->at;
    while (stream->end - stream->at < size)
        if (!fill(stream)) {
            stream_fail(stream, "the file ends at byte %llu, expected %zu bytes here",
                        (unsigned long long)(stream->start + stream->end), size);
            return NULL;
        }
    stream->at += size;
    return stream->block + stream->at - size;
}

bool stream_skip(particle_stream *stream, uint64_t count, uint64_t size)
{
    uint64_t left;
    stream->byte = stream->start + stream->at;
    if (__builtin_mul_overflow(count, size, &left))
        return stream_fail(stream, "%llu times %llu bytes, expected fewer", (unsigned long long)count,
                           (unsigned long long)size);
    const uint64_t whole = left;
    for (;;) {
        const size_t there = stream->end - stream->at;
        const size_t part = left < there ? (size_t)left : there;
        stream->at += part;
        left -= part;
        if (!left)
            return true;
        if (!fill(stream))
            return stream_fail(stream, "the file ends at byte %llu, expected %llu bytes here",
                               (unsigned long long)(stream->start + stream->end), (unsigned long long)whole);
    }
}

/* ---- text */

static bool is_space(uint8_t c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static bool pass_space(particle_stream *stream)
{
    for (;;) {
        for (; stream->at < stream->end; stream->at++) {
            if (!is_space(stream->block[stream->at]))
                return true;
            stream->line_ends += stream->block[stream->at] == '\n';
        }
        if (!fill(stream))
            return false;
    }
}

static void note_place(particle_stream *stream)
{
    stream->line = stream->line_ends + 1;
    stream->byte = stream->start + stream->at;
}

bool stream_ended(particle_stream *stream)
{
    return stream->at == stream->end && !fill(stream);
}

bool stream_at_end(particle_stream *stream)
{
    return !pass_space(stream);
}

char *stream_line(particle_stream *stream)
{
    size_t length = 0;
    note_place(stream);
    for (;;) {
        const uint8_t *from = stream->block + stream->at;
        const uint8_t *stop = memchr(from, '\n', stream->end - stream->at);
        if (stop)
            length = (size_t)(stop - from);
        else if (stream->end - stream->at <= STREAM_LINE && fill(stream))
            continue;
        else
            length = stream->end - stream->at;
        if (length > STREAM_LINE) {
            stream_fail(stream, "a line of more than %d bytes, expected a shorter one", STREAM_LINE);
            return NULL;
        }
        if (!stop && !length) {
            stream_fail(stream, "the file ends here, expected another line");
            return NULL;
        }
        memcpy(stream->words, stream->block + stream->at, length);
        stream->at += length + (stop != NULL);
        stream->line_ends += stop != NULL;
        length -= length && stream->words[length - 1] == '\r';
        stream->words[length] = 0;
        return stream->words;
    }
}

char *stream_word(particle_stream *stream)
{
    const bool more = pass_space(stream);
    size_t length = 0;
    note_place(stream);
    if (!more) {
        stream_fail(stream, "the file ends here, expected a number");
        return NULL;
    }
    while (length <= MAX_WORD) {
        if (stream->at == stream->end && !fill(stream))
            break;
        if (is_space(stream->block[stream->at]))
            break;
        stream->words[length++] = (char)stream->block[stream->at++];
    }
    stream->words[length] = 0;
    if (length <= MAX_WORD)
        return stream->words;
    stream_fail(stream, "'%.20s...', expected a number", stream->words);
    return NULL;
}

bool stream_number(particle_stream *stream, double *number)
{
    char *end;
    const char *word = stream_word(stream);
    if (!word)
        return false;
    *number = strtod_l(word, &end, stream->plain);
    return (end != word && !*end) || stream_fail(stream, "'%s', expected a number", word);
}

bool stream_skip_words(particle_stream *stream, uint64_t count)
{
    for (uint64_t i = 0; i < count; i++)
        if (!stream_word(stream))
            return false;
    return true;
}
