/* mesh_level.c - finds the triangles of a model that are too steep for water, and those that are level ground. */
#include "mesh_geometry.h"
#include "shaders/frame_gpu.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Normals of a triangle's corners; mesh_cut.c leaves some that are shorter than 1. */
static void unit_normals(const host_vertex *vertices, const uint32_t corners[3], float normals[3][3])
{
    for (int i = 0; i < 3; i++) {
        const float *n = vertices[corners[i]].normal, length = sqrtf(fmaxf(dot(n, n), 1e-20f));
        for (int k = 0; k < 3; k++)
            normals[i][k] = n[k] / length;
    }
}

/* Whether the shading normal is too steep everywhere on a triangle, whichever way it is seen from. With pairwise dot
 * products of at least d, the sum of three unit vectors by weights that add up to 1 has a squared length of at least
 * 1 - 2 (1 - d) / 3: by so much its vertical part can grow when it is normalised. */
static bool is_steep(const float normals[3][3])
{
    const float *a = normals[0], *b = normals[1], *c = normals[2];
    const float d = fminf(dot(a, b), fminf(dot(b, c), dot(c, a)));
    const float highest = fmaxf(fabsf(a[1]), fmaxf(fabsf(b[1]), fabsf(c[1])));
    return d > 0.5f && highest < 0.99f * (float)(HOST_LEVEL_Y)*sqrtf(1.0f - 2.0f * (1.0f - d) / 3.0f);
}

/* Whether no shading normal on a triangle is so steep that rain is driven against it: a mean of unit vectors that is
 * normalised rises at least as far as the one that rises least. */
static bool is_level(const float normals[3][3])
{
    return fminf(normals[0][1], fminf(normals[1][1], normals[2][1])) > 1.01f * (float)(HOST_STEEP_Y);
}

typedef enum kind { LEVEL_GROUND, LEVEL, STEEP, KINDS } kind;

/* `at`: the place in the file, so that equal ones keep their order. */
typedef struct triangle {
    kind kind;
    float foot;
    uint32_t at, corners[3];
} triangle;

static int compare(const void *a, const void *b)
{
    const triangle *one = a, *other = b;
    if (one->kind != other->kind)
        return one->kind < other->kind ? -1 : 1;
    if (one->foot != other->foot)
        return one->foot < other->foot ? -1 : 1;
    return one->at < other->at ? -1 : one->at > other->at;
}

static triangle read_triangle(const host_mesh_build *build, const host_primitive *primitive, uint32_t at)
{
    const uint32_t *corners = &build->indices[primitive->first_index + 3 * at];
    const host_vertex *v = build->vertices;
    float normals[3][3];
    triangle t = {.kind = LEVEL, .at = at};
    unit_normals(v, corners, normals);
    memcpy(t.corners, corners, sizeof t.corners);
    if (build->mesh->materials[primitive->material].alpha != HOST_ALPHA_GLASS) /* which stays in its order */
        t.foot = fminf(v[corners[0]].position[1], fminf(v[corners[1]].position[1], v[corners[2]].position[1]));
    if (is_steep((const float(*)[3])normals))
        t.kind = STEEP;
    else if (primitive->ground && is_level((const float(*)[3])normals))
        t.kind = LEVEL_GROUND;
    return t;
}

static void sort_primitive(const host_mesh_build *build, host_primitive *primitive, triangle *triangles)
{
    const uint32_t count = primitive->index_count / 3, first = primitive->first_index / 3;
    uint32_t counts[KINDS] = {0};
    for (uint32_t i = 0; i < count; i++)
        triangles[i] = read_triangle(build, primitive, i);
    qsort(triangles, count, sizeof *triangles, compare);
    for (uint32_t i = 0; i < count; i++) {
        counts[triangles[i].kind] += 3;
        build->mesh->feet[first + i] = triangles[i].foot;
        memcpy(&build->indices[primitive->first_index + 3 * i], triangles[i].corners, sizeof triangles[i].corners);
    }
    primitive->ground_count = counts[LEVEL_GROUND];
    primitive->level_count = counts[LEVEL_GROUND] + counts[LEVEL];
}

bool host_mesh_sort_level(host_mesh_build *build)
{
    triangle *triangles = malloc((build->index_count / 3 + 1) * sizeof *triangles);
    build->mesh->feet = malloc((build->index_count / 3 + 1) * sizeof *build->mesh->feet);
    const bool ok = triangles && build->mesh->feet;
    for (uint32_t i = 0; ok && i < build->mesh->primitive_count; i++) {
        sort_primitive(build, &build->mesh->primitives[i], triangles);
        build->mesh->primitives[i].still = true;
    }
    free(triangles);
    return ok || host_fail(build->error, build->error_size, "%s: out of memory", build->path);
}

uint32_t host_mesh_low_count(const host_mesh *mesh, const host_primitive *primitive, uint32_t first, uint32_t count,
                             float height_m)
{
    const float *lowest, *highest;
    if (!host_mesh_bounds(mesh, primitive, &lowest, &highest))
        return count;
    if (mesh->moves || !mesh->feet)
        return lowest[1] < height_m ? count : 0;
    const float *feet = &mesh->feet[(primitive->first_index + first) / 3];
    uint32_t low = 0, high = count / 3;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (feet[middle] < height_m)
            low = middle + 1;
        else
            high = middle;
    }
    return 3 * low;
}
