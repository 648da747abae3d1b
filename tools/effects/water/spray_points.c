/* spray_points.c - the spray and the foam of water as points. */
#include "water_state.h"

#include "point_columns.h"

#include <stdlib.h>
#include <string.h>

/* ---- spray */

typedef struct droplet {
    float position[3], velocity[3], radius_m;
    uint32_t id;
} droplet;

static const ply_property droplet_columns[] = {
    {"x", PLY_FLOAT, POINT_COLUMN(droplet, position, 0)},  {"y", PLY_FLOAT, POINT_COLUMN(droplet, position, 1)},
    {"z", PLY_FLOAT, POINT_COLUMN(droplet, position, 2)},  {"vx", PLY_FLOAT, POINT_COLUMN(droplet, velocity, 0)},
    {"vy", PLY_FLOAT, POINT_COLUMN(droplet, velocity, 1)}, {"vz", PLY_FLOAT, POINT_COLUMN(droplet, velocity, 2)},
    {"radius", PLY_FLOAT, offsetof(droplet, radius_m)},    {"id", PLY_UINT, offsetof(droplet, id)},
};

static bool record_droplets(shot *s, void *state, VkCommandBuffer cmd, char *error, size_t error_size)
{
    water_state *p = state;
    virga_water_buffer from;
    virga_water_spray(p->water, &from, p->droplets.origin_m);
    return shot_record_read(s, cmd, from.buffer, from.offset, from.size, &p->droplets, error, error_size);
}

static bool read_droplets(shot *s, void *state, void **rows, uint32_t *count, char *error, size_t error_size)
{
    water_state *p = state;
    virga_water_stats stats;
    const virga_spray_gpu *from = shot_finish_read(s, &p->droplets, error, error_size);
    *rows = NULL;
    *count = 0;
    if (!from)
        return false;
    if (!water_step_stats(s, p, &stats))
        return host_fail(error, error_size, "the number of droplets was not read back");
    droplet *out = malloc(stats.droplets * sizeof *out + 1);
    if (!out)
        return host_fail(error, error_size, "no memory for %u points", stats.droplets);
    for (uint32_t i = 0; i < stats.droplets; i++) {
        shot_read_position(&p->droplets, from[i].position, out[i].position);
        memcpy(out[i].velocity, from[i].velocity, sizeof out[i].velocity);
        out[i].radius_m = from[i].radius;
        out[i].id = from[i].id;
    }
    *rows = out;
    *count = stats.droplets;
    return true;
}

const tool_points water_spray_points = {
    .name = "water_spray",
    .next = &water_foam_points,
    .comment = "virga water: droplets that left the surface; metres and seconds",
    .help = "droplets of the water's spray",
    TOOL_POINTS(droplet_columns, droplet, record_droplets, read_droplets),
};

/* ---- foam */

typedef struct bubbles {
    POINT_MEMBERS;
    float life;
    uint32_t kind;
} bubbles;

static const ply_property foam_columns[] = {POINT_COLUMNS(bubbles), POINT_FLOAT(bubbles, life),
                                            POINT_UINT(bubbles, kind)};

static bool record_foam(shot *s, void *state, VkCommandBuffer cmd, char *error, size_t error_size)
{
    water_state *p = state;
    virga_water_buffer from;
    virga_water_foam(p->water, &from, p->foam.origin_m);
    return !from.size || shot_record_read(s, cmd, from.buffer, from.offset, from.size, &p->foam, error, error_size);
}

/* Slots without a particle are left out. */
static bool read_foam(shot *s, void *state, void **rows, uint32_t *count, char *error, size_t error_size)
{
    water_state *p = state;
    virga_water_buffer whole;
    virga_water_foam(p->water, &whole, NULL);
    const uint32_t slots = (uint32_t)(whole.size / sizeof(virga_foam_gpu));
    const virga_foam_gpu *from = slots ? shot_finish_read(s, &p->foam, error, error_size) : NULL;
    bubbles *out = malloc(slots * sizeof *out + 1);
    *rows = out;
    *count = 0;
    if (!out)
        return host_fail(error, error_size, "no memory for %u points", slots);
    if (slots && !from)
        return false;
    for (uint32_t i = 0; i < slots; i++) {
        if (!(from[i].life_s > 0))
            continue;
        bubbles *row = &out[(*count)++];
        shot_read_position(&p->foam, from[i].position, row->position);
        memcpy(row->velocity, from[i].velocity, sizeof row->velocity);
        row->radius_m = from[i].radius;
        row->id = from[i].id;
        row->age_s = from[i].age_s;
        row->life = from[i].life_s;
        row->kind = from[i].kind;
    }
    return true;
}

const tool_points water_foam_points = {
    .name = "water_foam",
    .next = &water_particle_points,
    .comment = "virga water: foam; metres and seconds; kind 0 is spray, 1 foam on the surface, 2 bubbles",
    .help = "spray, foam and bubbles made by the water",
    TOOL_POINTS(foam_columns, bubbles, record_foam, read_foam),
};
