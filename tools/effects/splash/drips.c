/* drips.c - edges of a scene's meshes from which rain drips. */
#include "splash/drips.h"

#include "drip_edges.h"
#include "effect.h"
#include "splash.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define AROUND_M 16.0 /* of the camera's path: a drop of 4 mm is a tenth of a pixel wide there */
#define MOST_M   48.0

static bool drips(const shot *s)
{
    const scene_splash *splash = scene_splash_of(s->scene);
    return splash->on && splash->drips.on;
}

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

bool tool_drips_open(shot *s, virga_splash *splash, char *error, size_t error_size)
{
    const scene_splash_drips *from = &scene_splash_of(s->scene)->drips;
    if (!s->drip_edges)
        return true;
    virga_drip_site *sites = malloc(from->max_sites * sizeof *sites);
    bool ok = sites || host_fail(error, error_size, "no memory for %u edges that drip", from->max_sites);
    const uint32_t count = ok ? find(s, sites, error, error_size) : UINT32_MAX;
    host_drip_edges_end(s->drip_edges);
    s->drip_edges = NULL;
    ok = ok && count != UINT32_MAX;
    if (ok && splash)
        ok = shot_ok(s, virga_splash_set_drips(splash, sites, count), "setting the edges that drip", error, error_size);
    free(sites);
    return ok;
}
