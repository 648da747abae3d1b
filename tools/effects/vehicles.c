/* vehicles.c - the section `vehicles`: models that drive or walk along a path. They are drawn, keep rain off, and their
 * wheels and feet throw the water of the ground. */
#include "vehicles.h"

#include "effect.h"
#include "materials.h"
#include "scene_rows.h"
#include "splash/drips.h"
#include "vehicles/walk.h"
#include "water/body_pose.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

static const scene_row key_rows[] = {
    NUMBER(scene_body_key, time_s, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "when the vehicle is there"),
    NUMBER(scene_body_key, position_m, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "of its origin then"),
    NUMBER(scene_body_key, rotation_deg, -3600000, 3600000, "[0, 0, 0]", RESTARTS,
           "about the X, then Y, then Z axis; at 0 it drives along -z"),
};
static const scene_group key_group = SCENE_GROUP(scene_body_key, key_rows);

/* Ranges and defaults are the library's own: virga/contact.h. */
static const scene_row wheel_rows[] = {
    NUMBER(scene_wheel, contact_m, -100, 100, NULL, RESTARTS, "where it touches the ground, from the vehicle's origin"),
    NUMBER(scene_wheel, radius_m, 0.01, 3, "0.32", RESTARTS, "of the tire"),
    NUMBER(scene_wheel, width_m, 0.01, 2, "0.19", RESTARTS, "of the tread"),
    NUMBER(scene_wheel, patch_m, 0.01, 2, "0.12", RESTARTS, "length of the tread that touches the ground"),
    NUMBER(scene_wheel, open_deg, 0, 180, "35", RESTARTS, "angle behind it at which a mudguard begins; 180: none"),
};
static const scene_group wheel_group = SCENE_GROUP(scene_wheel, wheel_rows);

static const scene_row foot_rows[] = {
    NUMBER(scene_foot, sole_m, -100, 100, NULL, RESTARTS, "its middle when it stands, from the vehicle's origin"),
    NUMBER(scene_foot, lands, 0, 1, "0", RESTARTS, "at this part of a stride"),
    NUMBER(scene_foot, length_m, 0.01, 2, "0.28", RESTARTS, "of the sole"),
    NUMBER(scene_foot, width_m, 0.01, 2, "0.1", RESTARTS, "of the sole"),
};
static const scene_group foot_group = SCENE_GROUP(scene_foot, foot_rows);

static const scene_row lamp_rows[] = {
    NUMBER(scene_lamp, position_m, -100, 100, NULL, RESTARTS, "from the vehicle's origin"),
    NUMBER(scene_lamp, direction, -MAX_METERS, MAX_METERS, "[0, -0.05, -1]", RESTARTS,
           "where it points, of any length; -z is ahead"),
    NUMBER(scene_lamp, color, 0, 1e6, "[1, 1, 1]", RESTARTS, "linear red, green, blue, times the intensity"),
    NUMBER(scene_lamp, intensity_w_sr, 0, 1e9, NULL, RESTARTS,
           "radiant intensity on the axis, in the unit of the scene's radiance"),
    NUMBER(scene_lamp, range_m, 0, MAX_METERS, "0", RESTARTS, "its light ends here, faded smoothly; 0: no end"),
    NUMBER(scene_lamp, inner_deg, 0, 90, "6", RESTARTS, "full light inside this angle from the axis"),
    NUMBER(scene_lamp, outer_deg, 0, 90, "20", RESTARTS, "no light outside this angle"),
};
static const scene_group lamp_group = SCENE_GROUP(scene_lamp, lamp_rows);

static const scene_row vehicle_rows[] = {
    TEXT(scene_vehicle, name, 40, "vehicle", RESTARTS, "of the vehicle"),
    FILE_NAME(scene_vehicle, file, OPTIONAL, "its model, with its front at -z; else it is not seen"),
    OPTIONAL_TEXT(scene_vehicle, wheel_part, 40, RESTARTS,
                  "in the names of what is one wheel around the origin, its outer side at +x; drawn at each wheel"),
    TEXT_LIST(scene_vehicle, leave_out, leave_out_count, 40, 0, 32, "[]", "in the names of what is not drawn"),
    LIST(scene_vehicle, keys, key_count, &key_group, 1, 100000, NULL, "places by time, with lines in between"),
    LIST(scene_vehicle, wheels, wheel_count, &wheel_group, 0, SCENE_MAX_WHEELS, "[]", "that throw water"),
    OPTIONAL_TEXT(scene_vehicle, pose_part, 40, RESTARTS,
                  "in the names of poses of a stride, before their numbers from 0 on; all have the same triangles"),
    NUMBER(scene_vehicle, stride_m, 0.01, 100, "1.32", RESTARTS, "way of a stride, which is two steps"),
    LIST(scene_vehicle, feet, foot_count, &foot_group, 0, SCENE_MAX_FEET, "[]", "that tread down"),
    LIST(scene_vehicle, lamps, lamp_count, &lamp_group, 0, SCENE_MAX_LAMPS, "[]", "cones of light that go along"),
};
static const scene_group vehicle_group = SCENE_GROUP(scene_vehicle, vehicle_rows);

static const scene_row vehicles_section[] = {SECTION_LIST("vehicles", scene_vehicles, vehicles, vehicle_count,
                                                          &vehicle_group, SCENE_MAX_VEHICLES,
                                                          "what drives or walks through the scene")};

TOOL_SECTION_OF(vehicles)

/* Numbers of all vehicles. */
typedef struct vehicle_sums {
    uint32_t wheels, feet, lamps;
} vehicle_sums;

static vehicle_sums count_all(const scene_file *scene)
{
    const scene_vehicles *all = scene_vehicles_of(scene);
    vehicle_sums sums = {0};
    for (uint32_t i = 0; i < all->vehicle_count; i++) {
        sums.wheels += all->vehicles[i].wheel_count;
        sums.feet += all->vehicles[i].foot_count;
        sums.lamps += all->vehicles[i].lamp_count;
    }
    return sums;
}

static bool check_lamps(const scene_file *scene, uint32_t vehicle, char *error, size_t error_size)
{
    const scene_vehicle *v = &scene_vehicles_of(scene)->vehicles[vehicle];
    char key[64];
    for (uint32_t i = 0; i < v->lamp_count; i++) {
        const scene_lamp *lamp = &v->lamps[i];
        if (fabs(lamp->direction[0]) + fabs(lamp->direction[1]) + fabs(lamp->direction[2]) <= 0) {
            snprintf(key, sizeof key, "vehicles.%u.lamps.%u.direction", vehicle, i);
            return scene_file_refuse(scene, key, error, error_size, "expected a direction, got all zero");
        }
        if (lamp->outer_deg <= lamp->inner_deg) {
            snprintf(key, sizeof key, "vehicles.%u.lamps.%u.outer_deg", vehicle, i);
            return scene_file_refuse(scene, key, error, error_size, "expected more than inner_deg (%g), got %g",
                                     lamp->inner_deg, lamp->outer_deg);
        }
    }
    return true;
}

static bool check(const scene_file *scene, char *error, size_t error_size)
{
    const scene_vehicles *all = scene_vehicles_of(scene);
    char key[64];
    for (uint32_t i = 0; i < all->vehicle_count; i++) {
        const scene_vehicle *v = &all->vehicles[i];
        snprintf(key, sizeof key, "vehicles.%u.keys", i);
        for (uint32_t k = 1; k < v->key_count; k++)
            if (v->keys[k].time_s <= v->keys[k - 1].time_s)
                return scene_file_refuse(scene, key, error, error_size, "expected rising times, got %g after %g",
                                         v->keys[k].time_s, v->keys[k - 1].time_s);
        snprintf(key, sizeof key, "vehicles.%u.wheel_part", i);
        if (v->wheel_part && !v->file)
            return scene_file_refuse(scene, key, error, error_size, "expected file beside it");
        snprintf(key, sizeof key, "vehicles.%u.pose_part", i);
        if (v->pose_part && !v->file)
            return scene_file_refuse(scene, key, error, error_size, "expected file beside it");
        if (!check_lamps(scene, i, error, error_size))
            return false;
    }
    const vehicle_sums sums = count_all(scene);
    if (sums.wheels + sums.feet > VIRGA_GROUND_MAX_CONTACTS)
        return scene_file_refuse(scene, "vehicles", error, error_size, "expected at most %d wheels and feet, got %u",
                                 VIRGA_GROUND_MAX_CONTACTS, sums.wheels + sums.feet);
    if (sums.lamps && scene->light_count + sums.lamps > VIRGA_MAX_LIGHTS)
        return scene_file_refuse(scene, "vehicles", error, error_size,
                                 "expected at most %d lamps and lights of the scene, got %u", VIRGA_MAX_LIGHTS,
                                 scene->light_count + sums.lamps);
    return true;
}

static void print(const scene_file *scene)
{
    const scene_vehicles *all = scene_vehicles_of(scene);
    const vehicle_sums sums = count_all(scene);
    if (all->vehicle_count)
        printf("  vehicles     %u with %u wheels, %u feet and %u lamps\n", all->vehicle_count, sums.wheels, sums.feet,
               sums.lamps);
}

static bool is_used(const scene_file *scene)
{
    return scene_vehicles_of(scene)->vehicle_count > 0;
}

/* ---- life ----------------------------------------------------------------------------------------------------- */

/* A model or a part of it, as it is at rest around the origin. */
typedef struct part {
    host_mesh mesh;
    host_vertex *vertices;
    uint32_t *indices;
} part;

typedef struct vehicle {
    part body, wheels[SCENE_MAX_WHEELS];
    host_buffer sheltering; /* vertices at rest, for rain */
    uint32_t first_occluder, occluder_count;
    uint32_t first_drip, drip_count; /* places that drip */
    double top_m;                    /* of the body at rest, over its origin */
    walk_poses poses;
} vehicle;

typedef struct vehicles_state {
    vehicle vehicles[SCENE_MAX_VEHICLES];
    virga_wheel wheels[VIRGA_GROUND_MAX_CONTACTS]; /* of the frame */
    virga_foot feet[VIRGA_GROUND_MAX_CONTACTS];    /* likewise */
} vehicles_state;

static bool define(shot *s, void *state, virga_scene_def *def, char *error, size_t error_size)
{
    (void)state, (void)error, (void)error_size;
    const vehicle_sums sums = count_all(s->scene);
    def->with_contacts = def->with_splash && sums.wheels + sums.feet > 0;
    return true;
}

static bool has_name(const host_mesh *mesh, const host_primitive *primitive, const char *name)
{
    return host_name_contains(primitive->name, name) ||
           host_name_contains(mesh->materials[primitive->material].name, name);
}

/* Keeps what belongs to the body, or to a wheel. */
static void keep_part(const scene_vehicle *from, bool wheel, host_mesh *mesh)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const host_primitive *primitive = &mesh->primitives[i];
        bool keep = (from->wheel_part && has_name(mesh, primitive, from->wheel_part)) == wheel;
        for (uint32_t k = 0; k < from->leave_out_count; k++)
            keep = keep && !has_name(mesh, primitive, from->leave_out[k]);
        if (keep)
            mesh->primitives[kept++] = *primitive;
    }
    mesh->primitive_count = kept;
}

static bool load_part(shot *s, const scene_vehicle *from, bool wheel, part *out, char *error, size_t error_size)
{
    if (!shot_blame_input(s, host_mesh_load_kept(&s->device, from->file, NULL, &out->mesh, &out->vertices,
                                                 &out->indices, error, error_size)))
        return false;
    keep_part(from, wheel, &out->mesh);
    out->mesh.moves = true;
    for (uint32_t i = 0; i < out->mesh.primitive_count; i++)
        out->mesh.primitives[i].ground = false;
    return !s->renderer || host_renderer_add(s->renderer, &out->mesh, error, error_size);
}

static bool add_occluders(shot *s, vehicle *v, char *error, size_t error_size)
{
    const uint32_t room = SHOT_MAX_OCCLUDERS - s->occluder_count;
    virga_occluder *first = s->occluders + s->occluder_count;
    if (!host_buffer_create_with(&s->device, v->body.vertices, v->body.mesh.vertex_count * sizeof *v->body.vertices,
                                 VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "a vehicle for rain", &v->sheltering, error,
                                 error_size))
        return false;
    const uint32_t count = host_mesh_occluders(&v->body.mesh, first, room);
    v->first_occluder = s->occluder_count;
    v->occluder_count = count < room ? count : room;
    for (uint32_t i = 0; i < v->occluder_count; i++) {
        first[i].vertices = v->sheltering.buffer;
        first[i].ground = false;
        first[i].is_dynamic = true;
    }
    s->occluder_count += v->occluder_count;
    return true;
}

/* Where its wheels and feet stand. */
static double ground_of(const scene_vehicle *from)
{
    double ground_m = from->wheel_count + from->foot_count ? INFINITY : 0;
    for (uint32_t i = 0; i < from->wheel_count; i++)
        ground_m = fmin(ground_m, from->wheels[i].contact_m[1]);
    for (uint32_t i = 0; i < from->foot_count; i++)
        ground_m = fmin(ground_m, from->feet[i].sole_m[1]);
    return ground_m;
}

static double top_of(const part *body)
{
    double top_m = -INFINITY;
    for (uint32_t i = 0; i < body->mesh.primitive_count; i++) {
        const host_primitive *primitive = &body->mesh.primitives[i];
        for (uint32_t k = 0; k < primitive->index_count; k++) {
            const host_vertex *vertex = &body->vertices[body->indices[primitive->first_index + k]];
            top_m = fmax(top_m, (double)vertex->position[1]);
        }
    }
    return top_m;
}

/* As it is at rest, in the first pose of one that walks. */
static bool add_drips(shot *s, const scene_vehicle *from, vehicle *v, char *error, size_t error_size)
{
    v->drip_count = tool_drips_add_model(s, &v->body.mesh, v->body.vertices, v->body.indices, ground_of(from),
                                         &v->first_drip, error, error_size);
    v->top_m = top_of(&v->body);
    return v->drip_count != UINT32_MAX;
}

static bool open_state(shot *s, void *state, char *error, size_t error_size)
{
    vehicles_state *all = state;
    const scene_vehicles *from = scene_vehicles_of(s->scene);
    for (uint32_t i = 0; i < from->vehicle_count; i++) {
        const scene_vehicle *given = &from->vehicles[i];
        vehicle *v = &all->vehicles[i];
        if (!given->file)
            continue;
        if (!load_part(s, given, false, &v->body, error, error_size) ||
            (given->pose_part && !shot_blame_input(s, walk_poses_take(&v->body.mesh, v->body.indices, given->pose_part,
                                                                      &v->poses, error, error_size))) ||
            !add_occluders(s, v, error, error_size) || !add_drips(s, given, v, error, error_size))
            return false;
        for (uint32_t k = 0; given->wheel_part && k < given->wheel_count; k++)
            if (!load_part(s, given, true, &v->wheels[k], error, error_size))
                return false;
    }
    return true;
}

static void close_part(shot *s, part *p)
{
    host_mesh_destroy(&s->device, &p->mesh);
    free(p->vertices);
    free(p->indices);
}

static void close_state(shot *s, void *state)
{
    vehicles_state *all = state;
    for (uint32_t i = 0; i < SCENE_MAX_VEHICLES; i++) {
        close_part(s, &all->vehicles[i].body);
        walk_poses_free(&all->vehicles[i].poses);
        for (uint32_t k = 0; k < SCENE_MAX_WHEELS; k++)
            close_part(s, &all->vehicles[i].wheels[k]);
        host_buffer_destroy(&s->device, &all->vehicles[i].sheltering);
    }
}

/* ---- where they are ------------------------------------------------------------------------------------------- */

/* Three rows of a rotation and a place. */
static void transform_at(const scene_vehicle *from, double time_s, float out[12])
{
    static const double origin[3] = {0, 0, 0};
    const scene_body body = {.keys = from->keys, .key_count = from->key_count};
    body_place place;
    body_place_of_keys(&body, time_s, &place);
    body_transform(&place, origin, out);
}

static void to_world(const float transform[12], const double local[3], double world[3])
{
    for (int row = 0; row < 3; row++) {
        world[row] = (double)transform[4 * row + 3];
        for (int column = 0; column < 3; column++)
            world[row] += (double)transform[4 * row + column] * local[column];
    }
}

#define STEP_S (1.0 / 240) /* over which a velocity is taken */
#define LIMBS  3.0         /* a leg that swings goes up to so many times as fast as the body */
#define WHEELS 2.0         /* and the top of a wheel */

static void place_wheel(const scene_vehicle *from, uint32_t index, double time_s, virga_wheel *out)
{
    const scene_wheel *given = &from->wheels[index];
    float now[12], before[12];
    double then_m[3];
    transform_at(from, time_s, now);
    transform_at(from, time_s - STEP_S, before);
    to_world(now, given->contact_m, out->contact_m);
    to_world(before, given->contact_m, then_m);
    out->radius_m = (float)given->radius_m;
    out->width_m = (float)given->width_m;
    out->patch_m = (float)given->patch_m;
    out->open_deg = (float)given->open_deg;
    for (int axis = 0; axis < 3; axis++) {
        out->velocity_m_s[axis] = (float)fmin(fmax((out->contact_m[axis] - then_m[axis]) / STEP_S, -1000), 1000);
        out->axle[axis] = now[4 * axis];
    }
}

/* Those that stand on their side have no axle to roll about. */
static bool stands(const virga_wheel *wheel)
{
    return hypot((double)wheel->axle[0], (double)wheel->axle[2]) > 0.1;
}

/* Length of its path up to a time. */
static double way_m(const scene_vehicle *from, double time_s)
{
    double way = 0;
    for (uint32_t i = 1; i < from->key_count && from->keys[i - 1].time_s < time_s; i++) {
        const scene_body_key *a = &from->keys[i - 1], *b = &from->keys[i];
        const double *p = a->position_m, *q = b->position_m;
        const double part = fmin((time_s - a->time_s) / (b->time_s - a->time_s), 1);
        way += part * hypot(hypot(q[0] - p[0], q[1] - p[1]), q[2] - p[2]);
    }
    return way;
}

/* Returns how high it is lifted. */
static double sole_at(const scene_vehicle *from, const scene_foot *foot, double time_s, float transform[12],
                      double sole_m[3])
{
    double offset_m[2], local_m[3];
    walk_foot_at(way_m(from, time_s) / from->stride_m - foot->lands, from->stride_m, offset_m);
    memcpy(local_m, foot->sole_m, sizeof local_m);
    local_m[2] += offset_m[0];
    local_m[1] += offset_m[1];
    transform_at(from, time_s, transform);
    to_world(transform, local_m, sole_m);
    return offset_m[1];
}

/* The fastest that a sole came down in a frame. One that stands at its end may have landed in it, and that is what
 * throws water. */
static double falls_m_s(const scene_vehicle *from, const scene_foot *foot, double time_s, double frame_s)
{
    double at_m[3], later_m = 0, fastest = 0;
    float transform[12];
    const int steps = (int)fmin(ceil(frame_s / STEP_S), 240);
    for (int k = 0; k <= steps; k++) {
        sole_at(from, foot, time_s - k * STEP_S, transform, at_m);
        if (k > 0)
            fastest = fmin(fastest, (later_m - at_m[1]) / STEP_S);
        later_m = at_m[1];
    }
    return fastest;
}

static void place_foot(const scene_vehicle *from, uint32_t index, double time_s, double frame_s, virga_foot *out)
{
    const scene_foot *given = &from->feet[index];
    float now[12], before[12];
    double then_m[3];
    sole_at(from, given, time_s - STEP_S, before, then_m);
    const double lifted_m = sole_at(from, given, time_s, now, out->sole_m);
    out->length_m = (float)given->length_m;
    out->width_m = (float)given->width_m;
    for (int axis = 0; axis < 3; axis++) {
        out->velocity_m_s[axis] = (float)fmin(fmax((out->sole_m[axis] - then_m[axis]) / STEP_S, -1000), 1000);
        out->heading[axis] = -now[4 * axis + 2];
    }
    if (lifted_m <= 0)
        out->velocity_m_s[1] = (float)fmax(falls_m_s(from, given, time_s, frame_s), -1000);
}

/* Behind the lights of the scene. */
static void place_lamps(shot *s, double time_s)
{
    const scene_vehicles *all = scene_vehicles_of(s->scene);
    uint32_t count = s->scene->light_count;
    for (uint32_t i = 0; i < all->vehicle_count; i++)
        for (uint32_t k = 0; k < all->vehicles[i].lamp_count; k++) {
            const scene_lamp *from = &all->vehicles[i].lamps[k];
            virga_light *to = &s->lighting.lights[count++];
            float at[12];
            transform_at(&all->vehicles[i], time_s, at);
            to_world(at, from->position_m, to->position_m);
            for (int c = 0; c < 3; c++) {
                to->intensity[c] = (float)(from->color[c] * from->intensity_w_sr);
                to->direction[c] = 0;
                for (int n = 0; n < 3; n++)
                    to->direction[c] += at[4 * c + n] * (float)from->direction[n];
            }
            to->range_m = (float)from->range_m;
            to->cos_inner = (float)cos(from->inner_deg * M_PI / 180);
            to->cos_outer = (float)cos(from->outer_deg * M_PI / 180);
        }
    s->lighting.light_count = count;
}

/* How far the points of a part go at most while the shutter is open, which closes at `time_s`. */
static float travel_of(const scene_vehicle *from, const part *p, double time_s, double shutter_s)
{
    float now[12], then[12];
    double most = 0;
    transform_at(from, time_s, now);
    transform_at(from, time_s - shutter_s, then);
    for (uint32_t i = 0; i < p->mesh.vertex_count; i++) {
        const float *at = p->vertices[i].position;
        const double local_m[3] = {(double)at[0], (double)at[1], (double)at[2]};
        double now_m[3], then_m[3];
        to_world(now, local_m, now_m);
        to_world(then, local_m, then_m);
        most = fmax(most, hypot(hypot(now_m[0] - then_m[0], now_m[1] - then_m[1]), now_m[2] - then_m[2]));
    }
    return (float)most;
}

static void find_travel(const shot *s, const scene_vehicle *from, vehicle *v, double time_s)
{
    const double shutter_s = s->scene->frames.shutter_deg / 360 / s->scene->frames.fps;
    const float body_m = travel_of(from, &v->body, time_s, shutter_s);
    v->body.mesh.travel_m = v->poses.pose_count ? LIMBS * body_m : body_m;
    for (uint32_t k = 0; k < from->wheel_count; k++)
        v->wheels[k].mesh.travel_m = WHEELS * body_m;
}

static void move_drips(shot *s, const scene_vehicle *from, const vehicle *v, double time_s)
{
    float now[12], before[12];
    transform_at(from, time_s, now);
    transform_at(from, time_s - STEP_S, before);
    tool_drips_move(s, v->first_drip, v->drip_count, now, before, STEP_S, (double)now[7] + v->top_m);
}

static bool fill_frame(shot *s, void *state, double time_s, const host_camera *camera, virga_scene_frame *frame,
                       char *error, size_t error_size)
{
    vehicles_state *all = state;
    const scene_vehicles *from = scene_vehicles_of(s->scene);
    uint32_t count = 0, feet = 0, id = 0;
    place_lamps(s, time_s);
    (void)camera;
    for (uint32_t i = 0; i < from->vehicle_count; i++) {
        vehicle *v = &all->vehicles[i];
        find_travel(s, &from->vehicles[i], v, time_s);
        for (uint32_t k = 0; k < v->occluder_count; k++)
            transform_at(&from->vehicles[i], time_s, s->occluders[v->first_occluder + k].world_from_mesh);
        move_drips(s, &from->vehicles[i], v, time_s);
        for (uint32_t k = 0; k < from->vehicles[i].wheel_count; k++) {
            virga_wheel *wheel = &all->wheels[count];
            *wheel = virga_default_wheel();
            wheel->id = id++;
            place_wheel(&from->vehicles[i], k, time_s, wheel);
            count += stands(wheel);
        }
        for (uint32_t k = 0; k < from->vehicles[i].foot_count; k++) {
            virga_foot *foot = &all->feet[feet];
            *foot = virga_default_foot();
            foot->id = id++;
            place_foot(&from->vehicles[i], k, time_s, 1 / s->scene->frames.fps, foot);
            feet += hypot((double)foot->heading[0], (double)foot->heading[2]) > 0.1;
        }
    }
    frame->feet = all->feet;
    frame->foot_count = feet;
    frame->wheels = all->wheels;
    frame->wheel_count = count;
    return tool_drips_send(s, error, error_size);
}

/* ---- picture -------------------------------------------------------------------------------------------------- */

/* It turns about its axle, x; on the left it is turned around, so that its outer side is outside. */
static void wheel_transform(const scene_vehicle *from, uint32_t index, double time_s, const float vehicle_at[12],
                            float out[12])
{
    const scene_wheel *wheel = &from->wheels[index];
    const double side = wheel->contact_m[0] < 0 ? -1 : 1;
    const double roll = -side * way_m(from, time_s) / wheel->radius_m, c = cos(roll), sn = sin(roll);
    const double local[9] = {side, 0, 0, 0, c, -sn, 0, side * sn, side * c}; /* rows */
    const double axle_m[3] = {wheel->contact_m[0], wheel->contact_m[1] + wheel->radius_m, wheel->contact_m[2]};
    double at_m[3];
    to_world(vehicle_at, axle_m, at_m);
    for (int row = 0; row < 3; row++) {
        out[4 * row + 3] = (float)at_m[row];
        for (int column = 0; column < 3; column++) {
            double sum = 0;
            for (int k = 0; k < 3; k++)
                sum += (double)vehicle_at[4 * row + k] * local[3 * k + column];
            out[4 * row + column] = (float)sum;
        }
    }
}

/* `poses` may be NULL; then it is stiff. */
static bool move_part(part *p, const walk_poses *poses, double stride, const float transform[12], VkCommandBuffer cmd,
                      char *error, size_t error_size)
{
    if (!p->mesh.vertex_count)
        return true;
    host_vertex *vertices = malloc(p->mesh.vertex_count * sizeof *vertices);
    if (!vertices)
        return host_fail(error, error_size, "no memory for a vehicle");
    memcpy(vertices, p->vertices, p->mesh.vertex_count * sizeof *vertices);
    if (poses && poses->pose_count)
        walk_poses_blend(poses, p->vertices, stride, vertices);
    for (int row = 0; row < 3; row++) {
        p->mesh.low[row] = FLT_MAX;
        p->mesh.high[row] = -FLT_MAX;
    }
    for (uint32_t i = 0; i < p->mesh.vertex_count; i++) {
        const host_vertex from = vertices[i];
        for (int row = 0; row < 3; row++) {
            const float *m = &transform[4 * row];
            const float at = m[0] * from.position[0] + m[1] * from.position[1] + m[2] * from.position[2] + m[3];
            vertices[i].position[row] = at;
            vertices[i].normal[row] = m[0] * from.normal[0] + m[1] * from.normal[1] + m[2] * from.normal[2];
            p->mesh.low[row] = fminf(p->mesh.low[row], at);
            p->mesh.high[row] = fmaxf(p->mesh.high[row], at);
        }
    }
    host_mesh_move(cmd, &p->mesh, vertices);
    free(vertices);
    return true;
}

static bool before_plate(shot *s, void *state, VkCommandBuffer cmd, double camera_s, char *error, size_t error_size)
{
    vehicles_state *all = state;
    const scene_vehicles *from = scene_vehicles_of(s->scene);
    place_lamps(s, camera_s);
    host_renderer_set_lights(s->renderer, s->lighting.lights, s->lighting.light_count);
    for (uint32_t i = 0; i < from->vehicle_count; i++) {
        float body[12], wheel[12];
        transform_at(&from->vehicles[i], camera_s, body);
        const scene_vehicle *given = &from->vehicles[i];
        if (!move_part(&all->vehicles[i].body, &all->vehicles[i].poses, way_m(given, camera_s) / given->stride_m, body,
                       cmd, error, error_size))
            return false;
        for (uint32_t k = 0; k < from->vehicles[i].wheel_count; k++) {
            wheel_transform(&from->vehicles[i], k, camera_s, body, wheel);
            if (!move_part(&all->vehicles[i].wheels[k], NULL, 0, wheel, cmd, error, error_size))
                return false;
        }
    }
    return true;
}

/* ---- the effect ----------------------------------------------------------------------------------------------- */

const tool_effect vehicles_effect = {
    .name = "vehicles",
    .title = "Vehicles",
    .scene = {.group = SCENE_GROUP(scene_vehicles, vehicles_section), .check = check},
    TOOL_USED_IF(is_used, "vehicles; expected a list of them, vehicles"),
    .print = print,
    .state_size = sizeof(vehicles_state),
    .define = define,
    .open = open_state,
    .close = close_state,
    .fill_frame = fill_frame,
    .before_plate = before_plate,
};
