/* mesh_geometry.c - walks the nodes of a model, transforms triangles into the world and replaces missing data. */
#include "mesh_geometry.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_DEPTH 256 /* of nested nodes */

/* ---- transforms --------------------------------------------------------------------------------------------- */

/* 3 x 4, row-major. */
typedef struct affine {
    float m[12];
} affine;

static affine affine_from(const struct aiMatrix4x4 *t)
{
    return (affine){{t->a1, t->a2, t->a3, t->a4, t->b1, t->b2, t->b3, t->b4, t->c1, t->c2, t->c3, t->c4}};
}

static affine affine_multiply(const affine *a, const affine *b)
{
    affine out;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            float sum = column == 3 ? a->m[row * 4 + 3] : 0.0f;
            for (int k = 0; k < 3; k++)
                sum += a->m[row * 4 + k] * b->m[k * 4 + column];
            out.m[row * 4 + column] = sum;
        }
    return out;
}

/* Cofactors of the 3 x 3 part, which transform normals correctly under any scale. Returns the determinant. */
static float cofactors(const affine *a, float c[9])
{
    const float *m = a->m;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
            c[row * 3 + column] = m[r1 * 4 + c1] * m[r2 * 4 + c2] - m[r1 * 4 + c2] * m[r2 * 4 + c1];
        }
    return m[0] * c[0] + m[1] * c[1] + m[2] * c[2];
}

/* ---- vertices ----------------------------------------------------------------------------------------------- */

static bool normalize(float v[3])
{
    float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 1e-20f) || !isfinite(length))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

static bool add_vertices(host_mesh_build *build, const struct aiMesh *mesh, const affine *world)
{
    float c[9];
    float sign = cofactors(world, c) < 0.0f ? -1.0f : 1.0f;
    for (uint32_t i = 0; i < mesh->mNumVertices; i++) {
        host_vertex *v = &build->vertices[build->vertex_count + i];
        const struct aiVector3D *p = &mesh->mVertices[i];
        memset(v, 0, sizeof *v);
        for (int row = 0; row < 3; row++) {
            const float *m = &world->m[row * 4];
            v->position[row] = m[0] * p->x + m[1] * p->y + m[2] * p->z + m[3];
            if (!isfinite(v->position[row]))
                return host_fail(build->error, build->error_size,
                                 "%s: mesh \"%s\": position of vertex %u is not a finite number", build->path,
                                 mesh->mName.data, i);
        }
        if (mesh->mNormals) {
            const struct aiVector3D *n = &mesh->mNormals[i];
            for (int row = 0; row < 3; row++)
                v->normal[row] = sign * (c[row * 3] * n->x + c[row * 3 + 1] * n->y + c[row * 3 + 2] * n->z);
        }
        if (!normalize(v->normal))
            memset(v->normal, 0, sizeof v->normal); /* computed from its triangles below */
        const struct aiVector3D *uv = mesh->mTextureCoords[0] ? &mesh->mTextureCoords[0][i] : NULL;
        if (uv && isfinite(uv->x) && isfinite(uv->y)) {
            v->uv[0] = uv->x;
            v->uv[1] = uv->y;
        }
    }
    return true;
}

/* Adds the triangles of a mesh and returns the number of indices. If the transform mirrors, the winding is reversed. */
static uint32_t add_indices(host_mesh_build *build, const struct aiMesh *mesh, bool mirrored)
{
    uint32_t added = 0;
    for (uint32_t i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices != 3)
            continue;
        uint32_t a = face->mIndices[0], b = face->mIndices[mirrored ? 2 : 1], c = face->mIndices[mirrored ? 1 : 2];
        if (a >= mesh->mNumVertices || b >= mesh->mNumVertices || c >= mesh->mNumVertices)
            continue;
        uint32_t *out = &build->indices[build->index_count + added];
        out[0] = build->vertex_count + a;
        out[1] = build->vertex_count + b;
        out[2] = build->vertex_count + c;
        added += 3;
    }
    return added;
}

/* Missing and invalid normals become the area-weighted mean of the adjacent triangles, or up if that is zero. */
static void repair_normals(host_vertex *vertices, uint32_t first_vertex, uint32_t vertex_count, const uint32_t *indices,
                           uint32_t index_count)
{
    uint32_t broken = 0;
    for (uint32_t i = first_vertex; i < first_vertex + vertex_count; i++) {
        const float *n = vertices[i].normal;
        if (n[0] == 0.0f && n[1] == 0.0f && n[2] == 0.0f) {
            vertices[i].normal[0] = NAN; /* marks it as invalid */
            broken++;
        }
    }
    if (broken == 0)
        return;
    float(*sums)[3] = calloc(vertex_count, sizeof *sums);
    for (uint32_t i = 0; sums && i < index_count; i += 3) {
        const float *a = vertices[indices[i]].position, *b = vertices[indices[i + 1]].position,
                    *c = vertices[indices[i + 2]].position;
        float u[3], v[3];
        for (int k = 0; k < 3; k++) {
            u[k] = b[k] - a[k];
            v[k] = c[k] - a[k];
        }
        for (int corner = 0; corner < 3; corner++)
            for (int k = 0; k < 3; k++)
                sums[indices[i + (uint32_t)corner] - first_vertex][k] +=
                    u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
    for (uint32_t i = 0; i < vertex_count; i++) {
        float *n = vertices[first_vertex + i].normal;
        if (!isnan(n[0]))
            continue;
        n[0] = n[2] = 0.0f;
        n[1] = 1.0f;
        if (sums && normalize(sums[i]))
            memcpy(n, sums[i], sizeof sums[i]);
    }
    free(sums);
}

/* ---- primitives --------------------------------------------------------------------------------------------- */

/* The plane y = a + slope[0] x + slope[1] z of least squares. Level, where the vertices stand in a line. */
static void find_plane(const host_vertex *vertices, uint32_t count, host_primitive *out)
{
    double mean[3] = {0}, off = 0, xx = 0, xz = 0, zz = 0, xy = 0, zy = 0;
    for (uint32_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            mean[c] += (double)vertices[i].position[c] / count;
    for (uint32_t i = 0; i < count; i++) {
        const double x = (double)vertices[i].position[0] - mean[0], y = (double)vertices[i].position[1] - mean[1],
                     z = (double)vertices[i].position[2] - mean[2];
        xx += x * x, xz += x * z, zz += z * z, xy += x * y, zy += z * y;
    }
    const double det = xx * zz - xz * xz;
    const bool flat = det > 1e-9 * xx * zz;
    const double slope[2] = {flat ? (xy * zz - zy * xz) / det : 0, flat ? (zy * xx - xy * xz) / det : 0};
    for (uint32_t i = 0; i < count; i++) {
        const float *at = vertices[i].position;
        const double plane = mean[1] + slope[0] * ((double)at[0] - mean[0]) + slope[1] * ((double)at[2] - mean[2]);
        off = fmax(off, fabs((double)at[1] - plane));
    }
    for (int c = 0; c < 3; c++)
        out->middle[c] = (float)mean[c];
    for (int i = 0; i < 2; i++)
        out->slope[i] = (float)slope[i];
    out->off = (float)off;
}

static void find_bounds(const host_vertex *vertices, uint32_t count, float low[3], float high[3])
{
    for (int c = 0; c < 3; c++) {
        low[c] = FLT_MAX;
        high[c] = -FLT_MAX;
        for (uint32_t i = 0; i < count; i++) {
            low[c] = fminf(low[c], vertices[i].position[c]);
            high[c] = fmaxf(high[c], vertices[i].position[c]);
        }
    }
}

static bool add_primitive(host_mesh_build *build, const struct aiNode *node, uint32_t mesh_index, const affine *world)
{
    const struct aiMesh *mesh = build->scene->mMeshes[mesh_index];
    float c[9];
    if (!(mesh->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) || mesh->mNumVertices == 0)
        return true;
    if (!add_vertices(build, mesh, world))
        return false;
    uint32_t index_count = add_indices(build, mesh, cofactors(world, c) < 0.0f);
    if (index_count == 0)
        return true; /* the next mesh overwrites its vertices */

    host_primitive *primitive = &build->mesh->primitives[build->primitive_count];
    memset(primitive, 0, sizeof *primitive);
    const char *name = mesh->mName.length ? mesh->mName.data : node->mName.data;
    snprintf(primitive->name, sizeof primitive->name, "%.*s", (int)sizeof primitive->name - 1, name);
    primitive->first_index = build->index_count;
    primitive->index_count = index_count;
    primitive->material = mesh->mMaterialIndex < build->mesh->material_count ? mesh->mMaterialIndex : 0;
    primitive->cover = 1.0f;
    primitive->surface = host_guess_material(build->mesh->materials[primitive->material].name);
    if (primitive->surface == 0)
        primitive->surface = host_guess_material(mesh->mName.data);
    if (primitive->surface == 0)
        primitive->surface = host_guess_material(node->mName.data);
    primitive->ground = host_is_ground(primitive->name, primitive->surface);
    repair_normals(build->vertices, build->vertex_count, mesh->mNumVertices, build->indices + build->index_count,
                   index_count);
    find_bounds(build->vertices + build->vertex_count, mesh->mNumVertices, primitive->low, primitive->high);
    find_plane(build->vertices + build->vertex_count, mesh->mNumVertices, primitive);
    build->vertex_count += mesh->mNumVertices;
    build->index_count += index_count;
    build->primitive_count++;
    return true;
}

/* Counts (while `vertices` is NULL) or adds everything under a node. */
typedef struct totals {
    uint64_t vertices, indices, primitives;
} totals;

static void count_node(const struct aiScene *scene, const struct aiNode *node, totals *sum, int depth)
{
    for (uint32_t i = 0; i < node->mNumMeshes; i++) {
        const struct aiMesh *mesh = scene->mMeshes[node->mMeshes[i]];
        sum->vertices += mesh->mNumVertices;
        sum->indices += (uint64_t)mesh->mNumFaces * 3;
        sum->primitives++;
    }
    for (uint32_t i = 0; i < node->mNumChildren && depth < MAX_DEPTH; i++)
        count_node(scene, node->mChildren[i], sum, depth + 1);
}

static bool add_node(host_mesh_build *build, const struct aiNode *node, const affine *parent, int depth)
{
    affine local = affine_from(&node->mTransformation);
    affine world = affine_multiply(parent, &local);
    for (uint32_t i = 0; i < node->mNumMeshes; i++)
        if (!add_primitive(build, node, node->mMeshes[i], &world))
            return false;
    for (uint32_t i = 0; i < node->mNumChildren && depth < MAX_DEPTH; i++)
        if (!add_node(build, node->mChildren[i], &world, depth + 1))
            return false;
    return true;
}

bool host_mesh_build_geometry(host_mesh_build *build, const float world_from_model[12])
{
    static const affine identity = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    affine world = identity;
    if (world_from_model)
        memcpy(world.m, world_from_model, sizeof world.m);

    totals sum = {0, 0, 0};
    count_node(build->scene, build->scene->mRootNode, &sum, 0);
    if (sum.indices > UINT32_MAX / 4 || sum.vertices > UINT32_MAX / 4)
        return host_fail(build->error, build->error_size, "%s: too many triangles", build->path);
    build->vertices = calloc(sum.vertices + 1, sizeof *build->vertices);
    build->indices = calloc(sum.indices + 1, sizeof *build->indices);
    build->mesh->primitives = calloc(sum.primitives + 1, sizeof *build->mesh->primitives);
    if (!build->vertices || !build->indices || !build->mesh->primitives)
        return host_fail(build->error, build->error_size, "%s: out of memory", build->path);
    if (!add_node(build, build->scene->mRootNode, &world, 0))
        return false;
    if (build->primitive_count == 0)
        return host_fail(build->error, build->error_size, "%s: holds no triangles", build->path);
    build->mesh->primitive_count = build->primitive_count;
    find_bounds(build->vertices, build->vertex_count, build->mesh->low, build->mesh->high);
    return true;
}
