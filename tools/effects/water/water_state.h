/* water_state.h - the state of water in the program, for the files of this folder. */
#ifndef VIRGA_EFFECTS_WATER_STATE_H
#define VIRGA_EFFECTS_WATER_STATE_H

#include "effect.h"
#include "particle_sequence.h"
#include "water.h"

/* A body in simulated water. */
typedef struct water_body {
    const scene_body *from; /* NULL: a mesh of the scene, which stands still */
    host_mesh mesh;         /* no vertices: it is not drawn, or not by this effect */
    host_vertex *vertices;  /* around its origin */
    uint32_t *indices;
    uint32_t vertex_count, index_count;
    double low[3], high[3];                  /* bounds of these */
    host_buffer sheltering;                  /* its vertices on the device, around its origin */
    uint32_t first_occluder, occluder_count; /* of the shot's; 0: rain does not see it */
    virga_fluid_pose known;                  /* (the water moves it) before the newest step */
    double known_s;                          /* at this time */
} water_body;

#define WATER_TIMES 16 /* frames whose times are known; more than are in flight */

/* Water that is simulated: particles and their two newest states on the host, for sub-frames and statistics. */
typedef struct water_solver {
    virga_fluid *fluid; /* NULL: particles are of files */
    /* virga_particle_gpu, then virga_fluid_body_gpu; after the last step but one and after the last. */
    host_buffer before, now;
    VkDeviceSize bodies_at; /* where the bodies begin in them */
    water_body bodies[SCENE_SOLVER_MAX_BODIES];
    uint32_t body_count;
    double frame_s[WATER_TIMES]; /* times of the newest frames, by device frame */
    double before_s, now_s;      /* their times, as frame_s */
    uint32_t count;              /* particles after the newest step */
    uint64_t step_frame;         /* device frame of the newest step */
    shot_read densities;         /* of particles, for statistics */
} water_solver;

/* What the files say of the simulation, in metres. */
typedef struct water_source {
    particle_sequence *sequence;
    uint32_t most;       /* particles of the fullest of the files that were read */
    uint32_t most_cells; /* (solver) of its grid */
    double extent_m[3];  /* of the box around the particles of these files */
    double spacing_m;
    bool has_ids, has_velocity;
} water_source;

typedef struct water_state {
    virga_water *water; /* NULL: none */
    water_source source;
    water_solver solver;
    uint32_t max_particles;          /* for which there is room */
    host_buffer particles;           /* HOST_FRAMES parts of max_particles */
    double frame_s, time_s;          /* of the files, in the newest frame of the shot and in the newest step */
    uint32_t count;                  /* of the newest step */
    const virga_particle_gpu *given; /* them; those of a solver once it has been waited for */
    uint64_t step_frame;             /* device frame of the newest step */
    shot_read surfels, droplets, foam;
    /* The particles of the newest step, for views. */
    VkBuffer shown;
    VkDeviceSize shown_offset;
    uint32_t shown_count;
} water_state;

#define WATER_VIEWS 3
extern const tool_view water_views[WATER_VIEWS];

/* Opens the files of a scene. Reports errors by scene_file_refuse. */
bool water_open_sequence(const scene_file *scene, particle_sequence **sequence, char *error, size_t error_size);

/* Opens them, and reads the first, the middle and the last one. Tells on standard error what was guessed, what does not
 * fit to the volume of particles, and how many are left out. */
bool water_open_source(const scene_file *scene, water_source *source, char *error, size_t error_size);

/* Whether the particles of two files are there at once, as they have no ids. */
bool water_mixes_files(const scene_file *scene, const water_source *source);

/* Particles at one time for which water has no room, going by the files that were read. */
uint32_t water_left_out(const scene_file *scene, const water_source *source);

/* Fills the particles of a step at a time of the files. */
bool water_fill_particles(shot *s, water_state *state, double time_s, virga_water_step_info *info, char *error,
                          size_t error_size);

/* ---- the solver */

extern const scene_group water_solver_group;

/* Whether a scene has one. */
bool water_is_solved(const scene_file *scene);

/* Checks what ranges of single values can not express. */
bool water_check_solver(const scene_file *scene, char *error, size_t error_size);

/* Particles of a box along an axis, as the library counts them. */
double water_box_particles(const scene_solver *from, const scene_solver_box *box);

/* What the scene says of the simulation. */
void water_describe_solver(const scene_file *scene, water_source *source);

/* Lets its walls make foam. */
void water_foam_walls(const scene_file *scene, virga_water_settings *settings);

bool water_open_solver(shot *s, water_state *state, char *error, size_t error_size);
void water_close_solver(shot *s, water_state *state);

/* Moves the water on to a time by `dt_s`. */
bool water_step_solver(shot *s, water_state *state, VkCommandBuffer cmd, double frame_s, double dt_s, char *error,
                       size_t error_size);

/* Records the copy of what statistics need, after the step of the simulation. */
bool water_read_solver(shot *s, water_state *state, VkCommandBuffer cmd, char *error, size_t error_size);

/* The state of the solver, for checkpoints. After a load the newest step is that of the state. */
bool water_save_solver(shot *s, const water_state *state, VkCommandBuffer cmd, const virga_state_range *to, char *error,
                       size_t error_size);
bool water_load_solver(shot *s, water_state *state, VkCommandBuffer cmd, const virga_state_source *from, double frame_s,
                       char *error, size_t error_size);

/* Fills the particles of a step at a time within the newest step of the solver. */
bool water_fill_solved(shot *s, water_state *state, double time_s, virga_water_step_info *info, char *error,
                       size_t error_size);

/* Copies them at state->time_s, to solver.count particles. */
bool water_copy_solved(shot *s, water_state *state, virga_particle_gpu *particles, char *error, size_t error_size);

/* Waits for the newest step, and makes its states readable. */
bool water_wait_for_solver(shot *s, const water_solver *solver, char *error, size_t error_size);

void water_write_solver_stats(shot *s, water_state *state, jsonl *stats);

/* ---- bodies in it */

/* Loads their meshes, before the solver is created. */
bool water_open_bodies(shot *s, water_state *state, char *error, size_t error_size);
void water_close_bodies(shot *s, water_state *state);

/* What the solver needs for them. */
void water_size_bodies(const shot *s, const water_state *state, virga_fluid_def *def);

/* Puts them into the solver. */
bool water_add_bodies(shot *s, water_state *state, char *error, size_t error_size);

/* Leads those that have keys to a time of the scene. */
bool water_drive_bodies(shot *s, water_state *state, double time_s, char *error, size_t error_size);

/* Moves what is drawn of them to a time of the scene. */
bool water_draw_bodies(shot *s, water_state *state, VkCommandBuffer cmd, double time_s, char *error, size_t error_size);

/* Corners (x, z) of what is around those that have keys, at a time of the scene. All 0: there are none. */
void water_body_region(const water_state *state, double time_s, double margin_m, float low_m[2], float high_m[2]);

/* Lets rain hit them: adds them to the shot's occluders, once, and moves them there to a time of the scene. Those that
 * the water moves go on there as the last step left them, which water_note_bodies finds out before the next step is
 * recorded. It waits for the device, except in a live shot. */
bool water_add_occluders(shot *s, water_state *state, char *error, size_t error_size);
bool water_note_bodies(shot *s, water_state *state, double frame_s, char *error, size_t error_size);
void water_move_occluders(shot *s, const water_state *state, double time_s);

void water_write_body_stats(const water_state *state, jsonl *stats);

/* ---- */

/* The newest statistics, if they are those of the newest step. */
bool water_step_stats(shot *s, const water_state *state, virga_water_stats *stats);

/* Litres of some particles. */
double water_volume_l(const scene_water *from, const water_source *source, const virga_particle_gpu *particles,
                      uint32_t count);

/* The particles of the newest step once more, needs free(). NULL: see `error`. */
virga_particle_gpu *water_copy_particles(shot *s, water_state *state, uint32_t *count, char *error, size_t error_size);

extern const tool_points water_points, water_spray_points, water_foam_points, water_particle_points;
extern const tool_mesh water_surface_mesh;
extern const tool_volume water_density_volume;

/* Adds up the particles of the newest step on a grid. False: see `error`. */
struct field;
bool water_make_field(shot *s, water_state *state, struct field *made, char *error, size_t error_size);

#endif
