/* solver_keys.c - keys of water.solver in scene files, and what one value alone does not show. */
#include "water_state.h"

#include "ground.h"
#include "scene_rows.h"

#include <math.h>
#include <stdio.h>

#define MAX_SOLVER_M  10000.0 /* of positions, as in virga/fluid.h */
#define MAX_PARTICLES 2097152
#define MAX_CELLS     16777216
#define MIN_SPACINGS  4 /* of a side of the box */

/* Ranges and defaults of what the library has are its own: virga/fluid.h. */
static const scene_row wall_rows[] = {
    NUMBER(scene_solver_walls, low_m, -MAX_SOLVER_M, MAX_SOLVER_M, "[-0.5, 0, -0.5]", RESTARTS,
           "lower corner of the box that the water is in; walls let water slide"),
    NUMBER(scene_solver_walls, high_m, -MAX_SOLVER_M, MAX_SOLVER_M, "[0.5, 1, 0.5]", RESTARTS, "its upper corner"),
};
static const scene_group wall_group = SCENE_GROUP(scene_solver_walls, wall_rows);

static const scene_row box_rows[] = {
    NUMBER(scene_solver_box, low_m, -MAX_SOLVER_M, MAX_SOLVER_M, NULL, RESTARTS, "lower corner of water at the start"),
    NUMBER(scene_solver_box, high_m, -MAX_SOLVER_M, MAX_SOLVER_M, NULL, RESTARTS,
           "upper corner; sides are rounded to whole spacings"),
    NUMBER(scene_solver_box, velocity_m_s, -1000, 1000, "[0, 0, 0]", RESTARTS, "of this water at the start"),
};
static const scene_group box_group = SCENE_GROUP(scene_solver_box, box_rows);

static const scene_row body_key_rows[] = {
    NUMBER(scene_body_key, time_s, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "when the body is there"),
    NUMBER(scene_body_key, position_m, -MAX_SOLVER_M, MAX_SOLVER_M, NULL, RESTARTS, "of its origin then"),
    NUMBER(scene_body_key, rotation_deg, -3600000, 3600000, "[0, 0, 0]", RESTARTS,
           "about the X, then Y, then Z axis; whole turns count"),
};
static const scene_group body_key_group = SCENE_GROUP(scene_body_key, body_key_rows);

static const scene_row body_rows[] = {
    TEXT(scene_body, name, 40, "body", RESTARTS, "of the body, in statistics"),
    FILE_NAME(scene_body, file, OPTIONAL, "a model without holes; else box_m"),
    NUMBER(scene_body, box_m, 0, MAX_SOLVER_M, "[0, 0, 0]", RESTARTS, "sides of a box around its origin; else file"),
    NUMBER(scene_body, scale, 0.000001, 1000000, "1", RESTARTS, "of the model (file)"),
    NUMBER(scene_body, density, 0, 100, "0", RESTARTS,
           "over that of water, at least 0.05; the water moves it. 0: it moves by keys, or stands still"),
    NUMBER(scene_body, friction, 0, 10, "0.4", RESTARTS, "on the walls (density)"),
    NUMBER(scene_body, position_m, -MAX_SOLVER_M, MAX_SOLVER_M, "[0, 0, 0]", RESTARTS, "of its origin at the start"),
    NUMBER(scene_body, rotation_deg, -36000, 36000, "[0, 0, 0]", RESTARTS, "about the X, then Y, then Z axis"),
    NUMBER(scene_body, velocity_m_s, -1000, 1000, "[0, 0, 0]", RESTARTS, "at the start (density)"),
    NUMBER(scene_body, spin_deg_s, -5700, 5700, "[0, 0, 0]", RESTARTS, "at the start (density)"),
    LIST(scene_body, keys, key_count, &body_key_group, 0, 100000, "[]", "places by time, with lines in between"),
    SWITCH(scene_body, drawn, "true", RESTARTS, "it is seen"),
    NUMBER(scene_body, color, 0, 1, "[0.6, 0.3, 0.15]", RESTARTS, "linear (box)"),
    NUMBER(scene_body, roughness, 0, 1, "0.5", RESTARTS, "of its surface (box)"),
};
static const scene_group body_group = SCENE_GROUP(scene_body, body_rows);

static const scene_row exchange_rows[] = {
    WHOLE(scene_exchange, max_particles, 1, 1048576, "16384", RESTARTS, "that water of the ground can be at once"),
    NUMBER(scene_exchange, margin_m, 0, 100, "0.1", LIVE,
           "around bodies with keys: there water of the ground becomes particles"),
    SWITCH(scene_exchange, open_sides, "false", LIVE,
           "particles near a wall go to the ground, as if there were no walls"),
    NUMBER(scene_exchange, rest_speed_m_s, 0, 10, "0.1", LIVE, "particles that are slower for rest_s go to the ground"),
    NUMBER(scene_exchange, film_speed_m_s, 0, 10, "0.5", LIVE, "the same of those with few others around them"),
    NUMBER(scene_exchange, rest_s, 0, 60, "0.25", LIVE, "how long"),
    NUMBER(scene_exchange, rest_height_m, 0, 100, "0.05", LIVE, "and lower than this over the floor of the walls"),
};
static const scene_group exchange_group = SCENE_GROUP(scene_exchange, exchange_rows);

static const scene_row solver_rows[] = {
    NUMBER(scene_solver, spacing_m, 0.0001, 10, "0.02", RESTARTS,
           "distance of particles at rest; half of it: eight times as many, and twice the substeps"),
    GROUP(scene_solver, walls, &wall_group, RESTARTS, "the container, relative to water.position_m as all below"),
    LIST(scene_solver, boxes, box_count, &box_group, 0, SCENE_SOLVER_MAX_BOXES, "[]", "water at the start"),
    TEXT_LIST(scene_solver, meshes, mesh_count, 200, 0, SCENE_SOLVER_MAX_BODIES, "[]",
              "what of the scene stands in the water: in the names of meshes or materials without holes"),
    LIST(scene_solver, bodies, body_count, &body_group, 0, SCENE_SOLVER_MAX_BODIES, "[]",
         "what moves in the water, by the water or by keys"),
    OPTIONAL_GROUP(scene_solver, exchange, &exchange_group, RESTARTS,
                   "water of the ground becomes particles around bodies with keys, and is water of the ground at rest"),
    NUMBER(scene_solver, gravity_m_s2, -1000, 1000, "[0, -9.81, 0]", LIVE,
           "acceleration; for a container that moves: of gravity less its own"),
    NUMBER(scene_solver, viscosity_m2_s, 0, 10, "0.001", LIVE,
           "kinematic; that of water, 1e-6, is less than particles show; more is calmer"),
    NUMBER(scene_solver, cfl, 0.05, 1, "0.4", LIVE, "how far a particle may move in a substep, in spacings"),
    NUMBER(scene_solver, solver_error, 0.000001, 0.01, "0.0001", LIVE,
           "mean error of the density at which iterations end"),
    WHOLE(scene_solver, max_substeps, 1, 64, "32", RESTARTS,
          "of a frame; each takes 0.5 ms on two cores even if it is not needed"),
    WHOLE(scene_solver, max_iterations, 1, 100, "20", RESTARTS, "of the solver in a substep"),
};
const scene_group water_solver_group = SCENE_GROUP(scene_solver, solver_rows);

bool water_is_solved(const scene_file *scene)
{
    return scene_water_of(scene)->solver.spacing_m > 0;
}

/* ---- sizes */

double water_box_particles(const scene_solver *from, const scene_solver_box *box)
{
    double count = 1;
    for (int axis = 0; axis < 3; axis++)
        count *= floor((box->high_m[axis] - box->low_m[axis]) / from->spacing_m + 0.5);
    return count;
}

static double count_particles(const scene_solver *from)
{
    double count = from->exchange.max_particles;
    for (uint32_t i = 0; i < from->box_count; i++)
        count += water_box_particles(from, &from->boxes[i]);
    return count;
}

/* Of the neighbour grid: a cell is two spacings wide, and there are four more than the box has. */
static double count_cells(const scene_solver *from)
{
    double cells = 1;
    for (int axis = 0; axis < 3; axis++)
        cells *= floor((from->walls.high_m[axis] - from->walls.low_m[axis]) / (2 * from->spacing_m)) + 6;
    return cells;
}

void water_describe_solver(const scene_file *scene, water_source *source)
{
    const scene_solver *from = &scene_water_of(scene)->solver;
    *source = (water_source){.most = (uint32_t)count_particles(from),
                             .most_cells = (uint32_t)fmin(fmax(count_cells(from), 4096), MAX_CELLS),
                             .spacing_m = from->spacing_m,
                             .has_ids = true,
                             .has_velocity = true};
    for (int axis = 0; axis < 3; axis++)
        source->extent_m[axis] = from->walls.high_m[axis] - from->walls.low_m[axis];
}

/* ---- checks */

static bool check_box(const scene_file *scene, uint32_t index, char *error, size_t error_size)
{
    const scene_solver *from = &scene_water_of(scene)->solver;
    const scene_solver_box *box = &from->boxes[index];
    char key[96];
    for (int axis = 0; axis < 3; axis++) {
        snprintf(key, sizeof key, "water.solver.boxes.%u.high_m", index);
        if (box->high_m[axis] - box->low_m[axis] < 0.5 * from->spacing_m)
            return scene_file_refuse(scene, key, error, error_size,
                                     "expected at least half a spacing (%g) above low_m (%g) along %c, got %g",
                                     0.5 * from->spacing_m, box->low_m[axis], "xyz"[axis], box -> high_m[axis]);
        if (box->high_m[axis] > from->walls.high_m[axis] + 1e-6)
            return scene_file_refuse(scene, key, error, error_size,
                                     "expected at most walls.high_m (%g) along %c, got %g", from->walls.high_m[axis],
                                     "xyz"[axis], box -> high_m[axis]);
        snprintf(key, sizeof key, "water.solver.boxes.%u.low_m", index);
        if (box->low_m[axis] < from->walls.low_m[axis] - 1e-6)
            return scene_file_refuse(scene, key, error, error_size,
                                     "expected at least walls.low_m (%g) along %c, got %g", from->walls.low_m[axis],
                                     "xyz"[axis], box -> low_m[axis]);
    }
    return true;
}

/* One line about a key of a body. */
#define REFUSE_BODY(key_name, ...)                                            \
    do {                                                                      \
        char key[96];                                                         \
        snprintf(key, sizeof key, "water.solver.bodies.%u." key_name, index); \
        return scene_file_refuse(scene, key, error, error_size, __VA_ARGS__); \
    } while (0)

static bool is_zero(const double v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

static bool check_motion(const scene_file *scene, uint32_t index, char *error, size_t error_size)
{
    const scene_body *body = &scene_water_of(scene)->solver.bodies[index];
    if (body->density > 0 && body->key_count)
        REFUSE_BODY("keys", "expected none, as density is above 0");
    if (!(body->density > 0) && !is_zero(body->velocity_m_s))
        REFUSE_BODY("velocity_m_s", "expected [0, 0, 0], as density is 0");
    if (!(body->density > 0) && !is_zero(body->spin_deg_s))
        REFUSE_BODY("spin_deg_s", "expected [0, 0, 0], as density is 0");
    for (uint32_t i = 1; i < body->key_count; i++)
        if (body->keys[i].time_s <= body->keys[i - 1].time_s)
            REFUSE_BODY("keys", "expected rising times, got %g after %g", body->keys[i].time_s,
                        body->keys[i - 1].time_s);
    return true;
}

static bool check_body(const scene_file *scene, uint32_t index, char *error, size_t error_size)
{
    const scene_solver *from = &scene_water_of(scene)->solver;
    const scene_body *body = &from->bodies[index];
    if (body->file && !is_zero(body->box_m))
        REFUSE_BODY("box_m", "expected none, as file is there");
    for (int axis = 0; axis < 3; axis++)
        if (!body->file && body->box_m[axis] < from->spacing_m)
            REFUSE_BODY("box_m", "expected sides of at least spacing_m (%g), or file beside it; got %g along %c",
                        from->spacing_m, body->box_m[axis], "xyz"[axis]);
    if (body->density > 0 && body->density < 0.05)
        REFUSE_BODY("density", "expected 0, or 0.05 to 100, got %g", body->density);
    return check_motion(scene, index, error, error_size);
}

static bool check_bodies(const scene_file *scene, char *error, size_t error_size)
{
    const scene_solver *from = &scene_water_of(scene)->solver;
    if (from->body_count + from->mesh_count > SCENE_SOLVER_MAX_BODIES)
        return scene_file_refuse(scene, "water.solver.bodies", error, error_size,
                                 "expected at most %d with the %u meshes, got %u", SCENE_SOLVER_MAX_BODIES,
                                 from->mesh_count, from->body_count);
    for (uint32_t i = 0; i < from->body_count; i++)
        if (!check_body(scene, i, error, error_size))
            return false;
    return true;
}

static bool check_walls(const scene_file *scene, char *error, size_t error_size)
{
    const scene_solver *from = &scene_water_of(scene)->solver;
    for (int axis = 0; axis < 3; axis++)
        if (from->walls.high_m[axis] - from->walls.low_m[axis] < MIN_SPACINGS * from->spacing_m)
            return scene_file_refuse(scene, "water.solver.walls.high_m", error, error_size,
                                     "expected at least %d spacings (%g) above low_m (%g) along %c, got %g",
                                     MIN_SPACINGS, MIN_SPACINGS * from->spacing_m, from->walls.low_m[axis], "xyz"[axis],
                                     from -> walls.high_m[axis]);
    return count_cells(from) <= MAX_CELLS ||
           scene_file_refuse(scene, "water.solver.spacing_m", error, error_size,
                             "expected a spacing with which the walls have at most %d cells of two spacings, got "
                             "%.0f",
                             MAX_CELLS, count_cells(from));
}

/* What describes files has no meaning for a solver. */
static bool check_beside(const scene_file *scene, char *error, size_t error_size)
{
    const scene_water *from = scene_water_of(scene);
    if (from->files)
        return scene_file_refuse(scene, "water.solver", error, error_size, "expected none, as files is there");
    if (from->rotation_deg[0] != 0 || from->rotation_deg[1] != 0 || from->rotation_deg[2] != 0)
        return scene_file_refuse(scene, "water.rotation_deg", error, error_size,
                                 "expected [0, 0, 0], as solver is there");
    if (from->spacing_m > 0)
        return scene_file_refuse(scene, "water.spacing_m", error, error_size,
                                 "expected 0, as solver.spacing_m is there, got %g", from->spacing_m);
    return true;
}

#define MAX_EXCHANGED_M 0.1 /* as in virga/fluid.h */

static bool check_exchange(const scene_file *scene, char *error, size_t error_size)
{
    const scene_solver *from = &scene_water_of(scene)->solver;
    if (!from->exchange.max_particles)
        return true;
    if (!scene_ground_of(scene)->on)
        return scene_file_refuse(scene, "water.solver.exchange", error, error_size, "expected ground.on beside it");
    return from->spacing_m <= MAX_EXCHANGED_M ||
           scene_file_refuse(scene, "water.solver.spacing_m", error, error_size,
                             "expected at most %g with exchange, got %g", MAX_EXCHANGED_M, from->spacing_m);
}

bool water_check_solver(const scene_file *scene, char *error, size_t error_size)
{
    const scene_solver *from = &scene_water_of(scene)->solver;
    if (!water_is_solved(scene))
        return true;
    if (!check_beside(scene, error, error_size) || !check_walls(scene, error, error_size) ||
        !check_bodies(scene, error, error_size) || !check_exchange(scene, error, error_size))
        return false;
    for (uint32_t i = 0; i < from->box_count; i++)
        if (!check_box(scene, i, error, error_size))
            return false;
    const double count = count_particles(from);
    return (count >= 1 && count <= MAX_PARTICLES) ||
           scene_file_refuse(scene, "water.solver.boxes", error, error_size,
                             "expected water of 1 to %d particles, got %.0f", MAX_PARTICLES, count);
}
