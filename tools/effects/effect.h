/* effect.h - what the program knows of an effect, as one table.
 *
 * Every effect has one file here that defines its table, and one entry in the list in meson.build. Everything else
 * walks the tables: no other file of the program has to know a new effect. */
#ifndef VIRGA_EFFECTS_EFFECT_H
#define VIRGA_EFFECTS_EFFECT_H

#include "scene_schema.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tool_effect {
    const char *name;
    scene_section scene; /* keys of scene files; see scene_schema.h */
} tool_effect;

/* rain_effect, ground_effect, ... */
#define EFFECT(name) extern const tool_effect name##_effect;
#include "effect_list.h"
#undef EFFECT

/* All effects, in the order of their keys in scene files; NULL behind the last. */
extern const tool_effect *const tool_effects[];

/* Their sections, for scene_file_load; NULL behind the last. */
extern const scene_section *const tool_effect_sections[];

#ifdef __cplusplus
}
#endif
#endif
