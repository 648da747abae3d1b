/* rain.c - what the program knows of the rain. */
#include "rain.h"

#include <stdio.h>
#include <string.h>

#include "effect.h"
#include "scene_rows.h"

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

static const cyaml_schema_field_t size_entry_fields[] = {
    NUMBER(scene_size_entry, diameter_mm),
    NUMBER(scene_size_entry, number),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t size_entry = {CYAML_VALUE_MAPPING(D, scene_size_entry, size_entry_fields)};

static const cyaml_schema_field_t rain_key_fields[] = {
    NUMBER(scene_rain_key, time_s),
    NUMBER(scene_rain_key, rate_mm_h),
    VECTOR(scene_rain_key, wind_m_s),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t rain_key = {CYAML_VALUE_MAPPING(D, scene_rain_key, rain_key_fields)};

static const cyaml_strval_t sizes[] = {
    {"marshall-palmer", SCENE_SIZES_MARSHALL_PALMER},
    {"best", SCENE_SIZES_BEST},
    {"table", SCENE_SIZES_TABLE},
};
static const cyaml_schema_field_t rain_fields[] = {
    NUMBER(scene_rain, rate_mm_h),
    CHOICE(scene_rain, sizes, sizes),
    LIST("table", scene_rain, table, table_count, &size_entry, 0, 256),
    NUMBER(scene_rain, air_density),
    VECTOR(scene_rain, wind_m_s),
    NUMBER(scene_rain, gust_m_s),
    NUMBER(scene_rain, gust_time_s),
    NUMBER(scene_rain, transition_s),
    WHOLE(scene_rain, max_drops),
    NUMBER(scene_rain, range_m),
    WHOLE(scene_rain, seed),
    NUMBER(scene_rain, streak_gain),
    NUMBER(scene_rain, light_gain),
    NUMBER(scene_rain, min_width_px),
    NUMBER(scene_rain, soft_m),
    NUMBER(scene_rain, near_m),
    NUMBER(scene_rain, oscillation),
    NUMBER(scene_rain, haze),
    NUMBER(scene_rain, haze_sky_m),
    NUMBER(scene_rain, glow),
    NUMBER(scene_rain, bodies_min_mm),
    WHOLE(scene_rain, occlusion_size),
    WHOLE(scene_rain, occlusion_cascades),
    WHOLE(scene_rain, occlusion_slants),
    WHOLE(scene_rain, occlusion_turns),
    LIST("keys", scene_rain, keys, key_count, &rain_key, 0, 100000),
    CYAML_FIELD_END,
};

/* Ranges and defaults are the library's own: virga/rain.h. */
static const scene_rule rain_rules[] = {
    {"rain", 0, 0, "{}", RESTARTS, "what falls"},
    {"rain.rate_mm_h", 0, 200, "10", LIVE,
     "rain that lands on level ground: 0.5 drizzle, 2 light, 10 shower, 25 heavy, 50 storm, 150 cloudburst"},
    {"rain.sizes", 0, 0, "marshall-palmer", LIVE,
     "distribution of drop sizes; best has more large drops, table is your own"},
    {"rain.table", 0, 0, "[]", RESTARTS, "sizes and their relative numbers, for sizes: table"},
    {"rain.table[].diameter_mm", 0, 20, NULL, RESTARTS, "a size of drops"},
    {"rain.table[].number", 0, 1e12, NULL, RESTARTS, "relative number of drops of that size"},
    {"rain.air_density", 0.3, 2, "1.204", LIVE, "kg/m^3; lower at height, where drops fall faster"},
    {"rain.wind_m_s", -60, 60, "[0, 0, 0]", LIVE, "mean wind; y is an updraught"},
    {"rain.gust_m_s", 0, 30, "0", LIVE, "standard deviation of each horizontal part of the wind"},
    {"rain.gust_time_s", 0.1, 600, "4", LIVE, "time scale of gusts"},
    {"rain.transition_s", 0, 60, "0.5", LIVE, "time in which rate and sizes ease into new values"},
    {"rain.max_drops", 1024, 4194304, "131072", RESTARTS,
     "slots of the field of drops: quality falls with it, the rate never; 32 bytes each"},
    {"rain.range_m", 4, 512, "32", RESTARTS,
     "drops are drawn and land up to here from the camera, haze takes over beyond"},
    {"rain.seed", 0, UINT32_TOP, "1", RESTARTS, "another seed, other drops with the same statistics"},
    {"rain.streak_gain", 0, 100, "1", LIVE, "multiplies the coverage of streaks; 1 is what a camera records"},
    {"rain.light_gain", 0, 100, "1", LIVE, "multiplies the light of lamps in drops; 1 is physical"},
    {"rain.min_width_px", 0.5, 4, "1", LIVE, "narrower streaks are drawn this wide with less coverage"},
    {"rain.soft_m", 0, 1, "0.05", LIVE, "streaks fade over this depth where they meet geometry"},
    {"rain.near_m", 0, 5, "0.15", LIVE, "drops nearer to the camera than this fade out"},
    {"rain.oscillation", 0, 4, "1", LIVE, "how much large drops wobble; 1 is physical"},
    {"rain.haze", 0, 4, "1", LIVE, "extinction by the rain farther off; 1 is physical"},
    {"rain.haze_sky_m", 0, 100000, "400", LIVE,
     "haze before the sky; 0 where its picture was taken in rain, as --plate"},
    {"rain.glow", 0, 100, "1", LIVE, "glow of lamps in that haze; 1 is physical"},
    {"rain.bodies_min_mm", 0.2, 2, "0.4", LIVE, "smaller drops are drawn as haze only; they land all the same"},
    {"rain.occlusion_size", 0, 8192, "1024", RESTARTS,
     "texels along a side of the maps of where no rain falls; 0: it falls through roofs"},
    {"rain.occlusion_cascades", 1, 4, "2", RESTARTS, "maps around each other, the widest covers the range"},
    {"rain.occlusion_slants", 1, 4, "2", RESTARTS, "maps for drops of different slant"},
    {"rain.occlusion_turns", 1, 16, "1", LIVE,
     "frames in which the maps are drawn by turns; more is quicker, and late"},
    {"rain.keys", 0, 0, "[]", RESTARTS, "rate and wind by time, in place of the two settings"},
    {"rain.keys[].time_s", -MAX_METERS, MAX_METERS, NULL, RESTARTS, "when they are so"},
    {"rain.keys[].rate_mm_h", 0, 200, "@rain.rate_mm_h", LIVE, "rain that lands on level ground then"},
    {"rain.keys[].wind_m_s", -60, 60, "@rain.wind_m_s", LIVE, "mean wind then"},
};

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

static bool check_table(const scene_file *scene, const scene_rain *rain, char *error, size_t error_size)
{
    char key[64];
    bool any = false;
    if (rain->table_count < 2)
        return rain->sizes != SCENE_SIZES_TABLE ||
               scene_file_refuse(scene, "rain.table", error, error_size,
                                 "expected at least 2 entries, as rain.sizes is table");
    for (uint32_t i = 0; i < rain->table_count; i++) {
        const scene_size_entry *now = &rain->table[i];
        any |= now->number > 0;
        if (i > 0 && now->diameter_mm <= now[-1].diameter_mm) {
            snprintf(key, sizeof key, "rain.table.%u.diameter_mm", i);
            return scene_file_refuse(scene, key, error, error_size,
                                     "expected more than the entry before has (%g), got %g", now[-1].diameter_mm,
                                     now->diameter_mm);
        }
    }
    /* The drops that the rain holds go from 0.2 to 6.8 mm. */
    if (!any || rain->table[0].diameter_mm >= 6.8 || rain->table[rain->table_count - 1].diameter_mm <= 0.2)
        return scene_file_refuse(scene, "rain.table", error, error_size, "expected some drops between 0.2 and 6.8 mm");
    return true;
}

static bool check_rain(const scene_file *scene, char *error, size_t error_size)
{
    const scene_rain *rain = scene_rain_of(scene);
    char key[64];
    if (rain->occlusion_size > 0 && rain->occlusion_size < 64)
        return scene_file_refuse(scene, "rain.occlusion_size", error, error_size,
                                 "expected 0 (no occlusion) or 64 to 8192, got %u", rain->occlusion_size);
    for (uint32_t i = 1; i < rain->key_count; i++) {
        const scene_rain_key *now = &rain->keys[i];
        if (now->time_s <= now[-1].time_s) {
            snprintf(key, sizeof key, "rain.keys.%u.time_s", i);
            return scene_file_refuse(scene, key, error, error_size,
                                     "expected more than the key before has (%g), got %g", now[-1].time_s, now->time_s);
        }
    }
    return check_table(scene, rain, error, error_size);
}

/* ---- the effect ----------------------------------------------------------------------------------------------- */

const tool_effect rain_effect = {
    .name = "rain",
    .scene =
        {
            .field = GROUP_SECTION("rain", scene_rain, rain_fields),
            .size = sizeof(scene_rain),
            .rules = rain_rules,
            .rule_count = CYAML_ARRAY_LEN(rain_rules),
            .check = check_rain,
        },
};

scene_rain *scene_rain_of(const scene_file *scene)
{
    return scene_file_section(scene, &rain_effect.scene);
}

void scene_rain_weather(const scene_rain *rain, double time_s, double *rate_mm_h, double wind_m_s[3])
{
    *rate_mm_h = rain->rate_mm_h;
    memcpy(wind_m_s, rain->wind_m_s, sizeof rain->wind_m_s);
    if (rain->key_count == 0)
        return;
    uint32_t next = 0;
    while (next < rain->key_count && rain->keys[next].time_s <= time_s)
        next++;
    const scene_rain_key *before = &rain->keys[next > 0 ? next - 1 : 0];
    const scene_rain_key *after = &rain->keys[next < rain->key_count ? next : next - 1];
    double span = after->time_s - before->time_s;
    double share = span > 0 ? (time_s - before->time_s) / span : 0;
    *rate_mm_h = before->rate_mm_h + share * (after->rate_mm_h - before->rate_mm_h);
    for (int i = 0; i < 3; i++)
        wind_m_s[i] = before->wind_m_s[i] + share * (after->wind_m_s[i] - before->wind_m_s[i]);
}
