/* splash.h - declares the settings of splashes in a scene file. */
#ifndef VIRGA_EFFECTS_SPLASH_H
#define VIRGA_EFFECTS_SPLASH_H

#include "scene_file.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum scene_splash_mode { SCENE_SPLASH_MODE_PAPER, SCENE_SPLASH_MODE_PHYSICAL } scene_splash_mode;
typedef enum scene_splash_style { SCENE_SPLASH_STYLE_PAPER, SCENE_SPLASH_STYLE_FILM } scene_splash_style;

/* The lower end of a downpipe, which empties the gutters near it. */
typedef struct scene_downpipe {
    double position_m[3], velocity_m_s[3];
} scene_downpipe;

/* Edges from which rain drips. */
typedef struct scene_splash_drips {
    bool on;
    double reach_m;
    double min_mm, max_mm;
    bool wet;
    uint32_t max_sites;
    bool moving;
    bool pour;
    scene_downpipe *pipes;
    uint32_t pipe_count;
} scene_splash_drips;

typedef struct scene_splash {
    bool on;        /* needs the ground to be on too */
    uint32_t mode;  /* scene_splash_mode */
    uint32_t style; /* scene_splash_style */
    uint32_t max_splashes, max_droplets;
    double droplet_range_m;
    double bounce;
    double pile_max_s, pile_max_m;
    double dot_min_mm;
    double gain, light_gain, min_width_px, soft_m, near_fade_m, parts_px, hole_um;
    scene_splash_drips drips;
} scene_splash;

/* The splashes of a scene. */
scene_splash *scene_splash_of(const scene_file *scene);

/* The keyword of each value in scene files. */
const char *scene_splash_mode_name(uint32_t mode);
const char *scene_splash_style_name(uint32_t style);

#ifdef __cplusplus
}
#endif
#endif
