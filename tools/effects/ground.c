/* ground.c - what the program knows of the ground. */
#include "ground.h"

#include "effect.h"
#include "scene_rows.h"

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

static const cyaml_schema_field_t ground_rule_fields[] = {
    TEXT(scene_ground_rule, match, 200),
    OPTIONAL_TEXT(scene_ground_rule, material, 40),
    SWITCH(scene_ground_rule, walkable),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t ground_rule = {CYAML_VALUE_MAPPING(D, scene_ground_rule, ground_rule_fields)};

static const cyaml_schema_value_t material_name = {CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char, 1, 40)};
static const cyaml_schema_field_t material_map_fields[] = {
    TEXT(scene_material_map, file, FILE_LENGTH),
    PAIR(scene_material_map, low_m),
    PAIR(scene_material_map, high_m),
    LIST("materials", scene_material_map, materials, material_count, &material_name, 1, SCENE_FILE_MAX_MATERIALS),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t ground_fields[] = {
    SWITCH(scene_ground, on),
    WHOLE(scene_ground, cells),
    NUMBER(scene_ground, cell_m),
    WHOLE(scene_ground, kept_tiles),
    WHOLE(scene_ground, far_cells),
    NUMBER(scene_ground, evaporation_mm_h),
    NUMBER(scene_ground, start_wetness),
    NUMBER(scene_ground, start_water_mm),
    LIST("materials", scene_ground, materials, material_count, &ground_rule, 0, 256),
    OPTIONAL_GROUP(scene_ground, material_map, material_map_fields),
    CYAML_FIELD_END,
};

/* Ranges and defaults are the library's own: virga/ground.h. */
static const scene_rule ground_rules[] = {
    {"ground", 0, 0, "{}", RESTARTS, "ground that gets wet"},
    {"ground.on", 0, 0, "false", RESTARTS, "there is ground that gets wet"},
    {"ground.cells", 128, 4096, "1024", RESTARTS,
     "cells along the side of the window around the camera, a power of two; 44 bytes each"},
    {"ground.cell_m", 0.01, 0.1, "0.05", RESTARTS, "side of a cell"},
    {"ground.kept_tiles", 0, 65536, "1024", RESTARTS,
     "tiles of 64 x 64 cells that are kept when they leave the window"},
    {"ground.far_cells", 0, 2048, "512", RESTARTS,
     "cells along the side of the map of wet ground beyond the window, eight times as wide; 0: none"},
    {"ground.evaporation_mm_h", 0, 100, "0.2", LIVE,
     "water that dries off: 0.1 in rain, 0.5 on a mild day, 5 in sun and wind"},
    {"ground.start_wetness", 0, 1, "0", RESTARTS, "share of their pores that was full before the first frame"},
    {"ground.start_water_mm", 0, 50, "0", RESTARTS,
     "rain of that depth has gathered in hollows before the first frame"},
    {"ground.materials", 0, 0, "[]", RESTARTS, "rules: which names of meshes or their materials are of what"},
    {"ground.materials[].match", 0, 0, NULL, RESTARTS, "in the name of a mesh or its material, in any case"},
    {"ground.materials[].material", 0, 0, NULL, RESTARTS, "as asphalt, concrete, stone, ..."},
    {"ground.materials[].walkable", 0, 0, "true", RESTARTS, "false: no cells on it"},
    {"ground.material_map", 0, 0, NULL, RESTARTS, "a picture of materials, over those of meshes"},
    {"ground.material_map.file", 0, 0, NULL, RESTARTS | NAMES_FILE, "a PNG whose pixels are numbers of materials"},
    {"ground.material_map.low_m", -MAX_METERS, MAX_METERS, NULL, RESTARTS, "x and z of its first pixel"},
    {"ground.material_map.high_m", -MAX_METERS, MAX_METERS, NULL, RESTARTS, "x and z of its last pixel"},
    {"ground.material_map.materials", 0, 0, NULL, RESTARTS, "by number"},
};

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

const tool_effect ground_effect = {
    .name = "ground",
    .scene =
        {
            .field = GROUP_SECTION("ground", scene_ground, ground_fields),
            .size = sizeof(scene_ground),
            .rules = ground_rules,
            .rule_count = CYAML_ARRAY_LEN(ground_rules),
            .check = check_material_map,
        },
};

scene_ground *scene_ground_of(const scene_file *scene)
{
    return scene_file_section(scene, &ground_effect.scene);
}
