/* points.c - the surfels of water as points. spray_points.c has those of spray and foam. */
#include "water_state.h"

#include "point_columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct surfel {
    float position[3], velocity[3], radius_m, normal[3];
} surfel;

static const ply_property surfel_columns[] = {
    {"x", PLY_FLOAT, POINT_COLUMN(surfel, position, 0)},  {"y", PLY_FLOAT, POINT_COLUMN(surfel, position, 1)},
    {"z", PLY_FLOAT, POINT_COLUMN(surfel, position, 2)},  {"vx", PLY_FLOAT, POINT_COLUMN(surfel, velocity, 0)},
    {"vy", PLY_FLOAT, POINT_COLUMN(surfel, velocity, 1)}, {"vz", PLY_FLOAT, POINT_COLUMN(surfel, velocity, 2)},
    {"radius", PLY_FLOAT, offsetof(surfel, radius_m)},    {"nx", PLY_FLOAT, POINT_COLUMN(surfel, normal, 0)},
    {"ny", PLY_FLOAT, POINT_COLUMN(surfel, normal, 1)},   {"nz", PLY_FLOAT, POINT_COLUMN(surfel, normal, 2)},
};

static bool record(shot *s, void *state, VkCommandBuffer cmd, char *error, size_t error_size)
{
    water_state *p = state;
    virga_water_buffer surfels;
    virga_water_surfels(p->water, &surfels, p->surfels.origin_m);
    return shot_record_read(s, cmd, surfels.buffer, surfels.offset, surfels.size, &p->surfels, error, error_size);
}

/* As shaders/water/octahedron.glsl. */
static void unpack_normal(uint32_t packed, float normal[3])
{
    const double x = (double)(int16_t)(packed & 0xffff) / 32767, y = (double)(int16_t)(packed >> 16) / 32767;
    double n[3] = {x, y, 1 - fabs(x) - fabs(y)};
    if (n[2] < 0) {
        n[0] = copysign(1 - fabs(y), x);
        n[1] = copysign(1 - fabs(x), y);
    }
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int axis = 0; axis < 3; axis++)
        normal[axis] = (float)(n[axis] / length);
}

static bool read(shot *s, void *state, void **rows, uint32_t *count, char *error, size_t error_size)
{
    water_state *p = state;
    virga_water_stats stats;
    const virga_surfel_gpu *from = shot_finish_read(s, &p->surfels, error, error_size);
    *rows = NULL;
    *count = 0;
    if (!from)
        return false;
    if (!water_step_stats(s, p, &stats))
        return host_fail(error, error_size, "the number of surfels was not read back");
    surfel *surfels = malloc(stats.surfels * sizeof *surfels + 1);
    if (!surfels)
        return host_fail(error, error_size, "no memory for %u points", stats.surfels);
    for (uint32_t i = 0; i < stats.surfels; i++) {
        shot_read_position(&p->surfels, from[i].position, surfels[i].position);
        memcpy(surfels[i].velocity, from[i].velocity, sizeof surfels[i].velocity);
        surfels[i].radius_m = from[i].radius;
        unpack_normal(from[i].normal, surfels[i].normal);
    }
    *rows = surfels;
    *count = stats.surfels;
    return true;
}

const tool_points water_points = {
    .next = &water_spray_points,
    .properties = surfel_columns,
    .property_count = sizeof surfel_columns / sizeof surfel_columns[0],
    .stride = sizeof(surfel),
    .comment = "virga water: surfels of the surface; metres and seconds; normals point out of the water",
    .help = "surfels of the water's surface",
    .record = record,
    .read = read,
};
