/* ground.h - the ground of a scene file, which gets wet. */
#ifndef VIRGA_EFFECTS_GROUND_H
#define VIRGA_EFFECTS_GROUND_H

#include "scene_file.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCENE_FILE_MAX_MATERIALS 255 /* of a material map, whose pixels are bytes; 255 is none of them */

typedef struct scene_ground_rule {
    char *match;    /* in the name of a mesh or its material, in any case */
    char *material; /* as asphalt, concrete, ... */
    bool walkable;  /* false: no cells on it */
} scene_ground_rule;

/* A picture of materials, over those of meshes. */
typedef struct scene_material_map {
    char *file;                 /* a PNG of numbers (see png_read_numbers), as it can be opened; NULL: no map */
    double low_m[2], high_m[2]; /* corners in x and z: its first pixel lies at low_m, its rows go along x */
    char **materials;           /* by number; pixels of others leave the mesh's material */
    uint32_t material_count;
} scene_material_map;

typedef struct scene_ground {
    bool on;
    uint32_t cells;
    double cell_m;
    uint32_t cached_tiles;
    uint32_t far_cells;
    double evaporation_mm_h;
    double start_wetness, start_water_mm;
    scene_ground_rule *materials; /* the first that matches counts; none: words in names decide */
    uint32_t material_count;
    scene_material_map material_map;
} scene_ground;

/* The ground of a scene. */
scene_ground *scene_ground_of(const scene_file *scene);

#ifdef __cplusplus
}
#endif
#endif
