/* water.h - declares the settings of water from simulated particles in a scene file. */
#ifndef VIRGA_EFFECTS_WATER_H
#define VIRGA_EFFECTS_WATER_H

#include "scene_file.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Range of virga_water_def.max_particles. Devices with small storage buffers have room for fewer. */
#define WATER_MIN_PARTICLES 64u
#define WATER_MAX_PARTICLES 8388608u

typedef enum scene_water_ids { SCENE_WATER_IDS_FILE, SCENE_WATER_IDS_ROWS, SCENE_WATER_IDS_NONE } scene_water_ids;
typedef enum scene_water_up { SCENE_WATER_UP_Y, SCENE_WATER_UP_Z } scene_water_up;

typedef enum scene_water_style { SCENE_WATER_STYLE_PAPER, SCENE_WATER_STYLE_PHYSICAL } scene_water_style;
typedef enum scene_water_shading { SCENE_WATER_SHADING_PIXELS, SCENE_WATER_SHADING_SURFELS } scene_water_shading;

typedef enum scene_water_kernel { SCENE_WATER_KERNEL_ISOTROPIC, SCENE_WATER_KERNEL_ANISOTROPIC } scene_water_kernel;

/* Water that the program simulates, see virga/fluid.h. All positions are relative to scene_water.position_m. */
typedef struct scene_solver_box {
    double low_m[3], high_m[3], velocity_m_s[3];
} scene_solver_box;

typedef struct scene_solver_walls {
    double low_m[3], high_m[3];
} scene_solver_walls;

typedef struct scene_body_key {
    double time_s, position_m[3], rotation_deg[3];
} scene_body_key;

/* A body in the water: a box, or a closed mesh. */
typedef struct scene_body {
    char *name;
    char *file;      /* path of a model; NULL: a box */
    double box_m[3]; /* sides of the box, with the origin in its middle; all 0: a file */
    double scale;    /* (file) */
    double density;  /* over that of water; 0: it moves by its keys */
    double friction; /* (density) on the walls */
    double position_m[3], rotation_deg[3];
    double velocity_m_s[3], spin_deg_s[3]; /* (density) at the start */
    scene_body_key *keys;                  /* (no density) in order of time; none: it stands still */
    uint32_t key_count;
    bool drawn;
    double color[3], roughness; /* (box) */
} scene_body;

#define SCENE_SOLVER_MAX_BODIES 8 /* the max of the library, meshes among them */

#define SCENE_SOLVER_MAX_BOXES 16 /* the max of the library between two steps */

/* Water that comes from the cells of the ground, and goes back to them. */
typedef struct scene_exchange {
    uint32_t max_particles; /* 0: none */
    double margin_m;
    bool open_sides;
    double rest_speed_m_s, film_speed_m_s, rest_s, rest_height_m;
} scene_exchange;

typedef struct scene_solver {
    double spacing_m; /* 0: there is no solver */
    scene_solver_walls walls;
    scene_solver_box *boxes;
    uint32_t box_count;
    char **meshes; /* names of what stands in the water */
    uint32_t mesh_count;
    scene_body *bodies;
    uint32_t body_count;
    scene_exchange exchange;
    double gravity_m_s2[3];
    double viscosity_m2_s, cfl, solver_error;
    uint32_t max_substeps, max_iterations;
} scene_solver;

typedef struct scene_water {
    char *files; /* NULL: no files */
    scene_solver solver;
    double rate_hz;
    uint32_t step;
    double *first; /* NULL: the smallest number */
    double start_s, fade_s;
    uint32_t ids, up; /* scene_water_ids, scene_water_up */
    double unit_m;
    double position_m[3], rotation_deg[3];
    double spacing_m; /* 0: guessed */
    double volume;    /* in spacing_m^3 */
    double kernel_spacings, level;
    uint32_t kernel; /* scene_water_kernel */
    double smoothing, stretch;
    uint32_t style, shading; /* scene_water_style, scene_water_shading */
    double surfel_difference;
    uint32_t surfel_divisions, max_parts;
    double spray_density, spray_speed_m_s, spray_pattern;
    bool hand_over;
    double hand_over_s;
    uint32_t spray_pieces;
    double foam_air_hz, foam_crest_hz;
    double foam_speed_m_s[2], foam_air_m_s[2], foam_crest[2], foam_life_s[2];
    double foam_radius_m, foam_rise_m_s, foam_drag_hz, foam_coverage;
    uint32_t max_foam;
    double absorption_1_m[3], scattering_1_m[3];
    double reflection, refraction, surfel_radius, soft_m, light_gain;
    bool contact;
    uint32_t max_particles, max_cells, max_blocks, max_surfels; /* 0: by the particles */
} scene_water;

/* The water of a scene. */
scene_water *scene_water_of(const scene_file *scene);

#ifdef __cplusplus
}
#endif
#endif
