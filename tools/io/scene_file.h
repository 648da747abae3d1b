/* scene_file.h - scene files: YAML by schema, checked to the last key.
 *
 * A file names meshes, an environment, lights, a camera's path, the frames to render, the rain, the ground that it
 * wets, the splashes that it makes there, and panes that drops run down. All lengths in metres, angles in degrees,
 * Y up. Every key but `virga` and `camera.keys` has a default; see scene_schema.c for the ranges and defaults. What
 * is wrong is told in one line with file, line and key:
 *
 *     street.yaml:12: rain.rate_mm_h: expected a number from 0 to 200, got 'lots'
 */
#ifndef VIRGA_IO_SCENE_FILE_H
#define VIRGA_IO_SCENE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SCENE_FILE_VERSION       1   /* the value of the key `virga` */
#define SCENE_FILE_MAX_LIGHTS    16  /* as many as rain takes */
#define SCENE_FILE_MAX_PANES     16  /* as many as the library's scene takes */
#define SCENE_FILE_MAX_WIPERS    8   /* of a pane, as many as the library takes */
#define SCENE_FILE_MAX_MATERIALS 255 /* of a material map, whose pixels are bytes; 255 is none of them */

typedef struct scene_mesh {
    char *file;             /* as it can be opened: joined with the scene file's folder */
    double position_m[3];
    double rotation_deg[3]; /* about the world's X, then Y, then Z axis */
    double scale;
} scene_mesh;

typedef struct scene_environment {
    char *file;          /* a panorama, as it can be opened; NULL: a sky is made from the colours */
    double intensity;
    double rotation_deg; /* around +Y, counter-clockwise seen from above */
    double zenith[3], horizon[3], ground[3];
} scene_environment;

typedef enum scene_light_type { SCENE_LIGHT_POINT, SCENE_LIGHT_SPOT } scene_light_type;

typedef struct scene_light {
    uint32_t type; /* scene_light_type */
    double position_m[3];
    double color[3];
    double intensity_w_sr;       /* times color */
    double range_m;              /* 0: no end */
    double direction[3];         /* (spot) not all zero */
    double inner_deg, outer_deg; /* (spot) angles from the axis: full light inside the first, none outside the second */
} scene_light;

typedef struct scene_camera_key {
    double time_s;
    double position_m[3];
    double look_at_m[3];
    double roll_deg;
    bool cut; /* a new shot begins here */
} scene_camera_key;

typedef struct scene_camera {
    double fov_deg; /* of the picture's height */
    double near_m, far_m;
    double aperture_mm, focus_m; /* of rain's streaks; 0: all is sharp, and sharp at infinity */
    scene_camera_key *keys; /* at least 1, by rising time */
    uint32_t key_count;
} scene_camera;

typedef struct scene_frames {
    double fps;
    uint32_t first, last; /* frame `first` is at time 0 */
    double shutter_deg;
    uint32_t size[2];
    double preroll_s; /* it rains for so long before the first frame, in whole frames */
} scene_frames;

typedef struct scene_preview {
    double exposure_ev;
} scene_preview;

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

typedef struct scene_rain {
    double rate_mm_h;
    uint32_t sizes;          /* scene_sizes */
    scene_size_entry *table; /* by rising diameter; at least 2 if sizes is SCENE_SIZES_TABLE */
    uint32_t table_count;
    double air_density;
    double wind_m_s[3];
    double gust_m_s, gust_time_s;
    double transition_s;
    uint32_t max_drops;
    double range_m;
    uint32_t seed;
    double streak_gain, light_gain, min_width_px, soft_m, near_m, oscillation, haze, haze_sky_m, glow, bodies_min_mm;
    uint32_t occlusion_size, occlusion_cascades, occlusion_slants, occlusion_turns;
    scene_rain_key *keys; /* by rising time; linear between them, constant outside; none: rate and wind as above */
    uint32_t key_count;
} scene_rain;

typedef struct scene_ground_rule {
    char *match;       /* in the name of a mesh or its material, in any case */
    char *material;    /* as asphalt, concrete, ... */
    bool walkable;     /* false: no cells on it */
} scene_ground_rule;

/* A picture of materials, over those of meshes. */
typedef struct scene_material_map {
    char *file;                 /* a PNG of numbers (see png_read_numbers), as it can be opened; NULL: no map */
    double low_m[2], high_m[2]; /* corners in x and z: its first pixel lies at low_m, its rows go along x */
    char **materials;           /* by number; pixels of others leave the mesh's material */
    uint32_t material_count;
} scene_material_map;

typedef struct scene_ground {
    bool on;
    uint32_t cells;
    double cell_m;
    uint32_t kept_tiles;
    uint32_t far_cells;
    double evaporation_mm_h;
    double start_wetness, start_water_mm;
    scene_ground_rule *materials; /* the first that matches counts; none: words in names decide */
    uint32_t material_count;
    scene_material_map material_map;
} scene_ground;

typedef enum scene_splash_mode { SCENE_SPLASH_MODE_PAPER, SCENE_SPLASH_MODE_PHYSICAL } scene_splash_mode;
typedef enum scene_splash_style { SCENE_SPLASH_STYLE_PAPER, SCENE_SPLASH_STYLE_FILM } scene_splash_style;

typedef struct scene_splash {
    bool on;        /* only where the ground is on too */
    uint32_t mode;  /* scene_splash_mode */
    uint32_t style; /* scene_splash_style */
    uint32_t max_splashes, max_droplets;
    double droplets_m;
    double bounce;
    double pile_s, pile_m;
    double dot_mm;
    double gain, light_gain, min_width_px, soft_m, near_m;
} scene_splash;

/* Words of panes are numbers of the library: virga/glass.h says what each means. */
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
    double low_deg, high_deg, blade_deg, blade_turn;
    uint32_t drive; /* scene_wiper_drive */
    double sweep_s, pause_s, phase_s;
    double film_mm, wear;
    scene_wiper_key *keys; /* (keys) by rising time; linear between them, constant outside; at least 1 */
    uint32_t key_count;
    bool drawn; /* arm and blade are seen */
} scene_wiper;

/* A height map of the surface. */
typedef struct scene_bumps {
    char *file;        /* a PNG of numbers (see png_read_numbers), as it can be opened; NULL: smooth */
    double size_mm[2]; /* that the picture covers, along and up; repeated */
    double depth_mm;   /* of black under white */
    double pull;
} scene_bumps;

/* Drops on a pane. Numbers behind a pointer are NULL where `kind` has them. */
typedef struct scene_pane {
    char *name;
    uint32_t shape;         /* scene_pane_shape */
    double width_m, height_m;
    double rake_deg, bend_m; /* (windshield) */
    char *mesh;             /* (mesh) in the name of a mesh or its material, in any case */
    char *mask;             /* a PNG, black where there is no glass, as it can be opened; NULL: glass everywhere */
    uint32_t follow;        /* scene_pane_follow: what place and angles are given in */
    double position_m[3];   /* of the middle of the lower edge (mesh: of the model's origin): in the world, or to the
                             * right of the camera, above it and ahead of it */
    double yaw_deg;         /* to the left seen from above; at 0 outside faces +Z, or ahead */
    double pitch_deg;       /* back */
    double roll_deg;        /* to the left seen from outside */
    uint32_t motion;        /* scene_pane_motion */
    double velocity_m_s[3], acceleration_m_s2[3], turn_deg_s[3]; /* (given) in the frame of position_m */
    double shelter;
    double frame_m;         /* width of a dark frame around it; 0: none */
    uint32_t kind;          /* virga_glass_kind */
    double *advancing_deg, *receding_deg, *run_hold, *affinity, *film_um, *tail_mm;
    bool *opaque;           /* NULL: metal and leaves are */
    double drag, meander, path_ease, path_s, touch;
    double tail_m, tail_s, film_break_s, evaporation_mm_h, mist_mm, air_share;
    scene_wiper *wipers;
    uint32_t wiper_count;
    double particle_mm, penalty, band, hold_back_mm;
    uint32_t hold_back_cells;
    uint32_t density, blend; /* virga_glass_density, virga_glass_blend */
    bool compress;
    double compress_from, compress_step, compress_k;
    uint32_t compress_steps;
    double threshold, impact_s;
    uint32_t style; /* virga_glass_style */
    double paper_shift, thickness_mm, tint[3], gain;
    double cell_m, affinity_m;
    uint32_t max_drops, max_texels;
    scene_bumps bumps;
} scene_pane;

typedef struct scene_file {
    uint32_t version;
    scene_mesh *meshes;
    uint32_t mesh_count;
    scene_environment environment;
    scene_light *lights;
    uint32_t light_count;
    scene_camera camera;
    scene_frames frames;
    scene_preview preview;
    scene_rain rain;
    scene_ground ground;
    scene_splash splash;
    scene_pane *panes; /* the key `glass`, far ones first */
    uint32_t pane_count;
    uint64_t hash;                 /* see scene_file_hash */
    struct scene_document *source; /* for scene_file_refuse */
} scene_file;

/* Loads and checks a scene. `overrides` are texts like "rain.rate_mm_h=50", "frames.size=[640, 360]" or
 * "lights.0.range_m=20", applied in order before the check; the index after a list's last adds an entry.
 * On failure *scene is NULL and `error` has one line. */
bool scene_file_load(const char *path, const char *const *overrides, size_t override_count, scene_file **scene,
                     char *error, size_t error_size);

/* Accepts NULL. */
void scene_file_free(scene_file *scene);

/* Writes one line about the value of a key ("ground.materials.0.material") that only those can judge who use it, as
 * scene_file_load would: with file and line, or with the override that brought it. Returns false. */
bool scene_file_refuse(const scene_file *scene, const char *key, char *error, size_t error_size, const char *format,
                       ...) __attribute__((format(printf, 5, 6)));

/* 64-bit FNV-1a of the file's bytes, the overrides and the bytes of the meshes, the environment, the material map
 * and the pictures of panes that it names: the same for the same scene anywhere, another one where any of them was
 * changed. Included files of a mesh (textures beside it) do not count. */
uint64_t scene_file_hash(const scene_file *scene);

/* The words that a file has for them. */
const char *scene_splash_mode_name(uint32_t mode);
const char *scene_splash_style_name(uint32_t style);
const char *scene_pane_shape_name(uint32_t shape);
const char *scene_pane_kind_name(uint32_t kind);
const char *scene_pane_style_name(uint32_t style);

/* Rate and wind at a time, from the rain's keys or without them. */
void scene_file_weather(const scene_file *scene, double time_s, double *rate_mm_h, double wind_m_s[3]);

/* Angle of a wiper that is driven by keys. */
double scene_file_wiper_deg(const scene_wiper *wiper, double time_s);

#endif
