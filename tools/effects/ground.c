/* ground.c - what the program knows of the ground. */
#include "ground.h"

#include "effect.h"
#include "scene_rows.h"

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

/* Ranges and defaults are the library's own: virga/ground.h. */

static const scene_row ground_rule_rows[] = {
    TEXT(scene_ground_rule, match, 200, NULL, RESTARTS, "in the name of a mesh or its material, in any case"),
    OPTIONAL_TEXT(scene_ground_rule, material, 40, RESTARTS, "as asphalt, concrete, stone, ..."),
    SWITCH(scene_ground_rule, walkable, "true", RESTARTS, "false: no cells on it"),
};
static const scene_group ground_rule_group = SCENE_GROUP(scene_ground_rule, ground_rule_rows);

static const scene_row material_map_rows[] = {
    FILE_NAME(scene_material_map, file, 0, "a PNG whose pixels are numbers of materials"),
    NUMBER(scene_material_map, low_m, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "x and z of its first pixel"),
    NUMBER(scene_material_map, high_m, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "x and z of its last pixel"),
    TEXT_LIST(scene_material_map, materials, material_count, 40, 1, SCENE_FILE_MAX_MATERIALS, NULL, "by number"),
};
static const scene_group material_map_group = SCENE_GROUP(scene_material_map, material_map_rows);

static const scene_row ground_rows[] = {
    SWITCH(scene_ground, on, "false", RESTARTS, "there is ground that gets wet"),
    WHOLE(scene_ground, cells, 128, 4096, "1024", RESTARTS,
          "cells along the side of the window around the camera, a power of two; 44 bytes each"),
    NUMBER(scene_ground, cell_m, 0.01, 0.1, "0.05", RESTARTS, "side of a cell"),
    WHOLE(scene_ground, kept_tiles, 0, 65536, "1024", RESTARTS,
          "tiles of 64 x 64 cells that are kept when they leave the window"),
    WHOLE(scene_ground, far_cells, 0, 2048, "512", RESTARTS,
          "cells along the side of the map of wet ground beyond the window, eight times as wide; 0: none"),
    NUMBER(scene_ground, evaporation_mm_h, 0, 100, "0.2", LIVE,
           "water that dries off: 0.1 in rain, 0.5 on a mild day, 5 in sun and wind"),
    NUMBER(scene_ground, start_wetness, 0, 1, "0", RESTARTS,
           "share of their pores that was full before the first frame"),
    NUMBER(scene_ground, start_water_mm, 0, 50, "0", RESTARTS,
           "rain of that depth has gathered in hollows before the first frame"),
    LIST(scene_ground, materials, material_count, &ground_rule_group, 0, 256, "[]",
         "rules: which names of meshes or their materials are of what"),
    OPTIONAL_GROUP(scene_ground, material_map, &material_map_group, RESTARTS,
                   "a picture of materials, over those of meshes"),
};
static const scene_group ground_group = SCENE_GROUP(scene_ground, ground_rows);

/* The section has one key: all of the struct. */
static const scene_row ground_section[] = {SECTION_GROUP("ground", &ground_group, "ground that gets wet")};

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

static bool check_material_map(const scene_file *scene, char *error, size_t error_size)
{
    const scene_material_map *map = &scene_ground_of(scene)->material_map;
    for (int axis = 0; map->file && axis < 2; axis++)
        if (map->high_m[axis] <= map->low_m[axis])
            return scene_file_refuse(scene, "ground.material_map.high_m", error, error_size,
                                     "expected more than low_m in %s (%g), got %g", axis ? "z" : "x", map->low_m[axis],
                                     map->high_m[axis]);
    return true;
}

/* ---- the effect ----------------------------------------------------------------------------------------------- */

scene_ground *scene_ground_of(const scene_file *scene)
{
    return scene_file_section(scene, &ground_effect.scene);
}

const tool_effect ground_effect = {
    .name = "ground",
    .scene = {.group = SCENE_GROUP(scene_ground, ground_section), .check = check_material_map},
};
