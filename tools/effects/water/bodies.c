/* bodies.c - bodies in simulated water: their meshes, and how the solver gets them. body_pose.c has where they are. */
#include "body_pose.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- meshes */

static void find_bounds(water_body *body)
{
    for (int axis = 0; axis < 3; axis++) {
        body->low[axis] = INFINITY;
        body->high[axis] = -INFINITY;
        for (uint32_t i = 0; i < body->vertex_count; i++) {
            body->low[axis] = fmin(body->low[axis], (double)body->vertices[i].position[axis]);
            body->high[axis] = fmax(body->high[axis], (double)body->vertices[i].position[axis]);
        }
    }
}

/* A face of the box for each sign and axis; its corners are its own, as normals differ. */
static void fill_box(const double sides[3], host_vertex *vertices, uint32_t *indices)
{
    static const uint32_t corners[6] = {0, 1, 2, 2, 1, 3};
    for (int face = 0; face < 6; face++) {
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3, sign = face % 2 ? 1 : -1;
        for (int corner = 0; corner < 4; corner++) {
            host_vertex *to = &vertices[face * 4 + corner];
            /* The other sign turns the face, so that it is wound outwards as well. */
            const int along = corner % 2 ? 1 : -1, across = (corner / 2 ? 1 : -1) * sign;
            *to = (host_vertex){.uv = {(float)(corner % 2), (float)(corner / 2)}};
            to->normal[axis] = (float)sign;
            to->position[axis] = (float)(0.5 * sign * sides[axis]);
            to->position[u] = (float)(0.5 * along * sides[u]);
            to->position[v] = (float)(0.5 * across * sides[v]);
        }
        for (int i = 0; i < 6; i++)
            indices[face * 6 + i] = (uint32_t)face * 4 + corners[i];
    }
}

static bool create_box(shot *s, water_body *body, char *error, size_t error_size)
{
    host_material material = {.roughness = (float)body->from->roughness, .base_color = {0, 0, 0, 1}};
    memcpy(material.name, "body", sizeof "body");
    for (int c = 0; c < 3; c++)
        material.base_color[c] = (float)body->from->color[c];
    body->vertex_count = 24;
    body->index_count = 36;
    body->vertices = calloc(body->vertex_count, sizeof *body->vertices);
    body->indices = calloc(body->index_count, sizeof *body->indices);
    if (!body->vertices || !body->indices)
        return host_fail(error, error_size, "no memory for a body");
    fill_box(body->from->box_m, body->vertices, body->indices);
    return host_mesh_create(&s->device, body->vertices, body->vertex_count, body->indices, body->index_count, &material,
                            &body->mesh, error, error_size);
}

static bool load_file(shot *s, water_body *body, char *error, size_t error_size)
{
    const float scale = (float)body->from->scale;
    const float transform[12] = {scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0};
    if (!shot_blame_input(s, host_mesh_load_kept(&s->device, body->from->file, transform, &body->mesh, &body->vertices,
                                                 &body->indices, error, error_size)))
        return false;
    body->vertex_count = body->mesh.vertex_count;
    body->index_count = body->mesh.index_count;
    return true;
}

static bool open_body(shot *s, water_body *body, char *error, size_t error_size)
{
    if (!(body->from->file ? load_file(s, body, error, error_size) : create_box(s, body, error, error_size)))
        return false;
    find_bounds(body);
    body->mesh.apart = true; /* the skylight is made once */
    return !s->renderer || !body->from->drawn || host_renderer_add(s->renderer, &body->mesh, error, error_size);
}

/* Appends what has a name in a mesh of the scene. */
static bool append_named(shot *s, const scene_mesh *mesh, const char *name, water_body *body, char *error,
                         size_t error_size)
{
    float transform[12];
    host_vertex *vertices;
    uint32_t *indices, count;
    shot_mesh_transform(mesh, transform);
    for (int axis = 0; axis < 3; axis++)
        transform[axis * 4 + 3] -= (float)scene_water_of(s->scene)->position_m[axis];
    if (!shot_blame_input(
            s, host_mesh_read(&s->device, mesh->file, transform, name, &vertices, &indices, &count, error, error_size)))
        return false;
    const uint32_t all = body->vertex_count + count;
    host_vertex *more = realloc(body->vertices, (all + 1) * sizeof *more);
    body->vertices = more ? more : body->vertices;
    uint32_t *grown = realloc(body->indices, (all + 1) * sizeof *grown);
    body->indices = grown ? grown : body->indices;
    if (more)
        memcpy(more + body->vertex_count, vertices, count * sizeof *more);
    for (uint32_t i = 0; grown && i < count; i++)
        grown[body->index_count + i] = body->vertex_count + indices[i];
    free(vertices);
    free(indices);
    body->vertex_count = body->index_count = all;
    return (more && grown) || host_fail(error, error_size, "no memory for a body");
}

static bool open_mesh(shot *s, uint32_t index, water_body *body, char *error, size_t error_size)
{
    const char *name = scene_water_of(s->scene)->solver.meshes[index];
    char key[64];
    for (uint32_t i = 0; i < s->scene->mesh_count; i++)
        if (!append_named(s, &s->scene->meshes[i], name, body, error, error_size))
            return false;
    snprintf(key, sizeof key, "water.solver.meshes.%u", index);
    if (!body->vertex_count)
        return shot_blame_input(s, scene_file_refuse(s->scene, key, error, error_size,
                                                     "no mesh or material of the scene has '%s' in its name", name));
    find_bounds(body);
    return true;
}

bool water_open_bodies(shot *s, water_state *state, char *error, size_t error_size)
{
    const scene_solver *from = &scene_water_of(s->scene)->solver;
    water_solver *solver = &state->solver;
    for (uint32_t i = 0; i < from->body_count; i++) {
        water_body *body = &solver->bodies[solver->body_count++];
        body->from = &from->bodies[i];
        if (!open_body(s, body, error, error_size))
            return false;
    }
    for (uint32_t i = 0; i < from->mesh_count; i++)
        if (!open_mesh(s, i, &solver->bodies[solver->body_count++], error, error_size))
            return false;
    return true;
}

void water_close_bodies(shot *s, water_state *state)
{
    for (uint32_t i = 0; i < state->solver.body_count; i++) {
        water_body *body = &state->solver.bodies[i];
        host_mesh_destroy(&s->device, &body->mesh);
        host_buffer_destroy(&s->device, &body->sheltering);
        free(body->vertices);
        free(body->indices);
    }
    state->solver.body_count = 0;
}

/* ---- the solver */

#define MARGIN_SPACINGS 5   /* of a map over its body, see virga_fluid_def.max_body_nodes */
#define MORE_NODES      512 /* for points on the surface */
#define NEAR_PARTICLES  4   /* within two spacings of spacing^2 of a surface, with some to spare */

void water_size_bodies(const shot *s, const water_state *state, virga_fluid_def *def)
{
    const double d = scene_water_of(s->scene)->solver.spacing_m;
    double nodes = 0, contacts = 4096;
    def->max_bodies = state->solver.body_count;
    for (uint32_t i = 0; i < state->solver.body_count; i++) {
        const water_body *body = &state->solver.bodies[i];
        double map = 1, area = 0;
        for (int axis = 0; axis < 3; axis++) {
            const int next = (axis + 1) % 3;
            map *= ceil((body->high[axis] - body->low[axis] + MARGIN_SPACINGS * d) / (0.5 * d)) + 2;
            area += 2 * (body->high[axis] - body->low[axis]) * (body->high[next] - body->low[next]);
        }
        nodes += map + MORE_NODES;
        if (body->from && body->from->density > 0)
            contacts = fmax(contacts, NEAR_PARTICLES * area / (d * d));
    }
    def->max_body_nodes = (uint32_t)fmin(fmax(nodes, 4096), 16777216);
    def->max_contacts = (uint32_t)fmin(contacts, 1048576);
}

static bool add_body(shot *s, water_state *state, uint32_t index, char *error, size_t error_size)
{
    const water_body *body = &state->solver.bodies[index];
    const scene_body *from = body->from;
    virga_fluid_body given = {.positions = body->vertices[0].position,
                              .stride = sizeof *body->vertices,
                              .vertex_count = body->vertex_count,
                              .indices = body->indices,
                              .index_count = body->index_count};
    char what[96] = "adding a mesh of the scene to the water";
    uint32_t number;
    if (from) {
        given.density = (float)from->density;
        given.friction = (float)from->friction;
        for (int axis = 0; axis < 3; axis++) {
            given.velocity_m_s[axis] = (float)from->velocity_m_s[axis];
            given.spin_rad_s[axis] = (float)(from->spin_deg_s[axis] * M_PI / 180);
        }
        body_place place;
        body_place_of_keys(from, state->solver.now_s + scene_water_of(s->scene)->start_s, &place);
        body_copy_place(&place, given.position_m, given.rotation);
        snprintf(what, sizeof what, "adding the body '%s' to the water", from->name);
    }
    /* Bodies are wrong by their meshes. */
    return shot_blame_input(
        s, shot_ok(s, virga_fluid_body_add(state->solver.fluid, &given, &number), what, error, error_size));
}

bool water_add_bodies(shot *s, water_state *state, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < state->solver.body_count; i++)
        if (!add_body(s, state, i, error, error_size))
            return false;
    return true;
}
