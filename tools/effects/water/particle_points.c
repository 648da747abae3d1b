/* particle_points.c - the particles of water as points: those of the solver, or those of files at the time of a frame.
 * `water.files` reads them again. */
#include "water_state.h"

#include "point_columns.h"

#include <stdlib.h>
#include <string.h>

typedef struct particle {
    float position[3], velocity[3];
    uint32_t id;
} particle;

static const ply_property particle_columns[] = {
    {"x", PLY_FLOAT, POINT_COLUMN(particle, position, 0)},
    {"y", PLY_FLOAT, POINT_COLUMN(particle, position, 1)},
    {"z", PLY_FLOAT, POINT_COLUMN(particle, position, 2)},
    {"vx", PLY_FLOAT, POINT_COLUMN(particle, velocity, 0)},
    {"vy", PLY_FLOAT, POINT_COLUMN(particle, velocity, 1)},
    {"vz", PLY_FLOAT, POINT_COLUMN(particle, velocity, 2)},
    {"id", PLY_UINT, offsetof(particle, id)},
};

/* They are on the host already. */
static bool record(shot *s, void *state, VkCommandBuffer cmd, char *error, size_t error_size)
{
    (void)s, (void)state, (void)cmd, (void)error, (void)error_size;
    return true;
}

static bool read(shot *s, void *state, void **rows, uint32_t *count, char *error, size_t error_size)
{
    water_state *p = state;
    uint32_t given;
    *rows = NULL;
    *count = 0;
    virga_particle_gpu *from = water_copy_particles(s, p, &given, error, error_size);
    particle *to = from ? malloc(given * sizeof *to + 1) : NULL;
    if (from && !to)
        host_fail(error, error_size, "no memory for %u points", given);
    for (uint32_t i = 0; to && i < given; i++) {
        if (!(from[i].share > 0))
            continue;
        particle *row = &to[(*count)++];
        for (int axis = 0; axis < 3; axis++)
            row->position[axis] = (float)((double)from[i].position[axis] + scene_water_of(s->scene)->position_m[axis]);
        memcpy(row->velocity, from[i].velocity, sizeof row->velocity);
        row->id = from[i].id;
    }
    free(from);
    *rows = to;
    return to;
}

const tool_points water_particle_points = {
    .name = "water_particles",
    .properties = particle_columns,
    .property_count = sizeof particle_columns / sizeof particle_columns[0],
    .stride = sizeof(particle),
    .comment = "virga water: particles; metres and seconds; water.files reads them",
    .help = "particles of the water",
    .record = record,
    .read = read,
};
