/* ply.h - point caches and triangle meshes: binary little-endian PLY. */
#ifndef VIRGA_IO_PLY_H
#define VIRGA_IO_PLY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PLY_MAX_PROPERTIES 64
#define PLY_MAX_NAME       31 /* bytes */

typedef enum ply_type { PLY_FLOAT, PLY_UINT } ply_type; /* 4 bytes each */

typedef struct ply_property {
    const char *name; /* "x", "vx", "id"; letters, digits and underscores */
    ply_type type;
    size_t offset; /* bytes into a row */
} ply_property;

/* Writes `count` rows that are `stride` bytes apart, under a temporary name, and renames the file. `comments` (may be
 * NULL) ends with NULL; each is one line of the header. A file without rows is valid. */
bool ply_write(const char *path, const ply_property *properties, uint32_t property_count, const void *rows,
               size_t stride, uint64_t count, const char *const *comments, char *error, size_t error_size);

/* The same with an element `face`: triangles, as lists `vertex_indices`. */
bool ply_write_mesh(const char *path, const ply_property *properties, uint32_t property_count, const void *rows,
                    size_t stride, uint64_t count, const uint32_t (*triangles)[3], uint64_t triangle_count,
                    const char *const *comments, char *error, size_t error_size);

/* A file in memory: property p of row r is value[r * property_count + p]. */
typedef struct ply_points {
    uint64_t count;
    uint32_t property_count;
    struct {
        char name[PLY_MAX_NAME + 1];
        ply_type type;
    } properties[PLY_MAX_PROPERTIES];
    union ply_value {
        float real;
        uint32_t whole;
    } * values;
} ply_points;

/* Reads binary little-endian files whose first element is vertex, with float and uint (float32, uint32) properties.
 * Other elements are ignored. */
bool ply_read(const char *path, ply_points *points, char *error, size_t error_size);

/* Index of a property; -1 if there is none. */
int ply_find(const ply_points *points, const char *name);

/* Frees the result of ply_read. Accepts points that are all zero. */
void ply_free(ply_points *points);

#endif
