/* field.h - the density of water around particles, at the points of a sparse grid. */
#ifndef VIRGA_EFFECTS_WATER_FIELD_H
#define VIRGA_EFFECTS_WATER_FIELD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <virga/shared/particle.h>

#define FIELD_SIDE   8                                      /* points of a block along each axis */
#define FIELD_POINTS (FIELD_SIDE * FIELD_SIDE * FIELD_SIDE) /* of a block */

typedef struct field_point {
    float density;     /* 1 is inside the water */
    float momentum[3]; /* density times velocity */
} field_point;

typedef struct field_block {
    int32_t cell[3]; /* its first point, in blocks */
    uint32_t index;  /* in field.blocks */
    field_point points[FIELD_POINTS];
} field_block;

/* Points that are in no block have no density. */
typedef struct field {
    double point_m; /* distance of points; point 0 is at the origin of the particles */
    field_block **blocks;
    uint32_t count, room;
    uint32_t *table; /* a hash table of blocks by cell */
    uint32_t table_mask;
} field;

typedef struct field_def {
    const virga_particle_gpu *particles;
    uint32_t count;
    double spacing_m, volume_m3, kernel_spacings;
} field_def;

/* Adds up the particles, with the kernel and the distance of points of virga_water_step (isotropic). False without
 * memory. Costs 2 us for each particle; 8 KiB for each block, and a spacing is two points. */
bool field_create(field *made, const field_def *def);
void field_destroy(field *made); /* accepts one of zeros */

/* NULL: none. */
field_block *field_find(const field *from, const int32_t cell[3]);

#endif
