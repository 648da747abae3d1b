/* particle_reader.h - what the readers of all formats share: types, columns and their names. Internal to particles. */
#ifndef VIRGA_IO_PARTICLE_READER_H
#define VIRGA_IO_PARTICLE_READER_H

#include "particle_stream.h"
#include "particles.h"

/* Types of numbers in files. */
typedef enum particle_scalar {
    SCALAR_I8,
    SCALAR_U8,
    SCALAR_I16,
    SCALAR_U16,
    SCALAR_I32,
    SCALAR_U32,
    SCALAR_I64,
    SCALAR_U64,
    SCALAR_F32,
    SCALAR_F64,
} particle_scalar;

typedef enum particle_column {
    COLUMN_POSITION,
    COLUMN_VELOCITY,
    COLUMN_ID,
    COLUMN_DENSITY,
    COLUMN_COUNT,
    COLUMN_NONE = COLUMN_COUNT, /* not a column of particles: skipped */
} particle_column;

typedef struct particle_reader {
    particle_stream stream;
    particles *out;              /* out->count: rows that the file says it has */
    uint32_t room[COLUMN_COUNT]; /* rows that a column has memory for; it grows with the rows that are there */
    bool found[COLUMN_COUNT];    /* the file has the column */
} particle_reader;

size_t scalar_size(particle_scalar type);
bool scalar_is_real(particle_scalar type);
double scalar_value(const uint8_t *bytes, particle_scalar type, bool big_endian);

/* The column that a name and a number of components mean; COLUMN_NONE for others, and for a column that was found
 * already. */
particle_column reader_column(const particle_reader *reader, const char *name, uint64_t components);

/* The velocity's component that a name without vectors means ("vx", "vel_y", "velocity2"): 0 to 2; -1: none. */
int velocity_component(const char *name);

uint32_t column_components(particle_column column);

/* Sets out->count, and refuses more than PARTICLES_MAX. */
bool reader_set_count(particle_reader *reader, uint64_t count);

/* A number of a row. Rows come in order. */
bool reader_put(particle_reader *reader, particle_column column, uint32_t row, uint32_t component, double value);

/* One reader for each format. They begin at the first byte. */
bool read_ply(particle_reader *reader);
bool read_vtk(particle_reader *reader);
bool read_bgeo(particle_reader *reader);

#endif
