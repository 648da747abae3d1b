/* scene_units.c - units at the end of keys. */
#include "scene_schema.h"

#include <stdio.h>
#include <string.h>

/* Units at the end of keys. A unit comes before others that are its ending. */
static const struct {
    const char *ending, *unit;
} units[] = {
    {"_m_s2", "m/s^2"},
    {"_deg_s", "degrees/s"},
    {"_um", "micrometres"},
    {"_mm_h", "mm/h"},
    {"_mm_s", "mm/s"},
    {"_km_h", "km/h"},
    {"_m_s", "m/s"},
    {"_w_sr", "W/sr"},
    {"_deg", "degrees"},
    {"_rad", "rad"},
    {"_kmh", "km/h"},
    {"_mph", "mph"},
    {"_mm", "mm"},
    {"_cm", "cm"},
    {"_km", "km"},
    {"_ms", "ms"},
    {"_px", "pixels"},
    {"_ev", "stops"},
    {"_hz", "Hz"},
    {"_m", "m"},
    {"_s", "s"},
    {"_w", "W"},
    {"_h", "h"},
    {"_cd", "cd"},
    {"_lm", "lm"},
};

const char *scene_key_unit(const char *key, char stem[64])
{
    snprintf(stem, 64, "%s", key);
    size_t length = strlen(stem);
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        size_t ending = strlen(units[i].ending);
        if (length > ending && !strcmp(stem + length - ending, units[i].ending)) {
            stem[length - ending] = 0;
            return units[i].unit;
        }
    }
    return NULL;
}
