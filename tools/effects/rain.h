/* rain.h - declares the settings of rain in a scene file. */
#ifndef VIRGA_EFFECTS_RAIN_H
#define VIRGA_EFFECTS_RAIN_H

#include "scene_file.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum scene_sizes { SCENE_SIZES_MARSHALL_PALMER, SCENE_SIZES_BEST, SCENE_SIZES_TABLE } scene_sizes;

typedef struct scene_size_entry {
    double diameter_mm;
    double number; /* relative density */
} scene_size_entry;

typedef struct scene_rain_key {
    double time_s;
    double rate_mm_h;
    double wind_m_s[3];
} scene_rain_key;

/* Walls that driving rain wets. */
typedef struct scene_rain_walls {
    bool on;
    double share, start_h;
} scene_rain_walls;

typedef struct scene_rain {
    double rate_mm_h;
    uint32_t sizes;          /* scene_sizes */
    scene_size_entry *table; /* in order of diameter; min 2 entries if sizes is SCENE_SIZES_TABLE */
    uint32_t table_count;
    double air_density;
    double wind_m_s[3];
    double gust_m_s, gust_time_s;
    double transition_s;
    uint32_t max_drops;
    double range_m;
    uint32_t seed;
    double streak_gain, light_gain, min_width_px, soft_m, near_fade_m, oscillation, haze, haze_sky_m, glow,
        streak_min_mm, streak_group_mm;
    uint32_t occlusion_size, occlusion_cascades, occlusion_slants, occlusion_interval;
    scene_rain_walls walls;
    scene_rain_key *keys; /* in order of time; linear between, constant outside; none: rate_mm_h and wind_m_s apply */
    uint32_t key_count;
} scene_rain;

/* The rain of a scene. */
scene_rain *scene_rain_of(const scene_file *scene);

/* Rate and wind at a time: from the keys, or constant if there are none. */
void scene_rain_weather(const scene_rain *rain, double time_s, double *rate_mm_h, double wind_m_s[3]);

#ifdef __cplusplus
}
#endif
#endif
