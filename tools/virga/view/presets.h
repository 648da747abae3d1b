/* presets.h - presets of weather. */
#ifndef VIRGA_VIEW_PRESETS_H
#define VIRGA_VIEW_PRESETS_H

#include <stddef.h>

#define VIEW_PRESET_SETTINGS 24

typedef struct view_preset {
    const char *name; /* for scripts: one word */
    const char *title, *help;
    const char *settings[VIEW_PRESET_SETTINGS]; /* for scene_settings_assign; NULL after the last */
} view_preset;

/* All presets, `*count` of them; static data. */
const view_preset *view_presets(size_t *count);

#endif
