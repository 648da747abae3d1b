/* ground.h - declares the ground of a scene file. The ground gets wet. */
#ifndef VIRGA_EFFECTS_GROUND_H
#define VIRGA_EFFECTS_GROUND_H

#include "scene_file.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCENE_FILE_MAX_MATERIALS 255 /* per material map: its pixels are bytes, and 255 means no material */

typedef struct scene_ground_rule {
    char *match;    /* part of the name of a mesh or its material, in upper or lower case */
    char *material; /* asphalt, concrete, ... */
    bool walkable;  /* false: it gets no cells */
} scene_ground_rule;

/* An image of materials. It overrides the materials of the meshes. */
typedef struct scene_material_map {
    char *file;                 /* path of a PNG with numbers (see png_read_numbers); NULL: no map */
    double low_m[2], high_m[2]; /* corners (x, z): the first pixel is at low_m, rows are along x */
    char **materials;           /* by number; pixels with other numbers have the mesh's material */
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
    uint32_t contact_droplets;
    double stream_waves;
    double wake_waves;
    bool contact_shade;
    bool meniscus;
    scene_ground_rule *materials; /* the first match applies; without one, keywords in names decide */
    uint32_t material_count;
    scene_material_map material_map;
} scene_ground;

/* The ground of a scene. */
scene_ground *scene_ground_of(const scene_file *scene);

#ifdef __cplusplus
}
#endif
#endif
