/* particle_stream.h - a file as bytes, lines and words, through gzip where it is compressed. Internal to particles. */
#ifndef VIRGA_IO_PARTICLE_STREAM_H
#define VIRGA_IO_PARTICLE_STREAM_H

#include <locale.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <zlib.h>

#define STREAM_BLOCK ((size_t)1 << 18) /* bytes: the most that stream_take gives */
#define STREAM_LINE  4096              /* bytes of the longest line */

typedef struct particle_stream {
    const char *path;
    gzFile file;
    uint8_t *block;
    size_t at, end;      /* of what is in the block */
    uint64_t start;      /* bytes before the block */
    uint64_t line, byte; /* where the newest line, word or run of bytes began */
    uint64_t line_ends;  /* that were passed */
    bool text;           /* errors name the line; otherwise the byte */
    bool failed;
    locale_t plain; /* numbers have points, whatever the user's language */
    char words[STREAM_LINE + 1];
    char *error;
    size_t error_size;
} particle_stream;

/* Only regular files: others may have no end. After success call stream_close once. */
bool stream_open(particle_stream *stream, const char *path, char *error, size_t error_size);
void stream_close(particle_stream *stream);

/* Writes "cannot read PATH: line N: ...", where no error was written before, and returns false. */
bool stream_fail(particle_stream *stream, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The first bytes of the file, at most STREAM_BLOCK; call it before anything else. */
const uint8_t *stream_peek(particle_stream *stream, size_t *size);

/* Whether nothing follows; the second passes white space first. */
bool stream_ended(particle_stream *stream);
bool stream_at_end(particle_stream *stream);

/* The next `size` bytes, at most STREAM_BLOCK. Valid until the next call. NULL where the file ends. */
const uint8_t *stream_take(particle_stream *stream, size_t size);

/* Passes `count` times `size` bytes. */
bool stream_skip(particle_stream *stream, uint64_t count, uint64_t size);

/* The next line, without its end. Valid until the next call; may be changed. NULL where there is none. */
char *stream_line(particle_stream *stream);

/* The next word between white space, at most 63 bytes. Valid until the next call. NULL where there is none. */
char *stream_word(particle_stream *stream);

/* The next word as a number. */
bool stream_number(particle_stream *stream, double *number);

/* Passes words. */
bool stream_skip_words(particle_stream *stream, uint64_t count);

#endif
