/* rain.c - what the program knows of the rain. */
#include "rain.h"

#include <stdio.h>
#include <string.h>

#include "effect.h"
#include "scene_rows.h"

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

/* Ranges and defaults are the library's own: virga/rain.h. */

static const scene_row size_entry_rows[] = {
    NUMBER(scene_size_entry, diameter_mm, 0, 20, NULL, RESTARTS, "a size of drops"),
    NUMBER(scene_size_entry, number, 0, 1e12, NULL, RESTARTS, "relative number of drops of that size"),
};
static const scene_group size_entry_group = SCENE_GROUP(scene_size_entry, size_entry_rows);

static const scene_row rain_key_rows[] = {
    NUMBER(scene_rain_key, time_s, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "when they are so"),
    NUMBER(scene_rain_key, rate_mm_h, 0, 200, "@rain.rate_mm_h", LIVE, "rain that lands on level ground then"),
    NUMBER(scene_rain_key, wind_m_s, -60, 60, "@rain.wind_m_s", LIVE, "mean wind then"),
};
static const scene_group rain_key_group = SCENE_GROUP(scene_rain_key, rain_key_rows);

static const scene_keyword sizes[] = {{"marshall-palmer", SCENE_SIZES_MARSHALL_PALMER},
                                      {"best", SCENE_SIZES_BEST},
                                      {"table", SCENE_SIZES_TABLE},
                                      {NULL, 0}};
static const scene_row rain_rows[] = {
    NUMBER(scene_rain, rate_mm_h, 0, 200, "10", LIVE,
           "rain that lands on level ground: 0.5 drizzle, 2 light, 10 shower, 25 heavy, 50 storm, 150 cloudburst"),
    CHOICE(scene_rain, sizes, sizes, "marshall-palmer", LIVE,
           "distribution of drop sizes; best has more large drops, table is your own"),
    LIST(scene_rain, table, table_count, &size_entry_group, 0, 256, "[]",
         "sizes and their relative numbers, for sizes: table"),
    NUMBER(scene_rain, air_density, 0.3, 2, "1.204", LIVE, "kg/m^3; lower at height, where drops fall faster"),
    NUMBER(scene_rain, wind_m_s, -60, 60, "[0, 0, 0]", LIVE, "mean wind; y is an updraught"),
    NUMBER(scene_rain, gust_m_s, 0, 30, "0", LIVE, "standard deviation of each horizontal part of the wind"),
    NUMBER(scene_rain, gust_time_s, 0.1, 600, "4", LIVE, "time scale of gusts"),
    NUMBER(scene_rain, transition_s, 0, 60, "0.5", LIVE, "time in which rate and sizes ease into new values"),
    WHOLE(scene_rain, max_drops, 1024, 4194304, "131072", RESTARTS,
          "slots of the field of drops: quality falls with it, the rate never; 32 bytes each"),
    NUMBER(scene_rain, range_m, 4, 512, "32", RESTARTS,
           "drops are drawn and land up to here from the camera, haze takes over beyond"),
    WHOLE(scene_rain, seed, 0, UINT32_TOP, "1", RESTARTS, "another seed, other drops with the same statistics"),
    NUMBER(scene_rain, streak_gain, 0, 100, "1", LIVE,
           "multiplies the coverage of streaks; 1 is what a camera records"),
    NUMBER(scene_rain, light_gain, 0, 100, "1", LIVE, "multiplies the light of lamps in drops; 1 is physical"),
    NUMBER(scene_rain, min_width_px, 0.5, 4, "1", LIVE, "narrower streaks are drawn this wide with less coverage"),
    NUMBER(scene_rain, soft_m, 0, 1, "0.05", LIVE, "streaks fade over this depth where they meet geometry"),
    NUMBER(scene_rain, near_m, 0, 5, "0.15", LIVE, "drops nearer to the camera than this fade out"),
    NUMBER(scene_rain, oscillation, 0, 4, "1", LIVE, "how much large drops wobble; 1 is physical"),
    NUMBER(scene_rain, haze, 0, 4, "1", LIVE, "extinction by the rain farther off; 1 is physical"),
    NUMBER(scene_rain, haze_sky_m, 0, 100000, "400", LIVE,
           "haze before the sky; 0 where its picture was taken in rain, as --plate"),
    NUMBER(scene_rain, glow, 0, 100, "1", LIVE, "glow of lamps in that haze; 1 is physical"),
    NUMBER(scene_rain, bodies_min_mm, 0.2, 2, "0.4", LIVE,
           "smaller drops are drawn as haze only; they land all the same"),
    WHOLE(scene_rain, occlusion_size, 0, 8192, "1024", RESTARTS,
          "texels along a side of the maps of where no rain falls; 0: it falls through roofs"),
    WHOLE(scene_rain, occlusion_cascades, 1, 4, "2", RESTARTS, "maps around each other, the widest covers the range"),
    WHOLE(scene_rain, occlusion_slants, 1, 4, "2", RESTARTS, "maps for drops of different slant"),
    WHOLE(scene_rain, occlusion_turns, 1, 16, "1", LIVE,
          "frames in which the maps are drawn by turns; more is quicker, and late"),
    LIST(scene_rain, keys, key_count, &rain_key_group, 0, 100000, "[]",
         "rate and wind by time, in place of the two settings"),
};
static const scene_group rain_group = SCENE_GROUP(scene_rain, rain_rows);

/* The section has one key: all of the struct. */
static const scene_row rain_section[] = {SECTION_GROUP("rain", &rain_group, "what falls")};

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

/* ---- the effect ----------------------------------------------------------------------------------------------- */

scene_rain *scene_rain_of(const scene_file *scene)
{
    return scene_file_section(scene, &rain_effect.scene);
}

const tool_effect rain_effect = {
    .name = "rain",
    .scene = {.group = SCENE_GROUP(scene_rain, rain_section), .check = check_rain},
};
