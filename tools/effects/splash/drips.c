/* drips.c - edges of a scene's meshes from which rain drips. */
#include "splash/drips.h"

#include "drip_edges.h"
#include "effect.h"
#include "splash.h"

#include <math.h>
#include <stdlib.h>

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

bool tool_drips_open(shot *s, virga_splash *splash, char *error, size_t error_size)
{
    const scene_splash_drips *from = &scene_splash_of(s->scene)->drips;
    if (!s->drip_edges)
        return true;
    virga_drip_site *sites = malloc(from->max_sites * sizeof *sites);
    uint32_t found = 0, count = UINT32_MAX;
    if (sites)
        count = host_drip_edges_find(s->drip_edges, from->reach_m, sites, from->max_sites, &found);
    host_drip_edges_end(s->drip_edges);
    s->drip_edges = NULL;
    bool ok = count != UINT32_MAX || host_fail(error, error_size, "no memory for %u edges that drip", from->max_sites);
    if (ok && found > count)
        host_warn(&s->device, "splash.drips: %u places drip, and max_sites is %u: those with the least water do not",
                  found, from->max_sites);
    if (ok && splash)
        ok = shot_ok(s, virga_splash_set_drips(splash, sites, count), "setting the edges that drip", error, error_size);
    free(sites);
    return ok;
}
