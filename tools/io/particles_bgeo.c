/* particles_bgeo.c - the classic binary geometry of Houdini, version 5, which SPlisHSPlasH and Partio write. All
 * numbers are big-endian.
 *
 *     "BgeoV", then 32 bits each: version, points, primitives, point groups, primitive groups, point attributes, vertex
 *     attributes, primitive attributes, attributes of the whole
 *     each point attribute: length of the name (16 bits), name, components (16), type (32), and a default of 4 bytes
 *     for each component; an indexed text has a list of texts in place of the default
 *     each point: x, y, z, w, then the attributes, 4 bytes for each component
 *
 * A length of -1 stands for one of 32 bits behind it. What follows the points is not read: attributes of vertices and
 * of primitives, the primitives, attributes of the whole, and groups.
 * "Documentation on the Public Domain Geometry Library
 * (GPD) - Version 5", which comes with Houdini, has all of it. */
#include "particle_reader.h"

#include <stdlib.h>

enum { MAX_ATTRIBUTES = 1024, MAX_NAME = 255, MAX_ROW = 16384 /* components */ };

enum { TYPE_FLOAT = 0, TYPE_INT = 1, TYPE_TEXT_INDEX = 4, TYPE_VECTOR = 5 };

typedef struct layout {
    uint32_t words; /* of a row */
    struct {
        uint32_t offset; /* in words */
        particle_scalar type;
    } columns[COLUMN_COUNT];
} layout;

static bool read_word(particle_stream *stream, particle_scalar type, uint32_t *value)
{
    const uint8_t *bytes = stream_take(stream, scalar_size(type));
    if (bytes)
        *value = (uint32_t)scalar_value(bytes, type, true);
    return bytes;
}

static bool read_length(particle_stream *stream, uint32_t *length)
{
    return read_word(stream, SCALAR_U16, length) && (*length != 0xffff || read_word(stream, SCALAR_U32, length));
}

static bool read_name(particle_stream *stream, char name[MAX_NAME + 1])
{
    uint32_t length;
    if (!read_length(stream, &length))
        return false;
    if (length > MAX_NAME)
        return stream_fail(stream, "an attribute's name of %u bytes, expected at most %d", length, MAX_NAME);
    const uint8_t *bytes = stream_take(stream, length);
    for (uint32_t i = 0; bytes && i < length; i++)
        name[i] = (char)bytes[i];
    name[length] = 0;
    return bytes;
}

static bool skip_texts(particle_stream *stream)
{
    uint32_t count, length;
    if (!read_word(stream, SCALAR_U32, &count))
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (!read_length(stream, &length) || !stream_skip(stream, length, 1))
            return false;
    return true;
}

static bool read_attribute(particle_reader *reader, layout *rows)
{
    particle_stream *stream = &reader->stream;
    char name[MAX_NAME + 1];
    uint32_t components, type;
    if (!read_name(stream, name) || !read_word(stream, SCALAR_U16, &components) ||
        !read_word(stream, SCALAR_U32, &type))
        return false;
    if (type != TYPE_FLOAT && type != TYPE_INT && type != TYPE_TEXT_INDEX && type != TYPE_VECTOR)
        return stream_fail(stream, "attribute '%.40s' of type %u, expected 0 (float), 1 (int), 4 (index) or 5 (vector)",
                           name, type);
    if (type == TYPE_TEXT_INDEX ? !skip_texts(stream) : !stream_skip(stream, components, 4))
        return false;
    const particle_column column = type == TYPE_TEXT_INDEX ? COLUMN_NONE : reader_column(reader, name, components);
    if (column != COLUMN_NONE) {
        reader->found[column] = true;
        rows->columns[column].offset = rows->words;
        rows->columns[column].type = type == TYPE_INT ? SCALAR_I32 : SCALAR_F32;
    }
    rows->words += components;
    return rows->words <= MAX_ROW || stream_fail(stream, "points of more than %d numbers, expected fewer", MAX_ROW);
}

static bool read_points(particle_reader *reader, const layout *rows)
{
    for (uint32_t row = 0; row < reader->out->count; row++) {
        const uint8_t *bytes = stream_take(&reader->stream, (size_t)rows->words * 4);
        if (!bytes)
            return false;
        for (int column = 0; column < COLUMN_COUNT; column++) {
            const uint8_t *from = bytes + (size_t)rows->columns[column].offset * 4;
            const uint32_t components = reader->found[column] ? column_components((particle_column)column) : 0;
            for (uint32_t i = 0; i < components; i++)
                if (!reader_put(reader, (particle_column)column, row, i,
                                scalar_value(from + (size_t)i * 4, rows->columns[column].type, true)))
                    return false;
        }
    }
    return true;
}

bool read_bgeo(particle_reader *reader)
{
    enum { VERSION, POINTS, PRIMITIVES, POINT_GROUPS, GROUPS, ATTRIBUTES, HEADER = 9 };
    particle_stream *stream = &reader->stream;
    uint32_t header[HEADER];
    layout rows = {.words = 4};
    if (!stream_skip(stream, 5, 1))
        return false;
    for (int i = 0; i < HEADER; i++)
        if (!read_word(stream, SCALAR_U32, &header[i]))
            return false;
    if (header[VERSION] != 5)
        return stream_fail(stream, "bgeo of version %u, expected 5", header[VERSION]);
    if (header[ATTRIBUTES] > MAX_ATTRIBUTES)
        return stream_fail(stream, "%u attributes, expected at most %d", header[ATTRIBUTES], MAX_ATTRIBUTES);
    if (!reader_set_count(reader, header[POINTS]))
        return false;
    reader->found[COLUMN_POSITION] = true;
    rows.columns[COLUMN_POSITION].type = SCALAR_F32;
    for (uint32_t i = 0; i < header[ATTRIBUTES]; i++)
        if (!read_attribute(reader, &rows))
            return false;
    return read_points(reader, &rows);
}
