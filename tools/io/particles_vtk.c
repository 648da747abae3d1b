/* particles_vtk.c - legacy VTK files: sections that begin with a keyword, as text or big-endian binary. */
#include "particle_reader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define BITS 100 /* a type that only VTK has: eight values in a byte */

typedef struct section {
    particle_reader *reader;
    bool ascii, points, point_data; /* the points were read; arrays belong to points */
    uint64_t rows;                  /* of arrays */
    char words[8][64];              /* of the newest line */
    int count;
} section;

static bool wrong_line(section *at, const char *expected)
{
    return stream_fail(&at->reader->stream, "'%.60s', expected %s", at->reader->stream.words, expected);
}

/* ---- words of a line */

/* False at the end of the file, and after an error. */
static bool next_words(section *at)
{
    at->count = 0;
    if (stream_at_end(&at->reader->stream))
        return false;
    const char *line = stream_line(&at->reader->stream);
    if (!line)
        return false;
    at->count = sscanf(line, "%63s %63s %63s %63s %63s %63s %63s %63s", at->words[0], at->words[1], at->words[2],
                       at->words[3], at->words[4], at->words[5], at->words[6], at->words[7]);
    return at->count > 0;
}

static bool is_keyword(const section *at, const char *keyword)
{
    return !strcasecmp(at->words[0], keyword);
}

static bool count_of(section *at, int word, uint64_t *count)
{
    char *end;
    if (word < at->count && at->words[word][0] >= '0' && at->words[word][0] <= '9') {
        *count = strtoull(at->words[word], &end, 10);
        if (!*end && *count <= (uint64_t)1 << 40)
            return true;
    }
    return wrong_line(at, "a count");
}

static bool type_of(section *at, int word, int *type)
{
    static const struct {
        const char *name;
        int type;
    } types[] = {
        {"float", SCALAR_F32},
        {"double", SCALAR_F64},
        {"int", SCALAR_I32},
        {"unsigned_int", SCALAR_U32},
        {"vtkIdType", SCALAR_I32},
        {"long", SCALAR_I64},
        {"short", SCALAR_I16},
        {"unsigned_short", SCALAR_U16},
        {"unsigned_long", SCALAR_U64},
        {"char", SCALAR_I8},
        {"signed_char", SCALAR_I8},
        {"unsigned_char", SCALAR_U8},
        {"bit", BITS},
        {"vtktypeint64", SCALAR_I64},
        {"vtktypeuint64", SCALAR_U64},
    };
    for (size_t i = 0; word < at->count && i < sizeof types / sizeof *types; i++)
        if (!strcasecmp(at->words[word], types[i].name)) {
            *type = types[i].type;
            return true;
        }
    return wrong_line(at, "a type like 'float' or 'int'");
}

/* ---- arrays */

static bool skip_values(section *at, uint64_t rows, uint64_t components, int type)
{
    uint64_t values;
    if (__builtin_mul_overflow(rows, components, &values))
        return wrong_line(at, "fewer values");
    if (at->ascii)
        return stream_skip_words(&at->reader->stream, values);
    return type == BITS ? stream_skip(&at->reader->stream, values / 8 + (values % 8 != 0), 1)
                        : stream_skip(&at->reader->stream, values, scalar_size((particle_scalar)type));
}

static bool read_column(section *at, particle_column column, int type)
{
    particle_stream *stream = &at->reader->stream;
    const uint32_t components = column_components(column);
    at->reader->found[column] = true;
    for (uint32_t row = 0; row < at->reader->out->count; row++)
        for (uint32_t i = 0; i < components; i++) {
            double value = 0;
            if (at->ascii) {
                if (!stream_number(stream, &value))
                    return false;
            } else {
                const uint8_t *bytes = stream_take(stream, scalar_size((particle_scalar)type));
                if (!bytes)
                    return false;
                value = scalar_value(bytes, (particle_scalar)type, true);
            }
            if (!reader_put(at->reader, column, row, i, value))
                return false;
        }
    return true;
}

static bool read_array(section *at, const char *name, uint64_t rows, uint64_t components, int type)
{
    const particle_column column =
        at->point_data && type != BITS ? reader_column(at->reader, name, components) : COLUMN_NONE;
    if (column == COLUMN_NONE)
        return skip_values(at, rows, components, type);
    if (rows != at->reader->out->count)
        return stream_fail(&at->reader->stream, "array '%.40s' has %llu rows, expected %u as there are points", name,
                           (unsigned long long)rows, at->reader->out->count);
    return read_column(at, column, type);
}

/* ---- sections */

static bool read_point_section(section *at)
{
    uint64_t count = 0;
    int type = BITS;
    if (at->points)
        return wrong_line(at, "POINTS only once");
    if (!count_of(at, 1, &count) || !type_of(at, 2, &type))
        return false;
    if (type == BITS)
        return wrong_line(at, "points of float or double");
    at->points = true;
    return reader_set_count(at->reader, count) && read_column(at, COLUMN_POSITION, type);
}

/* What follows a line, which may be binary numbers. */
static bool begins_with(section *at, const char *keyword)
{
    size_t size;
    const char *next = (const char *)stream_peek(&at->reader->stream, &size);
    return size >= strlen(keyword) && !strncasecmp(next, keyword, strlen(keyword));
}

/* Names of components and the like: lines up to an empty one. */
static bool skip_metadata(section *at)
{
    while (!stream_ended(&at->reader->stream)) {
        const char *line = stream_line(&at->reader->stream);
        if (!line || !*line)
            return line;
    }
    return true;
}

/* "CELLS 8 16" and its numbers, or since version 5.0 two arrays with keywords of their own. */
static bool skip_cells(section *at)
{
    uint64_t cells = 0, size = 0;
    int type = BITS;
    if (!count_of(at, 1, &cells) || !count_of(at, 2, &size))
        return false;
    if (!begins_with(at, "OFFSETS"))
        return skip_values(at, size, 1, SCALAR_I32);
    return next_words(at) && type_of(at, 1, &type) && skip_values(at, cells, 1, type) && next_words(at) &&
           type_of(at, 1, &type) && skip_values(at, size, 1, type);
}

/* SCALARS NAME TYPE [COMPONENTS], and LOOKUP_TABLE NAME, which some programs leave out. */
static bool read_scalars(section *at)
{
    uint64_t components = 1;
    int type = BITS;
    char name[64];
    if (!type_of(at, 2, &type) || (at->count > 3 && !count_of(at, 3, &components)))
        return false;
    strcpy(name, at->words[1]);
    if (begins_with(at, "LOOKUP_TABLE") && !stream_line(&at->reader->stream))
        return false;
    return read_array(at, name, at->rows, components, type);
}

/* FIELD NAME ARRAYS, then for each "NAME COMPONENTS ROWS TYPE" and its numbers. */
static bool read_field(section *at)
{
    uint64_t arrays = 0, components = 0, rows = 0;
    int type = BITS;
    char name[64];
    if (!count_of(at, 2, &arrays))
        return false;
    for (uint64_t i = 0; i < arrays; i++) {
        if (!next_words(at))
            return stream_fail(&at->reader->stream, "the file ends here, expected array %llu of %llu of a FIELD",
                               (unsigned long long)i + 1, (unsigned long long)arrays);
        if (is_keyword(at, "METADATA")) {
            if (!skip_metadata(at))
                return false;
            i--;
            continue;
        }
        if (!count_of(at, 1, &components) || !count_of(at, 2, &rows) || !type_of(at, 3, &type))
            return false;
        strcpy(name, at->words[0]);
        if (!read_array(at, name, rows, components, type))
            return false;
    }
    return true;
}

/* NAME TYPE, with a fixed number of components. */
static bool read_fixed(section *at, uint64_t components)
{
    int type = BITS;
    char name[64];
    if (!type_of(at, 2, &type))
        return false;
    strcpy(name, is_keyword(at, "GLOBAL_IDS") ? "global_ids" : at->words[1]);
    return read_array(at, name, at->rows, components, type);
}

static bool begin_data(section *at, bool of_points)
{
    if (!count_of(at, 1, &at->rows))
        return false;
    at->point_data = of_points;
    if (of_points && (!at->points || at->rows != at->reader->out->count))
        return wrong_line(at, "POINTS before it, and as many rows as points");
    return true;
}

static bool read_coordinates(section *at)
{
    uint64_t components = 0;
    int type = BITS;
    return count_of(at, 2, &components) && type_of(at, 3, &type) && skip_values(at, at->rows, components, type);
}

static bool read_colors(section *at)
{
    uint64_t components = 0;
    return count_of(at, 2, &components) && skip_values(at, at->rows, components, SCALAR_U8);
}

static bool read_table(section *at)
{
    uint64_t colors = 0;
    return count_of(at, 2, &colors) && skip_values(at, colors, 4, SCALAR_U8);
}

static bool read_cell_types(section *at)
{
    uint64_t cells = 0;
    return count_of(at, 1, &cells) && skip_values(at, cells, 1, SCALAR_I32);
}

static bool read_section(section *at)
{
    static const struct {
        const char *keyword;
        bool (*read)(section *at);
        uint64_t components; /* no function: NAME TYPE and so many */
    } sections[] = {
        {"POINTS", read_point_section, 0},
        {"VERTICES", skip_cells, 0},
        {"LINES", skip_cells, 0},
        {"POLYGONS", skip_cells, 0},
        {"TRIANGLE_STRIPS", skip_cells, 0},
        {"CELLS", skip_cells, 0},
        {"CELL_TYPES", read_cell_types, 0},
        {"SCALARS", read_scalars, 0},
        {"COLOR_SCALARS", read_colors, 0},
        {"LOOKUP_TABLE", read_table, 0},
        {"TEXTURE_COORDINATES", read_coordinates, 0},
        {"FIELD", read_field, 0},
        {"METADATA", skip_metadata, 0},
        {"VECTORS", NULL, 3},
        {"NORMALS", NULL, 3},
        {"TENSORS", NULL, 9},
        {"TENSORS6", NULL, 6},
        {"GLOBAL_IDS", NULL, 1},
        {"PEDIGREE_IDS", NULL, 1},
        {"EDGE_FLAGS", NULL, 1},
    };
    if (is_keyword(at, "POINT_DATA") || is_keyword(at, "CELL_DATA"))
        return begin_data(at, is_keyword(at, "POINT_DATA"));
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++)
        if (is_keyword(at, sections[i].keyword))
            return sections[i].read ? sections[i].read(at) : read_fixed(at, sections[i].components);
    return wrong_line(at, "a section like POINTS, POINT_DATA or VECTORS");
}

static bool read_header(section *at)
{
    particle_stream *stream = &at->reader->stream;
    if (!stream_line(stream) || !stream_line(stream) || !next_words(at)) /* version, title */
        return stream_fail(stream, "the file ends here, expected ASCII or BINARY");
    at->ascii = is_keyword(at, "ASCII");
    if (!at->ascii && !is_keyword(at, "BINARY"))
        return wrong_line(at, "ASCII or BINARY");
    if (!next_words(at))
        return stream_fail(stream, "the file ends here, expected DATASET");
    if (!is_keyword(at, "DATASET") || at->count < 2 ||
        (strcasecmp(at->words[1], "POLYDATA") && strcasecmp(at->words[1], "UNSTRUCTURED_GRID")))
        return wrong_line(at, "DATASET POLYDATA or UNSTRUCTURED_GRID");
    return true;
}

bool read_vtk(particle_reader *reader)
{
    section at = {.reader = reader};
    reader->stream.text = true;
    if (!read_header(&at))
        return false;
    reader->stream.text = at.ascii; /* lines mean nothing between binary numbers */
    while (next_words(&at))
        if (!read_section(&at))
            return false;
    if (reader->stream.failed)
        return false;
    return at.points || stream_fail(&reader->stream, "the file ends here, expected POINTS");
}
