/* particles_ply.c - PLY: elements with properties, as text or binary. The element `vertex` has the particles. */
#include "particle_reader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_ELEMENTS = 64, MAX_PROPERTIES = 1024, MAX_HEADER_LINES = 10000 };

typedef struct property {
    particle_scalar type, length; /* of the values; (list) of its length */
    bool list;
    particle_column column;
    uint32_t component;
} property;

typedef struct element {
    uint64_t count;
    uint32_t first, properties; /* of header.properties */
    bool particles;
} element;

typedef struct header {
    element elements[MAX_ELEMENTS];
    property properties[MAX_PROPERTIES];
    uint32_t element_count, property_count;
    uint32_t components[COLUMN_COUNT]; /* bits: that the vertices have */
    bool ascii, big_endian;
} header;

/* ---- header */

static bool find_type(const char *name, particle_scalar *type)
{
    static const struct {
        const char *names[2];
        particle_scalar type;
    } types[] = {
        {{"char", "int8"}, SCALAR_I8},       {{"uchar", "uint8"}, SCALAR_U8},   {{"short", "int16"}, SCALAR_I16},
        {{"ushort", "uint16"}, SCALAR_U16},  {{"int", "int32"}, SCALAR_I32},    {{"uint", "uint32"}, SCALAR_U32},
        {{"long", "int64"}, SCALAR_I64},     {{"ulong", "uint64"}, SCALAR_U64}, {{"float", "float32"}, SCALAR_F32},
        {{"double", "float64"}, SCALAR_F64},
    };
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (!strcmp(name, types[i].names[0]) || !strcmp(name, types[i].names[1])) {
            *type = types[i].type;
            return true;
        }
    return false;
}

static bool wrong_line(particle_stream *stream, const char *expected)
{
    return stream_fail(stream, "'%.60s', expected %s", stream->words, expected);
}

static bool read_format_line(particle_stream *stream, header *head)
{
    const char *line = stream_line(stream);
    if (!line)
        return false;
    head->ascii = !strcmp(line, "format ascii 1.0");
    head->big_endian = !strcmp(line, "format binary_big_endian 1.0");
    return head->ascii || head->big_endian || !strcmp(line, "format binary_little_endian 1.0") ||
           wrong_line(stream, "'format ascii 1.0', or binary_little_endian, or binary_big_endian");
}

static bool read_element(particle_stream *stream, header *head, const char *line)
{
    char name[64], digits[21], rest;
    if (head->element_count == MAX_ELEMENTS)
        return wrong_line(stream, "at most 64 elements");
    if (sscanf(line, "element %63s %20s %c", name, digits, &rest) != 2 || digits[strspn(digits, "0123456789")])
        return wrong_line(stream, "'element NAME COUNT'");
    head->elements[head->element_count++] = (element){
        .count = strtoull(digits, NULL, 10), .first = head->property_count, .particles = !strcmp(name, "vertex")};
    return true;
}

/* The column that a property of the vertices means. */
static void find_column(const particle_reader *reader, header *head, const char *name, property *found)
{
    const char *axis = strchr("xyz", *name);
    found->column = COLUMN_NONE;
    found->component = 0;
    if (*name && axis && !name[1]) {
        found->column = COLUMN_POSITION;
        found->component = (uint32_t)(axis - "xyz");
    } else if (velocity_component(name) >= 0) {
        found->column = COLUMN_VELOCITY;
        found->component = (uint32_t)velocity_component(name);
    } else {
        found->column = reader_column(reader, name, 1);
    }
    if (found->column == COLUMN_NONE)
        return;
    if (head->components[found->column] & 1u << found->component)
        found->column = COLUMN_NONE; /* the first counts */
    else
        head->components[found->column] |= 1u << found->component;
}

static bool read_property(particle_reader *reader, header *head, const char *line)
{
    particle_stream *stream = &reader->stream;
    char type[64], length[64], name[64], rest;
    property made = {.column = COLUMN_NONE};
    if (!head->element_count)
        return wrong_line(stream, "an element first");
    if (head->property_count == MAX_PROPERTIES)
        return wrong_line(stream, "at most 1024 properties");
    made.list = sscanf(line, "property list %63s %63s %63s %c", length, type, name, &rest) == 3;
    if (!made.list && sscanf(line, "property %63s %63s %c", type, name, &rest) != 2)
        return wrong_line(stream, "'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    if (!find_type(type, &made.type) ||
        (made.list && (!find_type(length, &made.length) || scalar_is_real(made.length))))
        return wrong_line(stream, "a type like 'float' or 'uint', and a whole one for the length of a list");
    element *last = &head->elements[head->element_count - 1];
    if (last->particles && !made.list)
        find_column(reader, head, name, &made);
    head->properties[head->property_count++] = made;
    last->properties++;
    return true;
}

/* Columns of which a component is missing are not read. */
static bool check_columns(particle_reader *reader, header *head)
{
    uint32_t vertices = 0;
    for (uint32_t i = 0; i < head->element_count; i++)
        vertices += head->elements[i].particles;
    if (vertices != 1)
        return wrong_line(&reader->stream,
                          vertices ? "only one element vertex before it" : "an element vertex before it");
    for (int column = 0; column < COLUMN_COUNT; column++)
        reader->found[column] = head->components[column] == (1u << column_components((particle_column)column)) - 1;
    if (!reader->found[COLUMN_POSITION])
        return wrong_line(&reader->stream, "properties x, y and z of the vertices before it");
    for (uint32_t i = 0; i < head->property_count; i++)
        if (head->properties[i].column != COLUMN_NONE && !reader->found[head->properties[i].column])
            head->properties[i].column = COLUMN_NONE;
    return true;
}

static bool read_header(particle_reader *reader, header *head)
{
    particle_stream *stream = &reader->stream;
    const char *line = stream_line(stream);
    if (!line)
        return false;
    if (strcmp(line, "ply"))
        return wrong_line(stream, "'ply'");
    if (!read_format_line(stream, head))
        return false;
    for (int lines = 0; lines < MAX_HEADER_LINES; lines++) {
        line = stream_line(stream);
        if (!line)
            return false;
        if (!strcmp(line, "end_header"))
            return check_columns(reader, head);
        if (!strncmp(line, "comment", 7) || !strncmp(line, "obj_info", 8))
            continue;
        const bool ok =
            !strncmp(line, "element", 7) ? read_element(stream, head, line) : read_property(reader, head, line);
        if (!ok)
            return false;
    }
    return stream_fail(stream, "a header of more than %d lines, expected 'end_header'", MAX_HEADER_LINES);
}

/* ---- values */

static bool read_value(particle_stream *stream, const header *head, particle_scalar type, double *value)
{
    if (head->ascii)
        return stream_number(stream, value);
    const uint8_t *bytes = stream_take(stream, scalar_size(type));
    if (bytes)
        *value = scalar_value(bytes, type, head->big_endian);
    return bytes;
}

static bool skip_list(particle_stream *stream, const header *head, const property *list)
{
    double length;
    if (!read_value(stream, head, list->length, &length))
        return false;
    if (!(length >= 0 && length <= 4294967295.0) || length != (double)(uint64_t)length)
        return stream_fail(stream, "a list of %g values, expected 0 or more", length);
    return head->ascii ? stream_skip_words(stream, (uint64_t)length)
                       : stream_skip(stream, (uint64_t)length, scalar_size(list->type));
}

static bool read_row(particle_reader *reader, const header *head, const element *from, uint64_t row)
{
    for (uint32_t i = 0; i < from->properties; i++) {
        const property *next = &head->properties[from->first + i];
        double value;
        if (next->list ? !skip_list(&reader->stream, head, next)
                       : !read_value(&reader->stream, head, next->type, &value))
            return false;
        if (!next->list && next->column != COLUMN_NONE &&
            !reader_put(reader, next->column, (uint32_t)row, next->component, value))
            return false;
    }
    return true;
}

/* Elements before the vertices. Where no property is a list, all rows are passed at once. */
static bool skip_element(particle_reader *reader, const header *head, const element *from)
{
    uint64_t bytes = 0;
    bool lists = false;
    for (uint32_t i = 0; i < from->properties; i++) {
        bytes += scalar_size(head->properties[from->first + i].type);
        lists = lists || head->properties[from->first + i].list;
    }
    if (!from->properties)
        return true;
    if (!head->ascii && !lists)
        return stream_skip(&reader->stream, from->count, bytes);
    for (uint64_t row = 0; row < from->count; row++)
        if (!read_row(reader, head, from, row))
            return false;
    return true;
}

static bool read_elements(particle_reader *reader, const header *head)
{
    for (uint32_t i = 0; i < head->element_count; i++) {
        const element *next = &head->elements[i];
        if (!next->particles) {
            if (!skip_element(reader, head, next))
                return false;
            continue;
        }
        if (!reader_set_count(reader, next->count))
            return false;
        for (uint64_t row = 0; row < next->count; row++)
            if (!read_row(reader, head, next, row))
                return false;
        return true; /* what comes behind is not needed */
    }
    return false;
}

bool read_ply(particle_reader *reader)
{
    header *head = calloc(1, sizeof *head);
    reader->stream.text = true;
    if (!head)
        return stream_fail(&reader->stream, "no memory");
    bool ok = read_header(reader, head);
    if (ok) {
        reader->stream.text = head->ascii;
        ok = read_elements(reader, head);
    }
    free(head);
    return ok;
}
