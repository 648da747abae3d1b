/* scene_settings.h - all settings of a loaded scene as a list, to be shown and changed one by one by a panel of
 * controls. scene_changes.h turns what was tuned there into a scene file again.
 *
 * Keys, ranges, defaults and descriptions are those of the schema, so a key that is new there is here too. */
#ifndef VIRGA_IO_SCENE_SETTINGS_H
#define VIRGA_IO_SCENE_SETTINGS_H

#include "scene_file.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCENE_SETTING_ROOM 512 /* bytes that any value as YAML fits */

typedef enum scene_setting_kind {
    SCENE_SETTING_NUMBER,       /* double[count] */
    SCENE_SETTING_WHOLE,        /* uint32_t[count] */
    SCENE_SETTING_SWITCH,       /* bool */
    SCENE_SETTING_CHOICE,       /* uint32_t, see scene_setting_word */
    SCENE_SETTING_TEXT,         /* char *; may be NULL. Is not changed */
    SCENE_SETTING_MAYBE_NUMBER, /* double *; NULL: not given */
    SCENE_SETTING_MAYBE_SWITCH, /* bool *; likewise */
} scene_setting_kind;

typedef struct scene_setting {
    char path[96];    /* "glass.0.wipers.1.sweep_s", as overrides have it */
    char rule[96];    /* "glass[].wipers[].sweep_s", as the schema has it */
    char name[64];    /* its last part for people, without the unit: "sweep" */
    const char *unit; /* "degrees", "mm/h"; "" where it has none */
    scene_setting_kind kind;
    uint32_t count;                       /* (number, whole) 1, or that many of a vector */
    void *value;                          /* in the scene, as `kind` says */
    double low, high;                     /* (numbers) range of each */
    const char *initial;                  /* default, as YAML; "@path" takes another's; NULL: none */
    bool restarts;                        /* a change needs the simulation to start again */
    const char *help;                     /* one line */
    const struct scene_keyword *keywords; /* (choice) see scene_setting_word */
} scene_setting;

/* All settings of a scene, in the order of the schema: an array to free(), NULL without memory. It points into the
 * scene; those of lists count as they are now, so make it anew where a list has changed. */
scene_setting *scene_settings_list(scene_file *scene, size_t *count);

/* The setting of a path, or NULL. */
scene_setting *scene_settings_find(scene_setting *settings, size_t count, const char *path);

/* (choice) The keyword with an index, and its value; NULL behind the last. */
const char *scene_setting_word(const scene_setting *setting, uint32_t index, uint32_t *value);

/* The value as YAML: "[1, 0, 2.5]", "continuous", "null" for an optional one that is not given. */
void scene_setting_print(const scene_setting *setting, char *text, size_t size);

/* Parses a value as YAML and checks its range. Where it is refused, nothing changes and `error` gets one line. */
bool scene_setting_parse(scene_setting *setting, const char *text, char *error, size_t error_size);

/* Back to the default; false where there is none. */
bool scene_setting_reset(scene_setting *setting, scene_setting *all, size_t count);

/* Applies "path=value" to a scene; '*' in place of a number stands for all entries of a list, of which there may be
 * none. `restarts` (may be NULL) is set where the rain has to start anew for it; else left. */
bool scene_settings_assign(scene_file *scene, const char *assignment, bool *restarts, char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
