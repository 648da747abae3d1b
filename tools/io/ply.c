/* ply.c - writes point caches and meshes, and reads point caches. */
#include "ply.h"

#include "file.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK    65536              /* bytes gathered before they are written */
#define MAX_FILE ((size_t)16 << 30) /* bytes */

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "rows are copied as they are: little-endian machines only");

/* ---- writing ---- */

static bool is_name(const char *name)
{
    size_t length = name ? strlen(name) : 0;
    if (!length || length > PLY_MAX_NAME)
        return false;
    for (size_t i = 0; i < length; i++)
        if (!isalnum((unsigned char)name[i]) && name[i] != '_')
            return false;
    return true;
}

static bool check_properties(const char *path, const ply_property *properties, uint32_t count, size_t stride,
                             char *error, size_t error_size)
{
    if (!count || count > PLY_MAX_PROPERTIES)
        return file_fail(error, error_size, "cannot write %s: %u properties, expected 1 to %d", path, count,
                         PLY_MAX_PROPERTIES);
    for (uint32_t i = 0; i < count; i++) {
        const char *name = properties[i].name;
        if (!is_name(name))
            return file_fail(error, error_size,
                             "cannot write %s: property name '%s' is not 1 to %d letters, digits or _", path,
                             name ? name : "", PLY_MAX_NAME);
        if (stride < 4 || properties[i].offset > stride - 4)
            return file_fail(error, error_size, "cannot write %s: property '%s' lies outside its row", path, name);
        for (uint32_t j = 0; j < i; j++)
            if (!strcmp(name, properties[j].name))
                return file_fail(error, error_size, "cannot write %s: property '%s' is given twice", path, name);
    }
    return true;
}

/* `faces` is NULL for points. */
static char *make_header(const ply_property *properties, uint32_t property_count, uint64_t count, const uint64_t *faces,
                         const char *const *comments, size_t *size)
{
    char *text = NULL;
    FILE *header = open_memstream(&text, size);
    if (!header)
        return NULL;
    fputs("ply\nformat binary_little_endian 1.0\n", header);
    for (; comments && *comments; comments++)
        /* The comment ends at a line end, which would begin another line of the header. */
        fprintf(header, "comment %.*s\n", (int)strcspn(*comments, "\r\n"), *comments);
    fprintf(header, "element vertex %llu\n", (unsigned long long)count);
    for (uint32_t i = 0; i < property_count; i++)
        fprintf(header, "property %s %s\n", properties[i].type == PLY_UINT ? "uint" : "float", properties[i].name);
    if (faces)
        fprintf(header, "element face %llu\nproperty list uchar int vertex_indices\n", (unsigned long long)*faces);
    fputs("end_header\n", header);
    if (fclose(header) == 0)
        return text;
    free(text);
    return NULL;
}

static void write_rows(file_writer *file, const ply_property *properties, uint32_t property_count, const uint8_t *rows,
                       size_t stride, uint64_t count)
{
    uint8_t block[BLOCK];
    size_t used = 0, row_bytes = (size_t)property_count * 4;
    for (uint64_t r = 0; r < count; r++, rows += stride) {
        if (used + row_bytes > BLOCK) {
            if (!file_write(file, block, used))
                return;
            used = 0;
        }
        for (uint32_t p = 0; p < property_count; p++, used += 4)
            memcpy(block + used, rows + properties[p].offset, 4);
    }
    file_write(file, block, used);
}

static void write_triangles(file_writer *file, const uint32_t (*triangles)[3], uint64_t count)
{
    enum { ROW = 1 + 3 * sizeof(uint32_t) };
    uint8_t block[BLOCK];
    size_t used = 0;
    for (uint64_t i = 0; i < count; i++, used += ROW) {
        if (used + ROW > BLOCK) {
            if (!file_write(file, block, used))
                return;
            used = 0;
        }
        block[used] = 3;
        memcpy(block + used + 1, triangles[i], sizeof triangles[i]);
    }
    file_write(file, block, used);
}

static bool write_file(const char *path, const ply_property *properties, uint32_t property_count, const void *rows,
                       size_t stride, uint64_t count, const uint32_t (*triangles)[3], const uint64_t *triangle_count,
                       const char *const *comments, char *error, size_t error_size)
{
    file_writer file;
    size_t size = 0;
    if (!check_properties(path, properties, property_count, stride, error, error_size))
        return false;
    char *header = make_header(properties, property_count, count, triangle_count, comments, &size);
    if (!header)
        return file_fail(error, error_size, "cannot write %s: no memory", path);
    bool ok = file_start(&file, path, error, error_size);
    if (ok) {
        file_write(&file, header, size);
        write_rows(&file, properties, property_count, rows, stride, count);
        if (triangle_count)
            write_triangles(&file, triangles, *triangle_count);
        ok = file_finish(&file, error, error_size);
    }
    free(header);
    return ok;
}

bool ply_write(const char *path, const ply_property *properties, uint32_t property_count, const void *rows,
               size_t stride, uint64_t count, const char *const *comments, char *error, size_t error_size)
{
    return write_file(path, properties, property_count, rows, stride, count, NULL, NULL, comments, error, error_size);
}

bool ply_write_mesh(const char *path, const ply_property *properties, uint32_t property_count, const void *rows,
                    size_t stride, uint64_t count, const uint32_t (*triangles)[3], uint64_t triangle_count,
                    const char *const *comments, char *error, size_t error_size)
{
    return write_file(path, properties, property_count, rows, stride, count, triangles, &triangle_count, comments,
                      error, error_size);
}

/* ---- reading ---- */

/* The state while a header is read. Lines are terminated in the buffer: `line` ends with 0. */
typedef struct header {
    const char *path;
    char *next, *end;
    char *line;
    char *error;
    size_t error_size;
} header;

static bool next_line(header *header)
{
    if (header->next >= header->end)
        return file_fail(header->error, header->error_size, "cannot read %s: the header has no end", header->path);
    char *stop = memchr(header->next, '\n', (size_t)(header->end - header->next));
    if (!stop)
        return file_fail(header->error, header->error_size, "cannot read %s: the header has no end", header->path);
    header->line = header->next;
    header->next = stop + 1;
    *stop = 0;
    if (stop > header->line && stop[-1] == '\r')
        stop[-1] = 0;
    return true;
}

static bool wrong_line(const header *header, const char *expected)
{
    return file_fail(header->error, header->error_size, "cannot read %s: header line '%.60s', expected %s",
                     header->path, header->line, expected);
}

static bool read_property(header *header, ply_points *points)
{
    char type[16], name[PLY_MAX_NAME + 1], rest;
    if (sscanf(header->line, "property %15s %31s %c", type, name, &rest) != 2 || !is_name(name))
        return wrong_line(header, "'property TYPE NAME'");
    bool real = !strcmp(type, "float") || !strcmp(type, "float32");
    if (!real && strcmp(type, "uint") && strcmp(type, "uint32"))
        return wrong_line(header, "a float or uint property");
    if (points->property_count == PLY_MAX_PROPERTIES)
        return wrong_line(header, "at most 64 properties");
    strcpy(points->properties[points->property_count].name, name);
    points->properties[points->property_count++].type = real ? PLY_FLOAT : PLY_UINT;
    return true;
}

static bool read_header(header *header, ply_points *points)
{
    enum { BEFORE, INSIDE, BEHIND } where = BEFORE; /* the vertex element */
    if (!next_line(header))
        return false;
    if (strcmp(header->line, "ply"))
        return wrong_line(header, "'ply'");
    if (!next_line(header))
        return false;
    if (strcmp(header->line, "format binary_little_endian 1.0"))
        return wrong_line(header, "'format binary_little_endian 1.0'");
    while (next_line(header)) {
        unsigned long long count = 0;
        char rest;
        const char *line = header->line;
        if (!strcmp(line, "end_header"))
            return (where != BEFORE && points->property_count) || wrong_line(header, "an element vertex before it");
        if (!strncmp(line, "comment", 7) || !strncmp(line, "obj_info", 8))
            continue;
        if (!strncmp(line, "element ", 8) && where != BEFORE) {
            where = BEHIND;
        } else if (where == BEFORE) {
            if (sscanf(line, "element vertex %llu %c", &count, &rest) != 1)
                return wrong_line(header, "'element vertex COUNT' first");
            points->count = count;
            where = INSIDE;
        } else if (where == INSIDE && !read_property(header, points)) {
            return false;
        }
    }
    return false;
}

static bool read_values(const header *header, ply_points *points)
{
    size_t row = (size_t)points->property_count * 4;
    size_t there = (size_t)(header->end - header->next);
    if (points->count > there / row)
        return file_fail(header->error, header->error_size,
                         "cannot read %s: %zu bytes of points, expected %llu rows of %zu", header->path, there,
                         (unsigned long long)points->count, row);
    points->values = malloc(points->count ? (size_t)points->count * row : row);
    if (!points->values)
        return file_fail(header->error, header->error_size, "cannot read %s: no memory", header->path);
    memcpy(points->values, header->next, (size_t)points->count * row);
    return true;
}

bool ply_read(const char *path, ply_points *points, char *error, size_t error_size)
{
    void *data;
    size_t size;
    *points = (ply_points){0};
    if (!file_read(path, MAX_FILE, &data, &size, error, error_size))
        return false;
    header header = {.path = path, .next = data, .end = (char *)data + size, .error = error, .error_size = error_size};
    bool ok = read_header(&header, points) && read_values(&header, points);
    free(data);
    if (!ok)
        *points = (ply_points){0};
    return ok;
}

int ply_find(const ply_points *points, const char *name)
{
    for (uint32_t i = 0; i < points->property_count; i++)
        if (!strcmp(points->properties[i].name, name))
            return (int)i;
    return -1;
}

void ply_free(ply_points *points)
{
    free(points->values);
    *points = (ply_points){0};
}
