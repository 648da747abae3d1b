/* volume.h - the density of water in blocks of voxels, as an OpenVDB file. */
#ifndef VIRGA_IO_VOLUME_H
#define VIRGA_IO_VOLUME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define VOLUME_SIDE   8                                         /* voxels of a block along each axis */
#define VOLUME_VOXELS (VOLUME_SIDE * VOLUME_SIDE * VOLUME_SIDE) /* of a block; x is fastest, then y */

typedef struct volume_voxel {
    float density;     /* 1 is inside the water; 0: the voxel is not part of the file */
    float velocity[3]; /* m/s */
} volume_voxel;

typedef struct volume {
    double voxel_m;
    double origin_m[3]; /* where the middle of voxel (0, 0, 0) is */
    double surface;     /* density of the surface */
    uint32_t block_count;
    /* Fills a block and says where it is: its first voxel is VOLUME_SIDE * cell. */
    void (*fill)(const void *from, uint32_t block, int32_t cell[3], volume_voxel voxels[VOLUME_VOXELS]);
    const void *from;
} volume;

/* Whether the program was built with OpenVDB. */
bool volume_is_there(void);

/* Writes the grids "density" (a fog volume) and "velocity" under a temporary name, and renames the file. The same
 * volume gives the same bytes. A volume without blocks is valid. Needs up to 40 bytes of memory for each voxel. */
bool volume_write(const char *path, const volume *v, char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
