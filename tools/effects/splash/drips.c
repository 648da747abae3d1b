/* drips.c - edges of a scene's meshes from which rain drips. */
#include "splash/drips.h"

#include "drip_edges.h"
#include "drip_model.h"
#include "effect.h"
#include "heights.h"
#include "splash.h"
#include "vehicles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define AROUND_M 16.0 /* of the camera's path: a drop of 4 mm is a tenth of a pixel wide there */
#define MOST_M   48.0

#define ROOF_CELL_M 0.25 /* of the heights of what keeps rain off that which moves */
#define ROOFS_M     8.0  /* they reach so far beside its ways: rain slants, and a bus is long */

typedef struct tool_drips {
    virga_splash *splash;     /* NULL: none */
    virga_drip_site *sites;   /* what stands, then what moves, as it is now */
    virga_drip_site *at_rest; /* the same for what moves, with the model's own positions */
    uint32_t standing, count, room;
    bool moved;
} tool_drips;

static bool drips(const shot *s)
{
    const scene_splash *splash = scene_splash_of(s->scene);
    return splash->on && splash->drips.on;
}

/* ---- what keeps rain off that which moves */

/* All ways of vehicles, and what is beside them. False: no memory. */
static bool begin_roofs(shot *s)
{
    const scene_vehicles *from = scene_vehicles_of(s->scene);
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint32_t i = 0; i < from->vehicle_count; i++)
        for (uint32_t k = 0; k < from->vehicles[i].key_count; k++)
            for (int axis = 0; axis < 2; axis++) {
                const double at = from->vehicles[i].keys[k].position_m[2 * axis];
                low[axis] = fmin(low[axis], at - ROOFS_M);
                high[axis] = fmax(high[axis], at + ROOFS_M);
            }
    return host_heights_begin(low, high, ROOF_CELL_M, &s->roofs);
}

/* ---- what stands */

/* A square around the path of the camera. */
static host_drip_edges *begin(const shot *s)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint32_t i = 0; i < s->path.count; i++)
        for (int axis = 0; axis < 2; axis++) {
            low[axis] = fmin(low[axis], s->path.keys[i].position_m[2 * axis]);
            high[axis] = fmax(high[axis], s->path.keys[i].position_m[2 * axis]);
        }
    const double middle[2] = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])};
    const double half_m = 0.5 * fmax(high[0] - low[0], high[1] - low[1]) + AROUND_M;
    return host_drip_edges_begin(middle, fmin(half_m, MOST_M));
}

bool tool_drips_read_mesh(shot *s, const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices,
                          char *error, size_t error_size)
{
    if (!drips(s))
        return true;
    if (!s->drip_edges)
        s->drip_edges = begin(s);
    if (!s->drip_edges)
        return host_fail(error, error_size, "no memory for the heights of edges that drip");
    const bool moving = scene_splash_of(s->scene)->drips.moving && scene_vehicles_of(s->scene)->vehicle_count;
    if (moving && !s->roofs.high_m && !begin_roofs(s))
        return host_fail(error, error_size, "no memory for the heights of roofs");
    if (moving)
        host_heights_add(&s->roofs, mesh, vertices, indices);
    host_drip_edges_add(s->drip_edges, mesh, vertices, indices);
    return true;
}

/* Places that pour come first; those that drip follow. Returns false, with a message, without memory. */
static bool add_pipes(const shot *s, const host_eave *eaves, uint32_t eave_count, virga_drip_site *sites,
                      uint32_t *count, char *error, size_t error_size)
{
    const scene_splash_drips *from = &scene_splash_of(s->scene)->drips;
    host_downpipe *pipes = malloc((from->pipe_count + 1) * sizeof *pipes);
    host_gutters gutters;
    for (uint32_t i = 0; pipes && i < from->pipe_count; i++)
        for (int axis = 0; axis < 3; axis++) {
            pipes[i].position_m[axis] = from->pipes[i].position_m[axis];
            pipes[i].velocity_m_s[axis] = from->pipes[i].velocity_m_s[axis];
        }
    if (!pipes || !host_gutters_find(eaves, eave_count, pipes, from->pipe_count, &gutters)) {
        free(pipes);
        return host_fail(error, error_size, "no memory for the gutters of roofs");
    }
    const uint32_t pouring = gutters.site_count < from->max_sites ? gutters.site_count : from->max_sites;
    const uint32_t dripping = *count < from->max_sites - pouring ? *count : from->max_sites - pouring;
    memmove(sites + pouring, sites, dripping * sizeof *sites);
    memcpy(sites, gutters.sites, pouring * sizeof *sites);
    *count = pouring + dripping;
    if (pouring < gutters.site_count)
        host_warn(&s->device, "splash.drips: %u places pour, and max_sites is %u: the others do not",
                  gutters.site_count, from->max_sites);
    free(gutters.sites);
    free(pipes);
    return true;
}

/* Returns the number of places, or UINT32_MAX with a message. */
static uint32_t find(shot *s, virga_drip_site *sites, char *error, size_t error_size)
{
    const scene_splash_drips *from = &scene_splash_of(s->scene)->drips;
    host_eave *eaves = NULL;
    uint32_t found = 0, eave_count = 0;
    uint32_t count =
        host_drip_edges_find(s->drip_edges, from->reach_m, sites, from->max_sites, &found, &eaves, &eave_count);
    if (count == UINT32_MAX) {
        host_fail(error, error_size, "no memory for %u edges that drip", from->max_sites);
        return UINT32_MAX;
    }
    if (from->pour && !add_pipes(s, eaves, eave_count, sites, &count, error, error_size))
        count = UINT32_MAX;
    else if (found > count)
        host_warn(&s->device, "splash.drips: %u places drip, and max_sites is %u: those with the least water do not",
                  found, from->max_sites);
    free(eaves);
    return count;
}

static bool send(shot *s, char *error, size_t error_size)
{
    const tool_drips *d = s->drips;
    return !d->splash || shot_ok(s, virga_splash_set_drips(d->splash, d->sites, d->count),
                                 "setting the edges that drip", error, error_size);
}

bool tool_drips_open(shot *s, virga_splash *splash, char *error, size_t error_size)
{
    if (!drips(s))
        return true;
    tool_drips *d = s->drips = calloc(1, sizeof *d);
    if (!d)
        return host_fail(error, error_size, "no memory for edges that drip");
    d->splash = splash;
    d->room = scene_splash_of(s->scene)->drips.max_sites;
    d->sites = malloc(d->room * sizeof *d->sites);
    d->at_rest = malloc(d->room * sizeof *d->at_rest);
    if (!d->sites || !d->at_rest)
        return host_fail(error, error_size, "no memory for %u edges that drip", d->room);
    if (s->drip_edges)
        d->standing = find(s, d->sites, error, error_size);
    host_drip_edges_end(s->drip_edges);
    s->drip_edges = NULL;
    d->count = d->standing;
    return d->standing != UINT32_MAX && send(s, error, error_size);
}

void tool_drips_close(shot *s)
{
    host_heights_free(&s->roofs);
    if (!s->drips)
        return;
    free(s->drips->sites);
    free(s->drips->at_rest);
    free(s->drips);
    s->drips = NULL;
}

/* ---- what moves */

uint32_t tool_drips_add_model(shot *s, const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices,
                              double ground_m, uint32_t *first, char *error, size_t error_size)
{
    tool_drips *d = s->drips;
    uint32_t found = 0;
    if (!d || !scene_splash_of(s->scene)->drips.moving)
        return 0;
    *first = d->count;
    const uint32_t room = d->room - d->count;
    const uint32_t count = host_drip_model_find(mesh, vertices, indices, ground_m, d->at_rest + d->count, room, &found);
    if (count == UINT32_MAX) {
        host_fail(error, error_size, "no memory for the edges of %s that drip", mesh->path);
        return UINT32_MAX;
    }
    if (found > count)
        host_warn(&s->device, "splash.drips: %u places of %s drip, and max_sites has room for %u: the others do not",
                  found, mesh->path, count);
    memcpy(d->sites + d->count, d->at_rest + d->count, count * sizeof *d->sites);
    d->count += count;
    return count;
}

void tool_drips_move(shot *s, uint32_t first, uint32_t count, const float transform[12], const float before[12],
                     double apart_s, double top_m)
{
    tool_drips *d = s->drips;
    virga_walls walls;
    if (!count)
        return;
    host_drip_model_move(d->at_rest + first, count, transform, before, apart_s, d->sites + first);
    virga_rain_walls_get(virga_scene_rain(s->simulation), &walls);
    host_heights_shade(&s->roofs, top_m, walls.slant, d->sites + first, count);
    d->moved = true;
}

bool tool_drips_send(shot *s, char *error, size_t error_size)
{
    if (!s->drips || !s->drips->moved)
        return true;
    s->drips->moved = false;
    return send(s, error, error_size);
}
