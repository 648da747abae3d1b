/* mesh_cut.c - cuts the triangles of a model in two a little above its ground. What shades the foot of a wall, where
 * water climbs it, costs half as much again, and walls are often two triangles from the ground to the eaves. */
#include "mesh_geometry.h"
#include "shaders/frame_gpu.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_GROUND 0.98 /* of its area, seen from above: what is higher is a bridge, a table */

typedef struct piece {
    float top_m, area; /* (area: seen from above, twice) */
} piece;

static int compare(const void *a, const void *b)
{
    const piece *one = a, *other = b;
    return (one->top_m > other->top_m) - (one->top_m < other->top_m);
}

static piece piece_of(const host_vertex *vertices, const uint32_t corners[3])
{
    const float *a = vertices[corners[0]].position, *b = vertices[corners[1]].position,
                *c = vertices[corners[2]].position;
    return (piece){.top_m = fmaxf(a[1], fmaxf(b[1], c[1])),
                   .area = fabsf((b[0] - a[0]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[0] - a[0]))};
}

/* The height that most of the ground is below. `pieces` has room for all triangles. False: there is no ground. */
static bool find_ground(const host_mesh_build *build, piece *pieces, float *height)
{
    size_t count = 0;
    double area = 0, below = 0;
    for (uint32_t i = 0; i < build->mesh->primitive_count; i++) {
        const host_primitive *primitive = &build->mesh->primitives[i];
        for (uint32_t k = 0; primitive->ground && k < primitive->index_count; k += 3) {
            pieces[count] = piece_of(build->vertices, &build->indices[primitive->first_index + k]);
            area += (double)pieces[count++].area;
        }
    }
    qsort(pieces, count, sizeof *pieces, compare);
    for (size_t i = 0; i < count && below <= MOST_GROUND * area; i++) {
        below += (double)pieces[i].area;
        *height = pieces[i].top_m;
    }
    return area > 0;
}

/* Corners of a triangle, turned so that the first is alone on its side of the height. False: it is on one side. */
static bool find_alone(const host_vertex *vertices, const uint32_t corners[3], float height, uint32_t turned[3])
{
    bool above[3];
    for (int i = 0; i < 3; i++)
        above[i] = vertices[corners[i]].position[1] > height;
    if (above[0] == above[1] && above[1] == above[2])
        return false;
    const int alone = above[1] == above[2] ? 0 : above[0] == above[2] ? 1 : 2;
    for (int i = 0; i < 3; i++)
        turned[i] = corners[(alone + i) % 3];
    return true;
}

/* The point of an edge at that height. From the lower end to the upper one, so that both triangles at an edge come to
 * the same bits, and there is no gap between them. The normal is shorter than 1: normals between the points are as
 * before. */
static host_vertex point_on_edge(const host_vertex *a, const host_vertex *b, float height)
{
    const bool rises = a->position[1] < b->position[1];
    const host_vertex *low = rises ? a : b, *high = rises ? b : a;
    const float t = (height - low->position[1]) / (high->position[1] - low->position[1]);
    host_vertex v;
    for (int i = 0; i < 3; i++) {
        v.position[i] = low->position[i] + t * (high->position[i] - low->position[i]);
        v.normal[i] = low->normal[i] + t * (high->normal[i] - low->normal[i]);
    }
    for (int i = 0; i < 2; i++)
        v.uv[i] = low->uv[i] + t * (high->uv[i] - low->uv[i]);
    v.position[1] = height;
    return v;
}

/* One triangle becomes one on the side of its first corner, and two on the other. */
static void cut(host_mesh_build *build, const uint32_t corners[3], float height, uint32_t *indices, uint32_t *count)
{
    const uint32_t right = build->vertex_count, left = right + 1;
    host_vertex *v = build->vertices;
    v[right] = point_on_edge(&v[corners[0]], &v[corners[1]], height);
    v[left] = point_on_edge(&v[corners[0]], &v[corners[2]], height);
    build->vertex_count += 2;
    const uint32_t parts[9] = {corners[0], right, left, right, corners[1], corners[2], right, corners[2], left};
    memcpy(&indices[*count], parts, sizeof parts);
    *count += 9;
}

static void cut_primitive(host_mesh_build *build, host_primitive *primitive, float height, uint32_t *indices,
                          uint32_t *count)
{
    const uint32_t first = *count, *from = &build->indices[primitive->first_index];
    for (uint32_t i = 0; i < primitive->index_count; i += 3) {
        uint32_t turned[3];
        if (find_alone(build->vertices, &from[i], height, turned)) {
            cut(build, turned, height, indices, count);
            continue;
        }
        memcpy(&indices[*count], &from[i], 3 * sizeof *indices);
        *count += 3;
    }
    primitive->first_index = first;
    primitive->index_count = *count - first;
}

static uint32_t count_cuts(const host_mesh_build *build, float height)
{
    uint32_t cuts = 0, turned[3];
    for (uint32_t i = 0; i < build->index_count; i += 3)
        cuts += find_alone(build->vertices, &build->indices[i], height, turned);
    return cuts;
}

/* `cuts` in all. */
static bool cut_all(host_mesh_build *build, float height, uint32_t cuts)
{
    host_vertex *vertices = realloc(build->vertices, (build->vertex_count + 2 * (size_t)cuts + 1) * sizeof *vertices);
    uint32_t *indices = malloc((build->index_count + 6 * (size_t)cuts + 1) * sizeof *indices), count = 0;
    build->vertices = vertices ? vertices : build->vertices;
    if (!vertices || !indices) {
        free(indices);
        return host_fail(build->error, build->error_size, "%s: out of memory", build->path);
    }
    for (uint32_t i = 0; i < build->mesh->primitive_count; i++)
        cut_primitive(build, &build->mesh->primitives[i], height, indices, &count);
    free(build->indices);
    build->indices = indices;
    build->index_count = count;
    return true;
}

bool host_mesh_cut_feet(host_mesh_build *build)
{
    float height = 0;
    piece *pieces = malloc((build->index_count / 3 + 1) * sizeof *pieces);
    if (!pieces)
        return host_fail(build->error, build->error_size, "%s: out of memory", build->path);
    const bool has_ground = find_ground(build, pieces, &height);
    free(pieces);
    if (!has_ground)
        return true;
    height += (float)(HOST_CLIMB_CUT_M);
    return cut_all(build, height, count_cuts(build, height));
}
