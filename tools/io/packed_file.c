/* packed_file.c - see packed_file.h. */
#include "packed_file.h"

#include "file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#define MAGIC "virgapk1"
#define LEVEL 1 /* of zlib: states are sparse, and higher levels take longer than the simulation does */
#define CHUNK (1u << 18)

typedef struct lead {
    char magic[8];
    uint32_t head_size, head_check; /* crc32 */
    uint64_t size;                  /* of the block before compression */
} lead;

/* ---- write */

/* Compresses into the file, chunk by chunk. zlib counts in 32 bits at a time. */
static bool deflate_into(file_writer *file, z_stream *stream, const char *bytes, uint64_t size)
{
    unsigned char out[1 << 14];
    int state = Z_OK;
    while (state != Z_STREAM_END) {
        if (!stream->avail_in && size) {
            stream->next_in = (unsigned char *)(uintptr_t)bytes;
            stream->avail_in = size < CHUNK ? (unsigned)size : CHUNK;
            bytes += stream->avail_in;
            size -= stream->avail_in;
        }
        stream->next_out = out;
        stream->avail_out = sizeof out;
        state = deflate(stream, size ? Z_NO_FLUSH : Z_FINISH);
        if (state == Z_STREAM_ERROR || !file_write(file, out, sizeof out - stream->avail_out))
            return false;
    }
    return true;
}

bool packed_write(const char *path, const void *head, uint32_t head_size, const void *bytes, uint64_t size, char *error,
                  size_t error_size)
{
    const lead first = {
        .magic = MAGIC, .head_size = head_size, .head_check = (uint32_t)crc32(0, head, head_size), .size = size};
    z_stream stream = {0};
    file_writer file;
    if (deflateInit(&stream, LEVEL) != Z_OK)
        return file_fail(error, error_size, "no memory to compress %s", path);
    if (!file_start(&file, path, error, error_size)) {
        deflateEnd(&stream);
        return false;
    }
    /* A failed write is reported by file_finish. */
    (void)(file_write(&file, &first, sizeof first) && file_write(&file, head, head_size) &&
           deflate_into(&file, &stream, bytes, size));
    deflateEnd(&stream);
    return file_finish(&file, error, error_size);
}

/* ---- read */

static bool damaged(const char *path, const char *what, char *error, size_t error_size)
{
    return file_fail(error, error_size, "%s: %s", path, what);
}

static FILE *open_behind_lead(const char *path, uint32_t head_size, lead *first, char *error, size_t error_size)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        file_error(error, error_size, "cannot read", path, errno);
        return NULL;
    }
    if (fread(first, 1, sizeof *first, file) == sizeof *first && !memcmp(first->magic, MAGIC, sizeof first->magic) &&
        first->head_size == head_size)
        return file;
    damaged(path, "not a checkpoint of this version of the program", error, error_size);
    fclose(file);
    return NULL;
}

bool packed_read_head(const char *path, void *head, uint32_t head_size, uint64_t *size, char *error, size_t error_size)
{
    lead first;
    FILE *file = open_behind_lead(path, head_size, &first, error, error_size);
    if (!file)
        return false;
    const bool whole = fread(head, 1, head_size, file) == head_size;
    fclose(file);
    if (!whole || (uint32_t)crc32(0, head, head_size) != first.head_check)
        return damaged(path, "its head is damaged", error, error_size);
    if (size)
        *size = first.size;
    return true;
}

/* Returns whether the stream held exactly `size` bytes. */
static bool inflate_from(FILE *file, z_stream *stream, unsigned char *bytes, uint64_t size)
{
    unsigned char in[1 << 14], rest;
    int state = Z_OK;
    while (state == Z_OK) {
        if (!stream->avail_in) {
            stream->next_in = in;
            stream->avail_in = (unsigned)fread(in, 1, sizeof in, file);
        }
        /* One byte more than expected shows a stream that is too long. */
        const unsigned room = size < CHUNK ? (unsigned)size : CHUNK;
        stream->next_out = room ? bytes : &rest;
        stream->avail_out = room ? room : 1;
        const unsigned before = stream->avail_out;
        state = inflate(stream, Z_NO_FLUSH);
        if (!room && stream->avail_out != before)
            return false;
        bytes += before - stream->avail_out;
        size -= room ? before - stream->avail_out : 0;
    }
    return state == Z_STREAM_END && !size;
}

bool packed_read(const char *path, uint32_t head_size, void *bytes, uint64_t size, char *error, size_t error_size)
{
    lead first;
    z_stream stream = {0};
    FILE *file = open_behind_lead(path, head_size, &first, error, error_size);
    if (!file)
        return false;
    bool whole = first.size == size && !fseek(file, (long)head_size, SEEK_CUR) && inflateInit(&stream) == Z_OK;
    if (whole) {
        whole = inflate_from(file, &stream, bytes, size);
        inflateEnd(&stream);
    }
    fclose(file);
    return whole || damaged(path, "it is damaged or cut off", error, error_size);
}
