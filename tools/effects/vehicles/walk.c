/* walk.c - see walk.h. */
#include "vehicles/walk.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The number behind `part` in a name; UINT32_MAX: the name has none. */
static uint32_t pose_of(const host_primitive *primitive, const char *part)
{
    for (const char *at = primitive->name; *at; at++)
        if (!strncmp(at, part, strlen(part)) && isdigit((unsigned char)at[strlen(part)]))
            return (uint32_t)strtoul(at + strlen(part), NULL, 10);
    return UINT32_MAX;
}

static void vertices_of(const host_primitive *primitive, const uint32_t *indices, uint32_t *first, uint32_t *count)
{
    uint32_t low = UINT32_MAX, high = 0;
    for (uint32_t i = 0; i < primitive->index_count; i++) {
        const uint32_t index = indices[primitive->first_index + i];
        low = index < low ? index : low;
        high = index > high ? index : high;
    }
    *first = low;
    *count = high - low + 1;
}

/* The part after which `so_far` others of the same pose came. */
static bool add_part(const host_mesh *mesh, uint32_t index, const uint32_t *indices, uint32_t pose, uint32_t so_far,
                     walk_poses *poses)
{
    uint32_t first, count;
    vertices_of(&mesh->primitives[index], indices, &first, &count);
    walk_part *part = &poses->parts[so_far];
    if (so_far >= poses->part_count || (pose > 0 && part->vertex_count != count))
        return false;
    part->vertex_count = count;
    part->first_vertex[pose] = first;
    return true;
}

static void count_poses(const host_mesh *mesh, const char *part, walk_poses *poses)
{
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const uint32_t pose = pose_of(&mesh->primitives[i], part);
        poses->part_count += pose == 0;
        if (pose != UINT32_MAX && pose + 1 > poses->pose_count)
            poses->pose_count = pose + 1;
    }
}

bool walk_poses_take(host_mesh *mesh, const uint32_t *indices, const char *part, walk_poses *poses, char *error,
                     size_t error_size)
{
    uint32_t so_far[WALK_MAX_POSES] = {0}, kept = 0;
    memset(poses, 0, sizeof *poses);
    count_poses(mesh, part, poses);
    if (poses->pose_count < 2 || poses->pose_count > WALK_MAX_POSES)
        return host_fail(error, error_size, "%s: expected 2 to %d poses named %s0, %s1 and so on, got %u", mesh->path,
                         WALK_MAX_POSES, part, part, poses->pose_count);
    poses->parts = calloc((size_t)poses->part_count + 1, sizeof *poses->parts);
    if (!poses->parts)
        return host_fail(error, error_size, "no memory for the poses of %s", mesh->path);
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const uint32_t pose = pose_of(&mesh->primitives[i], part);
        if (pose != UINT32_MAX && !add_part(mesh, i, indices, pose, so_far[pose]++, poses))
            return host_fail(error, error_size, "%s: %s%u has other vertices than %s0", mesh->path, part, pose, part);
        if (pose == UINT32_MAX || pose == 0)
            mesh->primitives[kept++] = mesh->primitives[i];
    }
    mesh->primitive_count = kept;
    for (uint32_t k = 0; k < poses->pose_count; k++)
        if (so_far[k] != poses->part_count)
            return host_fail(error, error_size, "%s: %s%u has other parts than %s0", mesh->path, part, k, part);
    return true;
}

void walk_poses_free(walk_poses *poses)
{
    free(poses->parts);
    memset(poses, 0, sizeof *poses);
}

/* Catmull and Rom 1974, through the poses before and after: a closed curve. */
static void weights_at(double part, uint32_t pose_count, uint32_t pose[4], float weight[4])
{
    const double at = (part - floor(part)) * pose_count, t = at - floor(at), t2 = t * t, t3 = t2 * t;
    const double of[4] = {-t3 + 2 * t2 - t, 3 * t3 - 5 * t2 + 2, -3 * t3 + 4 * t2 + t, t3 - t2};
    for (uint32_t k = 0; k < 4; k++) {
        pose[k] = ((uint32_t)at + pose_count + k - 1) % pose_count;
        weight[k] = (float)(0.5 * of[k]);
    }
}

void walk_poses_blend(const walk_poses *poses, const host_vertex *in, double part, host_vertex *out)
{
    uint32_t pose[4];
    float weight[4];
    weights_at(part, poses->pose_count, pose, weight);
    for (uint32_t p = 0; p < poses->part_count; p++)
        for (uint32_t i = 0; i < poses->parts[p].vertex_count; i++) {
            host_vertex *to = &out[poses->parts[p].first_vertex[0] + i];
            float length = 0;
            for (int axis = 0; axis < 3; axis++) {
                to->position[axis] = to->normal[axis] = 0;
                for (int k = 0; k < 4; k++) {
                    const host_vertex *from = &in[poses->parts[p].first_vertex[pose[k]] + i];
                    to->position[axis] += weight[k] * from->position[axis];
                    to->normal[axis] += weight[k] * from->normal[axis];
                }
                length += to->normal[axis] * to->normal[axis];
            }
            for (int axis = 0; axis < 3 && length > 0; axis++)
                to->normal[axis] /= sqrtf(length);
        }
}

/* A foot is on the ground for six tenths of a stride (Perry 1992, Gait Analysis), and lands a quarter of it ahead. */
#define STAND  0.6
#define AHEAD  0.25
#define LIFT_M 0.09 /* of the middle of the sole */

void walk_foot_at(double part, double stride_m, double offset_m[2])
{
    const double u = part - floor(part), v = fmax(u - STAND, 0) / (1 - STAND);
    offset_m[0] = stride_m * (u < STAND ? u - AHEAD : (STAND - AHEAD) - STAND * v * v * (3 - 2 * v));
    offset_m[1] = LIFT_M * sin(M_PI * v);
}
