/* scene_settings.h - all settings of a loaded scene as an array, for a panel that shows and changes them.
 * scene_changes.h saves such changes. Keys, ranges, defaults and descriptions are those of the schema. */
#ifndef VIRGA_IO_SCENE_SETTINGS_H
#define VIRGA_IO_SCENE_SETTINGS_H

#include "scene_file.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCENE_SETTING_BYTES 512 /* bytes, enough for any value as YAML */

typedef enum scene_setting_kind {
    SCENE_SETTING_NUMBER,       /* double[count] */
    SCENE_SETTING_WHOLE,        /* uint32_t[count] */
    SCENE_SETTING_SWITCH,       /* bool */
    SCENE_SETTING_CHOICE,       /* uint32_t, see scene_setting_keyword */
    SCENE_SETTING_TEXT,         /* char *; may be NULL. Is not changed */
    SCENE_SETTING_MAYBE_NUMBER, /* double *; NULL: not given */
    SCENE_SETTING_MAYBE_SWITCH, /* bool *; likewise */
} scene_setting_kind;

typedef struct scene_setting {
    char path[96];    /* "glass.0.wipers.1.sweep_s", as overrides have it */
    char rule[96];    /* "glass[].wipers[].sweep_s", as the schema has it */
    char name[64];    /* last part of the path, without the unit: "sweep" */
    const char *unit; /* "degrees", "mm/h"; "" where it has none */
    scene_setting_kind kind;
    uint32_t count;                       /* (number, whole) 1, or that many of a vector */
    void *value;                          /* in the scene, as `kind` says */
    double low, high;                     /* (numbers) range of each */
    const char *initial;                  /* default, as YAML; "@path" takes another's; NULL: none */
    bool restarts;                        /* a change needs the simulation to start again */
    const char *help;                     /* one line */
    const struct scene_keyword *keywords; /* (choice) see scene_setting_keyword */
} scene_setting;

/* All settings of a scene, in the order of the schema: an array for free(), NULL if there is no memory. It points into
 * the scene, and is invalid after the length of a list has changed. */
scene_setting *scene_settings_list(scene_file *scene, size_t *count);

/* The setting of a path, or NULL. */
scene_setting *scene_settings_find(scene_setting *settings, size_t count, const char *path);

/* (choice) The keyword with an index, and its value. NULL after the last. */
const char *scene_setting_keyword(const scene_setting *setting, uint32_t index, uint32_t *value);

/* Prints the value as YAML: "[1, 0, 2.5]", "continuous", "null" for an optional one that is missing. */
void scene_setting_print(const scene_setting *setting, char *text, size_t size);

/* Parses a value as YAML and checks its range. If it is refused, nothing changes and `error` has one line. */
bool scene_setting_parse(scene_setting *setting, const char *text, char *error, size_t error_size);

/* Resets the value to the default. False if there is none. */
bool scene_setting_reset(scene_setting *setting, scene_setting *all, size_t count);

/* Applies "path=value" to a scene. '*' instead of a number stands for all entries of a list, which may be empty.
 * `restarts` (may be NULL) is set to true if the simulation must restart for it, and otherwise not changed. */
bool scene_settings_assign(scene_file *scene, const char *assignment, bool *restarts, char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
