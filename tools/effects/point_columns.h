/* point_columns.h - defines the columns that all point caches have first. */
#ifndef VIRGA_EFFECTS_POINT_COLUMNS_H
#define VIRGA_EFFECTS_POINT_COLUMNS_H

#include "ply.h"

/* The first members of the struct of a row. */
#define POINT_MEMBERS                         \
    float position[3], velocity[3], radius_m; \
    uint32_t id;                              \
    float age_s

/* The PLY columns of these members. */
#define POINT_COLUMN(type, member, index) (offsetof(type, member) + 4 * (index))
/* clang-format off */
#define POINT_COLUMNS(type)                                  \
    {"x", PLY_FLOAT, POINT_COLUMN(type, position, 0)},       \
    {"y", PLY_FLOAT, POINT_COLUMN(type, position, 1)},       \
    {"z", PLY_FLOAT, POINT_COLUMN(type, position, 2)},       \
    {"vx", PLY_FLOAT, POINT_COLUMN(type, velocity, 0)},      \
    {"vy", PLY_FLOAT, POINT_COLUMN(type, velocity, 1)},      \
    {"vz", PLY_FLOAT, POINT_COLUMN(type, velocity, 2)},      \
    {"radius", PLY_FLOAT, POINT_COLUMN(type, radius_m, 0)},  \
    {"id", PLY_UINT, POINT_COLUMN(type, id, 0)},             \
    {"age", PLY_FLOAT, POINT_COLUMN(type, age_s, 0)}
/* clang-format on */

/* A column of a further member. */
#define POINT_UINT(type, member)                  \
    {                                             \
#member, PLY_UINT, offsetof(type, member) \
    }
#define POINT_FLOAT(type, member)                  \
    {                                              \
#member, PLY_FLOAT, offsetof(type, member) \
    }

/* The fields of tool_points that all point caches have: a table of columns, the struct of a row, and two functions. */
#define TOOL_POINTS(columns, row, record_function, read_function)                                       \
    .properties = columns, .property_count = sizeof columns / sizeof columns[0], .stride = sizeof(row), \
    .record = record_function, .read = read_function

#endif
