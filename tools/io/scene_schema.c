/* scene_schema.c - what every scene file may hold, and how the sections of effects are joined to it. */
#include "scene_schema.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene_rows.h"

#define SECTION_ALIGNMENT 16

/* ---- structure ------------------------------------------------------------------------------------------------ */

static const cyaml_schema_field_t mesh_fields[] = {
    TEXT(scene_mesh, file, FILE_LENGTH),
    VECTOR(scene_mesh, position_m),
    VECTOR(scene_mesh, rotation_deg),
    NUMBER(scene_mesh, scale),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t mesh = {CYAML_VALUE_MAPPING(D, scene_mesh, mesh_fields)};

static const cyaml_schema_field_t environment_fields[] = {
    OPTIONAL_TEXT(scene_environment, file, FILE_LENGTH),
    NUMBER(scene_environment, intensity),
    NUMBER(scene_environment, rotation_deg),
    VECTOR(scene_environment, zenith),
    VECTOR(scene_environment, horizon),
    VECTOR(scene_environment, ground),
    CYAML_FIELD_END,
};

static const cyaml_strval_t light_types[] = {{"point", SCENE_LIGHT_POINT}, {"spot", SCENE_LIGHT_SPOT}};
static const cyaml_schema_field_t light_fields[] = {
    CHOICE(scene_light, type, light_types), VECTOR(scene_light, position_m), VECTOR(scene_light, color),
    NUMBER(scene_light, intensity_w_sr),    NUMBER(scene_light, range_m),    VECTOR(scene_light, direction),
    NUMBER(scene_light, inner_deg),         NUMBER(scene_light, outer_deg),  CYAML_FIELD_END,
};
static const cyaml_schema_value_t light = {CYAML_VALUE_MAPPING(D, scene_light, light_fields)};

static const cyaml_schema_field_t camera_key_fields[] = {
    NUMBER(scene_camera_key, time_s),   VECTOR(scene_camera_key, position_m), VECTOR(scene_camera_key, look_at_m),
    NUMBER(scene_camera_key, roll_deg), SWITCH(scene_camera_key, cut),        CYAML_FIELD_END,
};
static const cyaml_schema_value_t camera_key = {CYAML_VALUE_MAPPING(D, scene_camera_key, camera_key_fields)};

static const cyaml_schema_field_t camera_fields[] = {
    NUMBER(scene_camera, fov_deg),
    NUMBER(scene_camera, near_m),
    NUMBER(scene_camera, far_m),
    NUMBER(scene_camera, aperture_mm),
    NUMBER(scene_camera, focus_m),
    LIST("keys", scene_camera, keys, key_count, &camera_key, 1, 100000),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t frames_fields[] = {
    NUMBER(scene_frames, fps),
    WHOLE(scene_frames, first),
    WHOLE(scene_frames, last),
    NUMBER(scene_frames, shutter_deg),
    CYAML_FIELD_SEQUENCE_FIXED("size", D, scene_frames, size, &scene_whole, 2),
    NUMBER(scene_frames, preroll_s),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t preview_fields[] = {
    NUMBER(scene_preview, exposure_ev),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t core_fields[] = {
    CYAML_FIELD_UINT("virga", D, scene_file, version),
    LIST("meshes", scene_file, meshes, mesh_count, &mesh, 0, 1024),
    GROUP(scene_file, environment, environment_fields),
    LIST("lights", scene_file, lights, light_count, &light, 0, SCENE_FILE_MAX_LIGHTS),
    GROUP(scene_file, camera, camera_fields),
    GROUP(scene_file, frames, frames_fields),
    GROUP(scene_file, preview, preview_fields),
};

/* ---- ranges and defaults -------------------------------------------------------------------------------------- */

static const scene_rule core_rules[] = {
    {"virga", SCENE_FILE_VERSION, SCENE_FILE_VERSION, NULL, RESTARTS, "version of the format of scene files"},

    {"meshes", 0, 0, "[]", RESTARTS, "models of the opaque scene, which rain falls on"},
    {"meshes[].file", 0, 0, NULL, RESTARTS | NAMES_FILE, "a model that assimp can open, as glTF or OBJ"},
    {"meshes[].position_m", -MAX_METERS, MAX_METERS, "[0, 0, 0]", RESTARTS, "where its origin lies"},
    {"meshes[].rotation_deg", -36000, 36000, "[0, 0, 0]", RESTARTS, "about the world's X, then Y, then Z axis"},
    {"meshes[].scale", 1e-6, 1e6, "1", RESTARTS, "times its own size"},

    {"environment", 0, 0, "{}", RESTARTS, "light of the sky and all around"},
    {"environment.file", 0, 0, NULL, RESTARTS | NAMES_FILE,
     "a panorama as EXR; without it a sky is made of the three colours"},
    {"environment.intensity", 0, 1e6, "1", RESTARTS, "times its radiance"},
    {"environment.rotation_deg", -36000, 36000, "0", RESTARTS, "around Y, counter-clockwise seen from above"},
    {"environment.zenith", 0, 1e6, "[0.75, 0.82, 0.92]", RESTARTS, "radiance straight up (where no file is given)"},
    {"environment.horizon", 0, 1e6, "[1, 1, 1]", RESTARTS, "radiance of the horizon (where no file is given)"},
    {"environment.ground", 0, 1e6, "[0.25, 0.24, 0.22]", RESTARTS, "radiance from below (where no file is given)"},

    {"lights", 0, 0, "[]", RESTARTS, "lamps; they light the scene and glitter in drops"},
    {"lights[].type", 0, 0, "point", LIVE, "point: the same to all sides; spot: a cone"},
    {"lights[].position_m", -MAX_METERS, MAX_METERS, NULL, LIVE, "where it is in the world"},
    {"lights[].color", 0, 1e6, "[1, 1, 1]", LIVE, "linear red, green, blue, times the intensity"},
    {"lights[].intensity_w_sr", 0, 1e9, NULL, LIVE,
     "radiant intensity on the axis, in the unit of the scene's radiance"},
    {"lights[].range_m", 0, MAX_METERS, "0", LIVE, "its light ends here, faded smoothly; 0: no end"},
    {"lights[].direction", -MAX_METERS, MAX_METERS, "[0, -1, 0]", LIVE, "where a spot points, of any length"},
    {"lights[].inner_deg", 0, 90, "30", LIVE, "full light inside this angle from the axis"},
    {"lights[].outer_deg", 0, 90, "60", LIVE, "no light outside this angle"},

    {"camera", 0, 0, "{}", RESTARTS, "the camera and its path"},
    {"camera.fov_deg", 1, 170, "50", LIVE, "angle of view of the picture's height"},
    {"camera.near_m", 1e-4, 1e4, "0.1", LIVE, "what is nearer is not drawn"},
    {"camera.far_m", 1e-3, MAX_METERS, "2000", LIVE, "what is farther is not drawn"},
    {"camera.aperture_mm", 0, 1000, "0", LIVE, "width of the lens's opening: streaks out of focus are blurred by it"},
    {"camera.focus_m", 0, 1e6, "0", LIVE, "distance at which streaks are sharp; 0: infinity"},
    {"camera.keys", 0, 0, NULL, RESTARTS, "places on the camera's path, by rising time"},
    {"camera.keys[].time_s", -MAX_METERS, MAX_METERS, "0", RESTARTS, "when the camera is there"},
    {"camera.keys[].position_m", -MAX_METERS, MAX_METERS, NULL, RESTARTS, "where the camera is"},
    {"camera.keys[].look_at_m", -MAX_METERS, MAX_METERS, NULL, RESTARTS, "what it looks at"},
    {"camera.keys[].roll_deg", -36000, 36000, "0", RESTARTS, "turn about its own axis, clockwise"},
    {"camera.keys[].cut", 0, 0, "false", RESTARTS, "a new shot begins here"},

    {"frames", 0, 0, "{}", RESTARTS, "which frames there are"},
    {"frames.fps", 1, 1000, "24", RESTARTS, "frames a second; ticks of the simulation divide them"},
    {"frames.first", 0, 1000000, "1", RESTARTS, "number of the first frame, at time 0"},
    {"frames.last", 0, 1000000, "48", RESTARTS, "number of the last frame"},
    {"frames.shutter_deg", 0, 360, "180", LIVE,
     "how long the shutter is open: 360 is a whole frame, 180 the half of film"},
    {"frames.size", 16, 16384, "[1280, 720]", RESTARTS, "pixels of the picture"},
    {"frames.preroll_s", 0, 3600, "0", RESTARTS,
     "rain falls so long before the first frame, so that a shot begins wet"},

    {"preview", 0, 0, "{}", LIVE, "how previews are shown"},
    {"preview.exposure_ev", -30, 30, "0", LIVE, "brightens what is shown, in stops; layers stay as they are"},
};

/* ---- sections ------------------------------------------------------------------------------------------------- */

static size_t align_up(size_t size)
{
    return (size + SECTION_ALIGNMENT - 1) / SECTION_ALIGNMENT * SECTION_ALIGNMENT;
}

scene_format *scene_format_create(const scene_section *const *sections)
{
    size_t count = CYAML_ARRAY_LEN(core_fields), section_count = 0, size = align_up(sizeof(scene_file));
    while (sections[section_count])
        section_count++;
    scene_format *format = calloc(1, sizeof *format + (count + section_count + 1) * sizeof *format->fields);
    if (!format)
        return NULL;
    memcpy(format->fields, core_fields, sizeof core_fields);
    for (size_t i = 0; i < section_count; i++) {
        cyaml_schema_field_t field = sections[i]->field;
        if (!field.key)
            continue;
        field.data_offset += (uint32_t)size;
        field.count_offset += (uint32_t)size;
        memcpy(&format->fields[count++], &field, sizeof field);
        size += align_up(sections[i]->size);
    }
    format->sections = sections;
    format->schema = (cyaml_schema_value_t){CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, scene_file, format->fields)};
    format->schema.data_size = (uint32_t)size;
    return format;
}

void *scene_file_section(const scene_file *scene, const scene_section *section)
{
    char *at = (char *)(uintptr_t)scene + align_up(sizeof(scene_file));
    for (const scene_section *const *one = scene->format->sections; *one; one++) {
        if (*one == section)
            return at;
        at += (*one)->field.key ? align_up((*one)->size) : 0;
    }
    return NULL;
}

const scene_rule *scene_rule_at(const scene_format *format, size_t index)
{
    if (index < CYAML_ARRAY_LEN(core_rules))
        return &core_rules[index];
    index -= CYAML_ARRAY_LEN(core_rules);
    for (const scene_section *const *one = format->sections; *one; one++) {
        if (index < (*one)->rule_count)
            return &(*one)->rules[index];
        index -= (*one)->rule_count;
    }
    return NULL;
}

const scene_rule *scene_rule_find(const scene_format *format, const char *path)
{
    const scene_rule *rule;
    for (size_t i = 0; (rule = scene_rule_at(format, i)); i++)
        if (!strcmp(rule->path, path))
            return rule;
    return NULL;
}

/* ---- values --------------------------------------------------------------------------------------------------- */

uint32_t scene_list_length(const cyaml_schema_field_t *list, const void *group)
{
    uint64_t length = 0;
    memcpy(&length, (const char *)group + list->count_offset, list->count_size); /* little-endian, as libcyaml's own */
    return (uint32_t)length;
}

char **scene_list_entries(const cyaml_schema_field_t *list, void *group)
{
    return (char **)(void *)((char *)group + list->data_offset);
}

const char *scene_choice_keyword(const cyaml_strval_t *keywords, size_t count, uint32_t value)
{
    for (size_t i = 0; i < count; i++)
        if (keywords[i].val == (int64_t)value)
            return keywords[i].str;
    return "";
}
