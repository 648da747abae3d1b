/* plate_ground.h - the ground that a plate shows: rain lands on it, and it gets wet. */
#ifndef VIRGA_TOOL_PLATE_GROUND_H
#define VIRGA_TOOL_PLATE_GROUND_H

#include "shot/plate_files.h"
#include "shot/shot.h"

typedef struct plate_ground {
    plate_files masks;
    bool has_masks;
    float *picture; /* share of each pixel that is ground: of the plate's picture, */
    float *share;   /* and as the pinhole sees it; the same memory where the lens bends nothing */
    uint32_t loaded;
    uint64_t hash; /* of the ground's mesh, which the simulation depends on */
    uint32_t look; /* (drawing) index of the shot's mesh that is drawn wet */
} plate_ground;

/* After the plate is open. Does nothing where the scene has no footage.ground. Whose fault an error is:
 * s->input_wrong. */
bool plate_ground_open(shot *s, char *error, size_t error_size);
void plate_ground_close(plate_ground *ground); /* accepts one that is all zero */

/* How many meshes it needs, and adds them to the shot's and to its renderer. */
uint32_t plate_ground_meshes(const shot *s);
bool plate_ground_load_meshes(shot *s, char *error, size_t error_size);

/* The mask of a frame, into the plate's depth (footage.ground: plane) and the texture of the mesh. The device is idle,
 * and the plate of that frame is loaded. */
bool plate_ground_load(shot *s, uint32_t frame, char *error, size_t error_size);

#endif
