/* particles.c - formats by their first bytes, and the columns of particles. */
#include "particles.h"

#include "particle_reader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- numbers */

size_t scalar_size(particle_scalar type)
{
    static const uint8_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[type];
}

bool scalar_is_real(particle_scalar type)
{
    return type == SCALAR_F32 || type == SCALAR_F64;
}

double scalar_value(const uint8_t *bytes, particle_scalar type, bool big_endian)
{
    const size_t size = scalar_size(type);
    uint64_t bits = 0;
    uint32_t half;
    float single;
    double real;
    for (size_t i = 0; i < size; i++)
        bits |= (uint64_t)bytes[big_endian ? size - 1 - i : i] << 8 * i;
    switch (type) {
    case SCALAR_I8: return (int8_t)bits;
    case SCALAR_I16: return (int16_t)bits;
    case SCALAR_I32: return (int32_t)bits;
    case SCALAR_I64: return (double)(int64_t)bits;
    case SCALAR_F32:
        half = (uint32_t)bits;
        memcpy(&single, &half, sizeof single);
        return (double)single;
    case SCALAR_F64: memcpy(&real, &bits, sizeof real); return real;
    default: return (double)bits;
    }
}

/* ---- names */

static bool is_one_of(const char *name, const char *const *names)
{
    for (; *names; names++)
        if (!strcasecmp(name, *names))
            return true;
    return false;
}

uint32_t column_components(particle_column column)
{
    return column == COLUMN_POSITION || column == COLUMN_VELOCITY ? 3 : 1;
}

particle_column reader_column(const particle_reader *reader, const char *name, uint64_t components)
{
    static const char *const velocity[] = {"velocity", "velocities", "vel", "v", NULL};
    static const char *const id[] = {"id", "ids", "pid", "particle_id", "particleid", "global_ids", NULL};
    static const char *const density[] = {"density", "densities", "dens", "rho", NULL};
    const particle_column column = is_one_of(name, velocity)  ? COLUMN_VELOCITY
                                   : is_one_of(name, id)      ? COLUMN_ID
                                   : is_one_of(name, density) ? COLUMN_DENSITY
                                                              : COLUMN_NONE;
    if (column == COLUMN_NONE || reader->found[column] || components != column_components(column))
        return COLUMN_NONE;
    return column;
}

int velocity_component(const char *name)
{
    static const char *const stems[] = {"velocity", "vel", "v"};
    for (size_t i = 0; i < sizeof stems / sizeof *stems; i++) {
        const size_t length = strlen(stems[i]);
        if (strncasecmp(name, stems[i], length))
            continue;
        const char *rest = name + length;
        rest += *rest == '_' || *rest == '.' || *rest == '[' || *rest == ':';
        const char *found = *rest ? strchr("xyzXYZ012", *rest) : NULL;
        if (found && (!rest[1] || !strcmp(rest + 1, "]")))
            return (int)((found - "xyzXYZ012") % 3);
    }
    return -1;
}

/* ---- columns */

bool reader_set_count(particle_reader *reader, uint64_t count)
{
    if (count > PARTICLES_MAX)
        return stream_fail(&reader->stream, "%llu particles, expected at most %d", (unsigned long long)count,
                           PARTICLES_MAX);
    reader->out->count = (uint32_t)count;
    return true;
}

static void **column_of(particles *out, particle_column column)
{
    void **const columns[COLUMN_COUNT] = {(void **)&out->position, (void **)&out->velocity, (void **)&out->id,
                                          (void **)&out->density};
    return columns[column];
}

static bool reserve(particle_reader *reader, particle_column column, uint32_t rows)
{
    uint32_t room = reader->room[column] ? 2 * reader->room[column] : 4096;
    room = room < rows ? rows : room;
    room = room > reader->out->count ? reader->out->count : room;
    void **values = column_of(reader->out, column);
    void *grown = realloc(*values, ((size_t)room + !room) * column_components(column) * sizeof(float));
    if (!grown)
        return stream_fail(&reader->stream, "no memory for %u particles", room);
    *values = grown;
    reader->room[column] = room;
    return true;
}

static bool put_id(particle_reader *reader, uint32_t row, double value)
{
    if (!(value >= -2147483648.0 && value <= 4294967295.0) || value != (double)(int64_t)value)
        return stream_fail(&reader->stream, "id %g of particle %u, expected a whole number of 32 bits", value, row);
    reader->out->id[row] = (uint32_t)(int64_t)value;
    return true;
}

bool reader_put(particle_reader *reader, particle_column column, uint32_t row, uint32_t component, double value)
{
    particles *out = reader->out;
    if (row >= reader->room[column] && !reserve(reader, column, row + 1))
        return false;
    switch (column) {
    case COLUMN_POSITION: out->position[row][component] = (float)value; return true;
    case COLUMN_VELOCITY: out->velocity[row][component] = (float)value; return true;
    case COLUMN_ID: return put_id(reader, row, value);
    case COLUMN_DENSITY: out->density[row] = (float)value; return true;
    default: return true;
    }
}

/* ---- files */

typedef struct format {
    const char *name, *magic;
    bool (*read)(particle_reader *reader);
} format;

static const format formats[] = {
    {"PLY", "ply", read_ply},
    {"VTK", "# vtk DataFile", read_vtk},
    {"bgeo", "BgeoV", read_bgeo},
    /* Files that people will try. */
    {"a file of Houdini 12 or later; expected the classic format, version 5 (.bhclassic)", "\177NSJb", NULL},
    {"compressed by blosc (.sc); expected gzip, or none", "scf1", NULL},
    {"VTK's XML; expected a legacy file, PLY or bgeo", "<?xml", NULL},
    {"VTK's XML; expected a legacy file, PLY or bgeo", "<VTKFile", NULL},
};

static const format *find_format(particle_stream *stream)
{
    size_t size;
    const uint8_t *first = stream_peek(stream, &size);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        const size_t length = strlen(formats[i].magic);
        if (size >= length && !memcmp(first, formats[i].magic, length))
            return &formats[i];
    }
    return NULL;
}

static bool read_format(particle_reader *reader)
{
    const format *found = find_format(&reader->stream);
    reader->stream.byte = 0;
    if (!found)
        return stream_fail(&reader->stream, "not a file of particles; expected PLY, legacy VTK or bgeo");
    if (!found->read)
        return stream_fail(&reader->stream, "%s", found->name);
    if (!found->read(reader))
        return false;
    for (int column = 0; column < COLUMN_COUNT; column++)
        if (reader->found[column] && !*column_of(reader->out, (particle_column)column) &&
            !reserve(reader, (particle_column)column, 0))
            return false;
    return true;
}

bool particles_read(const char *path, particles *out, char *error, size_t error_size)
{
    *out = (particles){0};
    particle_reader *reader = calloc(1, sizeof *reader);
    if (!reader || !stream_open(&reader->stream, path, error, error_size)) {
        if (!reader && error && error_size)
            snprintf(error, error_size, "cannot read %s: no memory", path);
        free(reader);
        return false;
    }
    reader->out = out;
    const bool ok = read_format(reader) && !reader->stream.failed;
    stream_close(&reader->stream);
    free(reader);
    if (!ok)
        particles_free(out);
    return ok;
}

void particles_free(particles *out)
{
    free(out->position);
    free(out->velocity);
    free(out->id);
    free(out->density);
    *out = (particles){0};
}

const char *particles_format(const char *path)
{
    const char *name = NULL;
    particle_stream *stream = malloc(sizeof *stream);
    if (stream && stream_open(stream, path, NULL, 0)) {
        const format *found = find_format(stream);
        name = found && found->read ? found->name : NULL;
        stream_close(stream);
    }
    free(stream);
    return name;
}
