/* body_pose.c - where bodies in simulated water are, by keys or by the solver, and their meshes there. */
#include "body_pose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- quaternions x, y, z, w */

static void multiply(const double a[4], const double b[4], double out[4])
{
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        out[axis] = a[3] * b[axis] + a[axis] * b[3] + a[u] * b[v] - a[v] * b[u];
    }
    out[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
}

/* About the X, then Y, then Z axis of the world, as meshes of a scene. */
static void turn_of(const double rotation_deg[3], double out[4])
{
    double turned[4] = {0, 0, 0, 1};
    for (int axis = 0; axis < 3; axis++) {
        const double half = rotation_deg[axis] * M_PI / 360;
        double about[4] = {0, 0, 0, cos(half)};
        about[axis] = sin(half);
        multiply(about, turned, out);
        memcpy(turned, out, sizeof turned);
    }
}

static void normalize(double q[4])
{
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        q[i] = length > 0 ? q[i] / length : (double)(i == 3);
}

/* v + 2 q x (q x v + w v) */
static void turn(const double q[4], const float v[3], double out[3])
{
    double c[3];
    for (int axis = 0; axis < 3; axis++) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        c[axis] = q[a] * (double)v[b] - q[b] * (double)v[a] + q[3] * (double)v[axis];
    }
    for (int axis = 0; axis < 3; axis++) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        out[axis] = (double)v[axis] + 2 * (q[a] * c[b] - q[b] * c[a]);
    }
}

/* ---- by keys */

void body_place_of_keys(const scene_body *from, double time_s, body_place *out)
{
    double rotation_deg[3];
    memcpy(out->position_m, from->position_m, sizeof out->position_m);
    memcpy(rotation_deg, from->rotation_deg, sizeof rotation_deg);
    if (from->key_count) {
        uint32_t next = 0;
        while (next < from->key_count && from->keys[next].time_s <= time_s)
            next++;
        const scene_body_key *a = &from->keys[next > 0 ? next - 1 : 0];
        const scene_body_key *b = &from->keys[next < from->key_count ? next : next - 1];
        const double part = b->time_s > a->time_s ? fmax((time_s - a->time_s) / (b->time_s - a->time_s), 0) : 0;
        for (int axis = 0; axis < 3; axis++) {
            out->position_m[axis] = a->position_m[axis] + part * (b->position_m[axis] - a->position_m[axis]);
            rotation_deg[axis] = a->rotation_deg[axis] + part * (b->rotation_deg[axis] - a->rotation_deg[axis]);
        }
    }
    turn_of(rotation_deg, out->rotation);
}

void body_copy_place(const body_place *place, float position_m[3], float rotation[4])
{
    for (int axis = 0; axis < 3; axis++)
        position_m[axis] = (float)place->position_m[axis];
    for (int i = 0; i < 4; i++)
        rotation[i] = (float)place->rotation[i];
}

void body_transform(const body_place *place, const double origin_m[3], float out[12])
{
    const double *q = place->rotation;
    for (int row = 0; row < 3; row++) {
        const int u = (row + 1) % 3, v = (row + 2) % 3;
        out[row * 4 + row] = (float)(1 - 2 * (q[u] * q[u] + q[v] * q[v]));
        out[row * 4 + u] = (float)(2 * (q[row] * q[u] - q[3] * q[v]));
        out[row * 4 + v] = (float)(2 * (q[row] * q[v] + q[3] * q[u]));
        out[row * 4 + 3] = (float)(origin_m[row] + place->position_m[row]);
    }
}

bool water_drive_bodies(shot *s, water_state *state, double time_s, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < state->solver.body_count; i++) {
        const scene_body *from = state->solver.bodies[i].from;
        if (!from || !from->key_count)
            continue;
        body_place place;
        virga_fluid_pose pose = {0};
        body_place_of_keys(from, time_s, &place);
        body_copy_place(&place, pose.position_m, pose.rotation);
        if (!shot_ok(s, virga_fluid_body_drive(state->solver.fluid, i, &pose), "moving a body", error, error_size))
            return false;
    }
    return true;
}

/* Bodies turn, so each takes as much room as its farthest point needs. */
void water_body_region(const water_state *state, double time_s, double margin_m, float low_m[2], float high_m[2])
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint32_t i = 0; i < state->solver.body_count; i++) {
        const water_body *body = &state->solver.bodies[i];
        if (!body->from || !body->from->key_count)
            continue;
        body_place place;
        double radius2 = 0;
        for (int axis = 0; axis < 3; axis++)
            radius2 += pow(fmax(fabs(body->low[axis]), fabs(body->high[axis])), 2);
        body_place_of_keys(body->from, time_s, &place);
        for (int axis = 0; axis < 2; axis++) {
            const double at = place.position_m[2 * axis], reach = sqrt(radius2) + margin_m;
            low[axis] = fmin(low[axis], at - reach);
            high[axis] = fmax(high[axis], at + reach);
        }
    }
    for (int axis = 0; axis < 2; axis++) {
        low_m[axis] = low[0] < high[0] ? (float)low[axis] : 0;
        high_m[axis] = low[0] < high[0] ? (float)high[axis] : 0;
    }
}

/* ---- by the solver */

static void from_state(const virga_fluid_body_gpu *from, body_place *out)
{
    for (int axis = 0; axis < 3; axis++)
        out->position_m[axis] = (double)from->origin[axis];
    for (int i = 0; i < 4; i++)
        out->rotation[i] = (double)from->rotation[i];
}

static const virga_fluid_body_gpu *state_of(const water_solver *solver, const host_buffer *copy, uint32_t index)
{
    return (const virga_fluid_body_gpu *)((const char *)copy->mapped + solver->bodies_at) + index;
}

/* Between the two newest states. */
static void place_between(const water_solver *solver, uint32_t index, double time_s, body_place *out)
{
    const double h = solver->now_s - solver->before_s;
    const double part = h > 0 ? fmin(fmax((time_s - solver->before_s) / h, 0), 1) : 1;
    body_place before;
    from_state(state_of(solver, &solver->now, index), out);
    if (part >= 1)
        return;
    from_state(state_of(solver, &solver->before, index), &before);
    double same = 0;
    for (int i = 0; i < 4; i++)
        same += before.rotation[i] * out->rotation[i];
    for (int axis = 0; axis < 3; axis++)
        out->position_m[axis] = before.position_m[axis] + part * (out->position_m[axis] - before.position_m[axis]);
    for (int i = 0; i < 4; i++)
        out->rotation[i] = part * out->rotation[i] + (same < 0 ? part - 1 : 1 - part) * before.rotation[i];
    normalize(out->rotation);
}

void body_place_ahead(const virga_fluid_pose *pose, double ahead_s, body_place *out)
{
    const double moving_s = fmin(fmax(ahead_s, 0), 0.5);
    float arm[3];
    double old[4], moved[3], half[4] = {0, 0, 0, 1};
    for (int axis = 0; axis < 3; axis++) {
        arm[axis] = pose->position_m[axis] - pose->center_m[axis];
        half[axis] = 0.5 * moving_s * (double)pose->spin_rad_s[axis];
    }
    normalize(half);
    for (int i = 0; i < 4; i++)
        old[i] = (double)pose->rotation[i];
    multiply(half, old, out->rotation);
    turn(half, arm, moved);
    for (int axis = 0; axis < 3; axis++)
        out->position_m[axis] =
            (double)pose->center_m[axis] + moving_s * (double)pose->velocity_m_s[axis] + moved[axis];
}

bool body_known_pose(const water_solver *solver, uint32_t index, double otherwise_s, virga_fluid_pose *pose,
                     double *known_s)
{
    if (!virga_fluid_body_get(solver->fluid, index, pose))
        return false;
    *known_s = pose->frame_index ? solver->frame_s[pose->frame_index % WATER_TIMES] : otherwise_s;
    return true;
}

void body_newest_pose(const water_solver *solver, uint32_t index, virga_fluid_pose *pose)
{
    const virga_fluid_body_gpu *from = state_of(solver, &solver->now, index);
    memcpy(pose->position_m, from->origin, sizeof pose->position_m);
    memcpy(pose->rotation, from->rotation, sizeof pose->rotation);
    memcpy(pose->velocity_m_s, from->velocity, sizeof pose->velocity_m_s);
    memcpy(pose->spin_rad_s, from->spin, sizeof pose->spin_rad_s);
    memcpy(pose->center_m, from->center, sizeof pose->center_m);
}

/* While the device still works on the step: as the body will have moved since the last state that is known. */
static void place_ahead(const water_solver *solver, uint32_t index, double time_s, body_place *out)
{
    virga_fluid_pose pose;
    double known_s;
    if (body_known_pose(solver, index, time_s, &pose, &known_s))
        body_place_ahead(&pose, time_s - known_s, out);
}

/* ---- meshes */

static bool move_mesh(const water_body *body, const double origin_m[3], const body_place *place, VkCommandBuffer cmd,
                      char *error, size_t error_size)
{
    host_vertex *vertices = malloc(body->vertex_count * sizeof *vertices);
    if (!vertices)
        return host_fail(error, error_size, "no memory for a body");
    for (uint32_t i = 0; i < body->vertex_count; i++) {
        double position[3], normal[3];
        vertices[i] = body->vertices[i];
        turn(place->rotation, body->vertices[i].position, position);
        turn(place->rotation, body->vertices[i].normal, normal);
        for (int axis = 0; axis < 3; axis++) {
            vertices[i].position[axis] = (float)(origin_m[axis] + place->position_m[axis] + position[axis]);
            vertices[i].normal[axis] = (float)normal[axis];
        }
    }
    host_mesh_move(cmd, &body->mesh, vertices);
    free(vertices);
    return true;
}

/* A body with keys is where they say; else the solver knows. */
bool water_draw_bodies(shot *s, water_state *state, VkCommandBuffer cmd, double time_s, char *error, size_t error_size)
{
    const scene_water *from = scene_water_of(s->scene);
    const water_solver *solver = &state->solver;
    const bool running = solver->step_frame == s->device.frame;
    if (solver->body_count && !running && !water_wait_for_solver(s, solver, error, error_size))
        return false;
    for (uint32_t i = 0; i < solver->body_count; i++) {
        const water_body *body = &solver->bodies[i];
        body_place place = {.rotation = {0, 0, 0, 1}};
        if (!body->from || !body->from->drawn)
            continue;
        if (!(body->from->density > 0))
            body_place_of_keys(body->from, time_s, &place);
        else if (running)
            place_ahead(solver, i, time_s - from->start_s, &place);
        else
            place_between(solver, i, time_s - from->start_s, &place);
        if (!move_mesh(body, from->position_m, &place, cmd, error, error_size))
            return false;
    }
    return true;
}

/* ---- statistics */

static void write_vector(jsonl *stats, const char *key, const float v[3])
{
    jsonl_begin_array(stats, key);
    for (int axis = 0; axis < 3; axis++)
        jsonl_number(stats, NULL, (double)v[axis]);
    jsonl_end(stats);
}

void water_write_body_stats(const water_state *state, jsonl *stats)
{
    const water_solver *solver = &state->solver;
    bool any = false;
    for (uint32_t i = 0; i < solver->body_count; i++)
        any = any || solver->bodies[i].from;
    if (!any)
        return;
    jsonl_begin_array(stats, "bodies");
    for (uint32_t i = 0; i < solver->body_count; i++) {
        const virga_fluid_body_gpu *now = state_of(solver, &solver->now, i);
        if (!solver->bodies[i].from)
            continue;
        jsonl_begin_object(stats, NULL);
        jsonl_string(stats, "name", solver->bodies[i].from->name);
        write_vector(stats, "position_m", now->origin);
        write_vector(stats, "velocity_m_s", now->velocity);
        write_vector(stats, "spin_rad_s", now->spin);
        jsonl_uint64(stats, "contacts", now->contacts);
        jsonl_uint64(stats, "contacts_dropped", now->dropped);
        jsonl_end(stats);
    }
    jsonl_end(stats);
}
