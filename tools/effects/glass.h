/* glass.h - declares the panes of a scene file. Drops run down them. */
#ifndef VIRGA_EFFECTS_GLASS_H
#define VIRGA_EFFECTS_GLASS_H

#include "scene_schema.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCENE_FILE_MAX_PANES  128 /* the max of the library's scene */
#define SCENE_FILE_MAX_WIPERS 8   /* per pane, the max of the library */

/* Keywords of panes. virga/glass.h explains their meaning. */
typedef enum scene_pane_shape { SCENE_PANE_FLAT, SCENE_PANE_WINDSHIELD, SCENE_PANE_MESH } scene_pane_shape;
typedef enum scene_pane_follow { SCENE_PANE_WORLD, SCENE_PANE_CAMERA } scene_pane_follow;
typedef enum scene_pane_motion { SCENE_PANE_MOTION_PATH, SCENE_PANE_MOTION_GIVEN } scene_pane_motion;
typedef enum scene_wiper_drive {
    SCENE_WIPER_PARKED,
    SCENE_WIPER_CONTINUOUS,
    SCENE_WIPER_INTERMITTENT,
    SCENE_WIPER_KEYS,
} scene_wiper_drive;

typedef struct scene_wiper_key {
    double time_s, angle_deg;
} scene_wiper_key;

typedef struct scene_wiper {
    double pivot_m[2]; /* on the pane: right and up from its lower left corner, seen from outside */
    double reach_m, blade_m, width_m;
    double low_deg, high_deg, blade_deg, blade_hold_direction;
    uint32_t drive; /* scene_wiper_drive */
    double sweep_s, pause_s, phase_s;
    double film_mm, wear;
    scene_wiper_key *keys; /* (keys) in order of time; linear between them, constant outside; min 1 */
    uint32_t key_count;
    bool drawn; /* arm and blade are visible */
} scene_wiper;

/* A height map of the surface. */
typedef struct scene_bumps {
    char *file;        /* path of a PNG with numbers (see png_read_numbers); NULL: smooth */
    double size_mm[2]; /* width and height that the image covers; it repeats */
    double depth_mm;   /* depth of black below white */
    double affinity;
} scene_bumps;

/* Breath on a pane, and what fogs it. virga/glass.h explains them. */
typedef struct scene_breath {
    double time_s, duration_s, position_m[2], radius_m, share;
} scene_breath;

typedef struct scene_condensation {
    uint32_t side; /* virga_glass_fog_side */
    double air_c, humidity, glass_c, heat_w_m2_k, droplets_per_mm2, drop_radius_mm, start_um;
    double heater_k, heater_s, heater_from_s;
    uint32_t heater_wires;
    scene_breath *breaths;
    uint32_t breath_count;
} scene_condensation;

/* A pane with its drops. A member that is a pointer to a number is NULL if `kind` gives the number. */
typedef struct scene_pane {
    char *name;
    uint32_t shape; /* scene_pane_shape */
    double width_m, height_m;
    double rake_deg, bend_m; /* (windshield) */
    char *mesh;              /* (mesh) part of the name of a mesh or its material, in upper or lower case */
    char *mask;              /* path of a PNG, black where there is no glass; NULL: glass everywhere */
    uint32_t follow;         /* scene_pane_follow: the frame of position and angles */
    /* Position of the middle of the lower edge (mesh: of the model's origin). In the world, or relative to the camera:
     * to the right of it, above it and ahead of it. */
    double position_m[3];
    double yaw_deg;   /* to the left, seen from above; at 0 the outside faces +Z, or ahead */
    double pitch_deg; /* backward */
    double roll_deg;  /* to the left, seen from outside */
    uint32_t motion;  /* scene_pane_motion */
    double velocity_m_s[3], acceleration_m_s2[3], angular_velocity_deg_s[3]; /* (given) in the frame of position_m */
    double shelter;
    double frame_m; /* width of a dark frame around it; 0: none */
    uint32_t kind;  /* virga_glass_kind */
    double *advancing_deg, *receding_deg, *kinetic_hold, *affinity, *film_um, *tail_max_radius_mm, *pinning;
    bool *opaque; /* NULL: only metal and leaves are opaque */
    double drag, meander, path_ease, path_dry_s, merge_distance;
    double tail_spacing_m, tail_lifetime_s, film_break_s, evaporation_mm_h, mist_max_mm, air_share, air_outward;
    scene_wiper *wipers;
    uint32_t wiper_count;
    double particle_radius_mm, penalty, particle_band, hold_back_mm;
    uint32_t hold_back_cells;
    uint32_t density, blend; /* virga_glass_density, virga_glass_blend */
    bool compress;
    double compress_from, compress_step, compress_k;
    uint32_t compress_steps;
    double threshold, impact_s;
    uint32_t style; /* virga_glass_style */
    double paper_shift, thickness_mm, tint[3], gain;
    double textured_px;
    uint32_t texture_shape; /* virga_glass_texture_shape */
    uint32_t textures_per_frame;
    bool still_behind;
    double veil, starburst, starburst_deg;
    uint32_t starburst_rays, opening_blades;
    double opening_roundness, opening_deg;
    double cell_m, affinity_size_m;
    uint32_t max_drops, max_texels;
    uint32_t texture_columns, texture_rows, texture_texels;
    scene_bumps bumps;
    scene_condensation condensation;
} scene_pane;

/* All panes, the most distant first. */
typedef struct scene_glass {
    scene_pane *panes; /* the key `glass` */
    uint32_t pane_count;
} scene_glass;

/* The panes of a scene. */
scene_glass *scene_glass_of(const scene_file *scene);

/* The keywords of virga_glass_kind. NULL after the last. */
extern const scene_keyword scene_pane_kinds[];

/* The keyword of each value in scene files. */
const char *scene_pane_shape_name(uint32_t shape);
const char *scene_pane_kind_name(uint32_t kind);
const char *scene_pane_style_name(uint32_t style);

/* The angle of the arm at a time, for a wiper that is driven by keys. */
double scene_wiper_angle_deg(const scene_wiper *wiper, double time_s);

#ifdef __cplusplus
}
#endif
#endif
