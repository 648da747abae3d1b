/* volume_blocks.c - blocks of points are blocks of voxels. */
#include "volume_blocks.h"

#include <string.h>

_Static_assert(FIELD_SIDE == VOLUME_SIDE, "the same blocks");

static void fill(const void *from, uint32_t index, int32_t cell[3], volume_voxel voxels[VOLUME_VOXELS])
{
    const field_block *block = ((const field *)from)->blocks[index];
    memcpy(cell, block->cell, sizeof block->cell);
    for (int i = 0; i < VOLUME_VOXELS; i++) {
        const field_point *point = &block->points[i];
        voxels[i] = (volume_voxel){.density = point->density};
        for (int axis = 0; axis < 3 && point->density > 0; axis++)
            voxels[i].velocity[axis] = point->momentum[axis] / point->density;
    }
}

volume field_volume(const field *from)
{
    return (volume){.voxel_m = from->point_m, .block_count = from->count, .fill = fill, .from = from};
}
