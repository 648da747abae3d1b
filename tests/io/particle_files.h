/* particle_files.h - files of a few particles in every format, as text in memory. Particle i is at (i, i / 2, -1.25),
 * has the velocity (i / 4, -2, 3), the id 1000 - i and the density 990 + i. */
#ifndef VIRGA_TESTS_IO_PARTICLE_FILES_H
#define VIRGA_TESTS_IO_PARTICLE_FILES_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

typedef struct particle_file {
    char *data; /* needs free() */
    size_t size;
} particle_file;

typedef enum particle_file_kind {
    FILE_PLY_ASCII,
    FILE_PLY_LITTLE,
    FILE_PLY_BIG,
    FILE_VTK_FIELD_ASCII,
    FILE_VTK_FIELD_BINARY,
    FILE_VTK_ARRAYS_ASCII,
    FILE_VTK_ARRAYS_BINARY,
    FILE_VTK_5_BINARY,
    FILE_BGEO,
    FILE_BGEO_FULL,
    FILE_KINDS,
} particle_file_kind;

/* A number as text, or as so many bytes; `real` numbers have 4 or 8. */
static inline void put_number(FILE *to, particle_file_kind kind, double value, int size, bool real)
{
    const float single = (float)value;
    uint64_t bits = (uint64_t)(int64_t)value;
    uint32_t half;
    if (kind == FILE_PLY_ASCII || kind == FILE_VTK_FIELD_ASCII || kind == FILE_VTK_ARRAYS_ASCII) {
        fprintf(to, "%.17g ", value);
        return;
    }
    memcpy(&half, &single, sizeof half);
    if (real && size == 4)
        bits = half;
    else if (real)
        memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < size; i++)
        fputc((int)(bits >> 8 * (kind == FILE_PLY_LITTLE ? i : size - 1 - i) & 255), to);
}

/* An element before the vertices, properties of all types among them, and faces behind. */
static inline void put_ply(FILE *to, particle_file_kind kind, uint32_t count)
{
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    fprintf(to,
            "ply\nformat %s 1.0\ncomment by hand\nelement camera 2\nproperty list uchar short path\n"
            "property double f\nelement vertex %u\nproperty uchar red\nproperty double x\nproperty float32 y\n"
            "property short padding\nproperty list ushort int near\nproperty float z\nproperty float vx\n"
            "property double vy\nproperty int8 vz\nproperty int id\nproperty uint16 density\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n",
            names[kind], count);
    for (int i = 0; i < 2; i++) {
        put_number(to, kind, 3, 1, false);
        for (int k = 0; k < 3; k++)
            put_number(to, kind, k, 2, false);
        put_number(to, kind, 0.5, 8, true);
        fputs(kind == FILE_PLY_ASCII ? "\n" : "", to);
    }
    for (uint32_t i = 0; i < count; i++) {
        put_number(to, kind, 200, 1, false);
        put_number(to, kind, i, 8, true);
        put_number(to, kind, 0.5 * i, 4, true);
        put_number(to, kind, -7, 2, false);
        put_number(to, kind, i % 3, 2, false);
        for (uint32_t k = 0; k < i % 3; k++)
            put_number(to, kind, k, 4, false);
        put_number(to, kind, -1.25, 4, true);
        put_number(to, kind, 0.25 * i, 4, true);
        put_number(to, kind, -2, 8, true);
        put_number(to, kind, 3, 1, false);
        put_number(to, kind, 1000.0 - i, 4, false);
        put_number(to, kind, 990.0 + i, 2, false);
        fputs(kind == FILE_PLY_ASCII ? "\n" : "", to);
    }
}

static inline void put_rows(FILE *to, particle_file_kind kind, uint32_t count, const double (*rows)[3], int components,
                            int size, bool real)
{
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < components; k++)
            put_number(to, kind, rows[i][k], size, real);
    fputs("\n", to);
}

static inline void put_vtk_arrays(FILE *to, particle_file_kind kind, uint32_t count, const double (*velocity)[3],
                                  const double (*density)[3], const double (*id)[3])
{
    if (kind == FILE_VTK_ARRAYS_ASCII || kind == FILE_VTK_ARRAYS_BINARY) {
        fputs("SCALARS density double 1\nLOOKUP_TABLE default\n", to);
        put_rows(to, kind, count, density, 1, 8, true);
        fputs("VECTORS velocity double\n", to);
        put_rows(to, kind, count, velocity, 3, 8, true);
        fputs("NORMALS bent float\n", to);
        put_rows(to, kind, count, velocity, 3, 4, true);
        fputs("SCALARS id int\nLOOKUP_TABLE default\n", to);
        put_rows(to, kind, count, id, 1, 4, false);
        return;
    }
    fprintf(to, "FIELD FieldData 4\nvelocity 3 %u float\n", count);
    put_rows(to, kind, count, velocity, 3, 4, true);
    fputs("METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n\n", to);
    fprintf(to, "pressure 2 %u double\n", count);
    put_rows(to, kind, count, velocity, 2, 8, true);
    fprintf(to, "density 1 %u float\n", count);
    put_rows(to, kind, count, density, 1, 4, true);
    fprintf(to, "id 1 %u unsigned_int\n", count);
    put_rows(to, kind, count, id, 1, 4, false);
}

static inline void put_vtk(FILE *to, particle_file_kind kind, uint32_t count)
{
    double(*rows)[3] = calloc(4 * (size_t)count + 1, sizeof *rows);
    double(*velocity)[3] = rows + count, (*density)[3] = velocity + count, (*id)[3] = density + count;
    const bool ascii = kind == FILE_VTK_FIELD_ASCII || kind == FILE_VTK_ARRAYS_ASCII, grid = kind != FILE_VTK_5_BINARY;
    for (uint32_t i = 0; i < count; i++) {
        memcpy(rows[i], (double[3]){i, 0.5 * i, -1.25}, sizeof *rows);
        memcpy(velocity[i], (double[3]){0.25 * i, -2, 3}, sizeof *rows);
        density[i][0] = 990 + i;
        id[i][0] = 1000.0 - i;
    }
    fprintf(to, "# vtk DataFile Version %s\n\n%s\nDATASET %s\nPOINTS %u float\n", grid ? "3.0" : "5.1",
            ascii ? "ASCII" : "BINARY", grid ? "UNSTRUCTURED_GRID" : "POLYDATA", count);
    put_rows(to, kind, count, rows, 3, 4, true);
    if (grid) {
        fprintf(to, "CELLS 1 %u\n", count + 1);
        put_number(to, kind, count, 4, false);
        put_rows(to, kind, count, rows, 1, 4, false);
        fputs("CELL_TYPES 1\n", to);
        put_number(to, kind, 2, 4, false);
    } else {
        fprintf(to, "VERTICES 2 %u\nOFFSETS vtktypeint64\n", count);
        put_number(to, kind, 0, 8, false);
        put_number(to, kind, count, 8, false);
        fputs("\nCONNECTIVITY vtktypeint64\n", to);
        put_rows(to, kind, count, rows, 1, 8, false);
    }
    fprintf(to, "\nCELL_DATA 1\nSCALARS density float\nLOOKUP_TABLE default\n");
    put_number(to, kind, 5, 4, true);
    fprintf(to, "\nPOINT_DATA %u\n", count);
    put_vtk_arrays(to, kind, count, velocity, density, id);
    free(rows);
}

static inline void put_bgeo_header(FILE *to, const double numbers[9])
{
    fputs("BgeoV", to);
    for (int i = 0; i < 9; i++)
        put_number(to, FILE_BGEO, numbers[i], 4, false);
}

static inline void put_bgeo_attribute(FILE *to, const char *name, int components, int type)
{
    put_number(to, FILE_BGEO, (double)strlen(name), 2, false);
    fputs(name, to);
    put_number(to, FILE_BGEO, components, 2, false);
    put_number(to, FILE_BGEO, type, 4, false);
    if (type == 4) { /* an indexed text, of two texts */
        put_number(to, FILE_BGEO, 2, 4, false);
        for (int i = 0; i < 2; i++) {
            put_number(to, FILE_BGEO, 5, 2, false);
            fputs("water", to);
        }
    } else {
        for (int i = 0; i < components; i++)
            put_number(to, FILE_BGEO, 0, 4, true);
    }
}

/* What Houdini writes behind the points: attributes of vertices and of primitives, the primitives (a polygon, and all
 * points as a particle system), attributes of the whole, groups of points and of primitives, and "extra" that is empty.
 * Indices of less than 65536 points have 16 bits. */
static inline void put_bgeo_rest(FILE *to, uint32_t count)
{
    enum { POLYGON = 1, PARTICLES = 0x8000 };
    put_bgeo_attribute(to, "uv", 3, 0);
    put_bgeo_attribute(to, "generator", 1, 4);
    for (int primitive = 0; primitive < 2; primitive++) {
        const uint32_t vertices = primitive ? count : count < 3 ? count : 3;
        put_number(to, FILE_BGEO, primitive ? PARTICLES : POLYGON, 4, false);
        put_number(to, FILE_BGEO, vertices, 4, false);
        fputs(primitive ? "" : "<", to); /* closed */
        for (uint32_t i = 0; i < vertices; i++) {
            put_number(to, FILE_BGEO, i, 2, false);
            for (int k = 0; k < 3; k++)
                put_number(to, FILE_BGEO, 0.25 * k, 4, true);
        }
        put_number(to, FILE_BGEO, primitive, 4, false);
    }
    put_bgeo_attribute(to, "time", 1, 0);
    put_number(to, FILE_BGEO, 1.5, 4, true);
    for (int group = 0; group < 2; group++) {
        put_number(to, FILE_BGEO, 4, 2, false);
        fputs(group ? "mesh" : "drop", to);
        put_number(to, FILE_BGEO, group ? 1 : 0, 4, false); /* ordered or not */
        put_number(to, FILE_BGEO, group ? 2 : count, 4, false);
        for (uint32_t i = 0; i < (group ? 2 : count + 31) / 32 + 1; i++)
            put_number(to, FILE_BGEO, 0x55555555, 4, false);
    }
}

static inline void put_bgeo(FILE *to, particle_file_kind kind, uint32_t count)
{
    const bool full = kind == FILE_BGEO_FULL;
    const double plain[] = {5, count, 0, 0, 0, 4, 0, 0, 0}, all[] = {5, count, 2, 1, 1, 5, 1, 1, 1};
    put_bgeo_header(to, full ? all : plain);
    if (full)
        put_bgeo_attribute(to, "Cd", 3, 0);
    put_bgeo_attribute(to, "id", 1, 1);
    put_bgeo_attribute(to, "group", 1, 4);
    put_bgeo_attribute(to, "v", 3, 5);
    put_bgeo_attribute(to, "density", 1, 0);
    for (uint32_t i = 0; i < count; i++) {
        const double row[] = {i, 0.5 * i, -1.25, 1, 1000.0 - i, 0, 0.25 * i, -2, 3, 990.0 + i};
        for (int k = 0; k < 10; k++) {
            for (int color = 0; full && k == 4 && color < 3; color++)
                put_number(to, FILE_BGEO, 0.5, 4, true);
            put_number(to, FILE_BGEO, row[k], 4, k != 4 && k != 5);
        }
    }
    if (full)
        put_bgeo_rest(to, count);
    put_number(to, FILE_BGEO, 0x00ff, 2, false);
}

static inline particle_file make_particle_file(particle_file_kind kind, uint32_t count)
{
    particle_file file = {0};
    FILE *to = open_memstream(&file.data, &file.size);
    if (kind <= FILE_PLY_BIG)
        put_ply(to, kind, count);
    else if (kind >= FILE_BGEO)
        put_bgeo(to, kind, count);
    else
        put_vtk(to, kind, count);
    fclose(to);
    return file;
}

static inline particle_file gzip_particle_file(const particle_file *plain)
{
    z_stream zip = {0};
    particle_file packed = {.data = malloc(plain->size + 1000), .size = plain->size + 1000};
    deflateInit2(&zip, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    zip.next_in = (Bytef *)plain->data;
    zip.avail_in = (uInt)plain->size;
    zip.next_out = (Bytef *)packed.data;
    zip.avail_out = (uInt)packed.size;
    deflate(&zip, Z_FINISH);
    packed.size = zip.total_out;
    deflateEnd(&zip);
    return packed;
}

#endif
