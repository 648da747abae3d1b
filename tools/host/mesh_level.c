/* mesh_level.c - finds the triangles of a model that are too steep for water. */
#include "mesh_geometry.h"
#include "shaders/frame_gpu.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Whether the shading normal is too steep everywhere on a triangle, whichever way it is seen from. With pairwise dot
 * products of at least d, the sum of three unit vectors by weights that add up to 1 has a squared length of at least
 * 1 - 2 (1 - d) / 3: by so much its vertical part can grow when it is normalised. */
static bool is_steep(const host_vertex *vertices, const uint32_t corners[3])
{
    const float *a = vertices[corners[0]].normal, *b = vertices[corners[1]].normal, *c = vertices[corners[2]].normal;
    const float d = fminf(dot(a, b), fminf(dot(b, c), dot(c, a)));
    const float highest = fmaxf(fabsf(a[1]), fmaxf(fabsf(b[1]), fabsf(c[1])));
    return d > 0.5f && highest < 0.99f * (float)(HOST_LEVEL_Y)*sqrtf(1.0f - 2.0f * (1.0f - d) / 3.0f);
}

/* The others first; otherwise the order stays. */
static void sort_primitive(const host_mesh_build *build, host_primitive *primitive, uint32_t *steep)
{
    uint32_t *indices = &build->indices[primitive->first_index], level_count = 0, steep_count = 0;
    for (uint32_t i = 0; i < primitive->index_count; i += 3) {
        const bool is = is_steep(build->vertices, &indices[i]);
        memmove(is ? &steep[steep_count] : &indices[level_count], &indices[i], 3 * sizeof *indices);
        steep_count += is ? 3 : 0;
        level_count += is ? 0 : 3;
    }
    memcpy(&indices[level_count], steep, steep_count * sizeof *indices);
    primitive->level_count = level_count;
}

bool host_mesh_sort_level(host_mesh_build *build)
{
    uint32_t *steep = malloc((build->index_count + 1) * sizeof *steep);
    if (!steep)
        return host_fail(build->error, build->error_size, "%s: out of memory", build->path);
    for (uint32_t i = 0; i < build->mesh->primitive_count; i++) {
        sort_primitive(build, &build->mesh->primitives[i], steep);
        build->mesh->primitives[i].still = true;
    }
    free(steep);
    return true;
}
