/* read_vdb.h - reads a volume by OpenVDB. */
#ifndef VIRGA_TESTS_READ_VDB_H
#define VIRGA_TESTS_READ_VDB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vdb_voxel {
    double position_m[3];
    float density, velocity[3];
} vdb_voxel;

typedef struct vdb_contents {
    vdb_voxel *voxels;        /* the active ones, to be freed by free() */
    size_t count, velocities; /* active voxels of each grid */
    uint32_t grids;
    double voxel_m[3];
    float background, surface;
    char density_class[32], density_unit[32], velocity_unit[32], length_unit[32], creator[32];
} vdb_contents;

/* False: `reason` (of 256 bytes) says why. */
bool read_vdb(const char *path, vdb_contents *to, char *reason);

#ifdef __cplusplus
}
#endif
#endif
