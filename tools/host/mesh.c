/* mesh.c - loads a model file, uploads it, and lists its occluders for the rain. */
#include "mesh.h"

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "mesh_geometry.h"

#define SMOOTHING_ANGLE 40.0f /* degrees; generated normals keep sharper edges */

/* ---- cover -------------------------------------------------------------------------------------------------- */

/* Share of a cut-out's surface that its texture keeps, weighted by area, from seven points per triangle. */
static float find_cover(const host_mesh_build *build, const host_primitive *primitive, const host_material *material)
{
    static const float points[7][2] = {{0.33f, 0.33f}, {0.1f, 0.1f},  {0.8f, 0.1f},  {0.1f, 0.8f},
                                       {0.45f, 0.1f},  {0.1f, 0.45f}, {0.45f, 0.45f}};
    const host_picture *picture = &build->pictures[material->base_texture];
    double area_sum = 0.0, covered = 0.0;
    for (uint32_t i = 0; i < primitive->index_count; i += 3) {
        const uint32_t *index = &build->indices[primitive->first_index + i];
        const host_vertex *a = &build->vertices[index[0]], *b = &build->vertices[index[1]],
                          *c = &build->vertices[index[2]];
        double u[3], v[3], area = 0.0;
        for (int k = 0; k < 3; k++) {
            u[k] = (double)b->position[k] - a->position[k];
            v[k] = (double)c->position[k] - a->position[k];
        }
        for (int k = 0; k < 3; k++)
            area += pow(u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3], 2.0);
        area = sqrt(area);
        for (int p = 0; p < 7; p++) {
            float s = points[p][0], t = points[p][1], uv[2];
            for (int k = 0; k < 2; k++)
                uv[k] = a->uv[k] + s * (b->uv[k] - a->uv[k]) + t * (c->uv[k] - a->uv[k]);
            area_sum += area;
            if (host_picture_alpha(picture, uv[0], uv[1]) * material->base_color[3] >= material->cutoff)
                covered += area;
        }
    }
    return area_sum > 0.0 ? (float)(covered / area_sum) : 1.0f;
}

static void find_covers(host_mesh_build *build)
{
    for (uint32_t i = 0; i < build->mesh->primitive_count; i++) {
        host_primitive *primitive = &build->mesh->primitives[i];
        const host_material *material = &build->mesh->materials[primitive->material];
        if (material->alpha == HOST_ALPHA_MASK)
            primitive->cover = find_cover(build, primitive, material);
    }
}

/* ---- onto the device ---------------------------------------------------------------------------------------- */

/* The cutoff of a texture that a cut-out uses, or -1. */
static float picture_cutoff(const host_mesh *mesh, uint32_t picture)
{
    for (uint32_t i = 0; i < mesh->material_count; i++)
        if (mesh->materials[i].base_texture == (int32_t)picture && mesh->materials[i].alpha == HOST_ALPHA_MASK)
            return mesh->materials[i].cutoff;
    return -1.0f;
}

static bool upload_pictures(host_mesh_build *build)
{
    host_mesh *mesh = build->mesh;
    if (mesh->texture_count == 0)
        return true;
    mesh->textures = calloc(mesh->texture_count, sizeof *mesh->textures);
    if (!mesh->textures)
        return host_fail(build->error, build->error_size, "%s: out of memory", build->path);
    for (uint32_t i = 0; i < mesh->texture_count; i++) {
        if (!build->pictures[i].texels)
            continue;
        if (!host_picture_make_mips(&build->pictures[i], picture_cutoff(mesh, i)))
            return host_fail(build->error, build->error_size, "%s: out of memory", build->path);
        if (!host_picture_upload(build->device, &build->pictures[i], build->picture_keys[i], &mesh->textures[i],
                                 build->error, build->error_size))
            return false;
    }
    return true;
}

static bool upload_geometry(host_device *device, host_mesh *mesh, const host_vertex *vertices, uint32_t vertex_count,
                            const uint32_t *indices, uint32_t index_count, char *error, size_t error_size)
{
    mesh->vertex_count = vertex_count;
    mesh->index_count = index_count;
    return host_buffer_create_with(device, vertices, (VkDeviceSize)vertex_count * sizeof *vertices,
                                   VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "mesh vertices", &mesh->vertices, error,
                                   error_size) &&
           host_buffer_create_with(device, indices, (VkDeviceSize)index_count * sizeof *indices,
                                   VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "mesh indices", &mesh->indices, error, error_size);
}

/* ---- loading ------------------------------------------------------------------------------------------------ */

static const struct aiScene *import(const char *path, char *error, size_t error_size)
{
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode)) {
        host_fail(error, error_size, "%s: no such model file", path);
        return NULL;
    }
    struct aiPropertyStore *properties = aiCreatePropertyStore();
    aiSetImportPropertyFloat(properties, AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, SMOOTHING_ANGLE);
    const unsigned flags = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_GenSmoothNormals |
                           aiProcess_JoinIdenticalVertices | aiProcess_TransformUVCoords | aiProcess_FlipUVs |
                           aiProcess_ImproveCacheLocality;
    const struct aiScene *scene = aiImportFileExWithProperties(path, flags, NULL, properties);
    aiReleasePropertyStore(properties);
    if (!scene)
        host_fail(error, error_size, "%s: cannot be read as a model: %s", path, aiGetErrorString());
    else if (!scene->mRootNode || scene->mNumMeshes == 0) {
        host_fail(error, error_size, "%s: holds no triangles", path);
        aiReleaseImport(scene);
        scene = NULL;
    }
    return scene;
}

static bool run_build(host_mesh_build *build, const float world_from_model[12])
{
    if (!host_mesh_build_materials(build) || !host_mesh_build_geometry(build, world_from_model))
        return false;
    find_covers(build);
    return upload_pictures(build) && host_mesh_cut_feet(build) && host_mesh_sort_level(build) &&
           upload_geometry(build->device, build->mesh, build->vertices, build->vertex_count, build->indices,
                           build->index_count, build->error, build->error_size);
}

static void end_build(host_mesh_build *build)
{
    for (uint32_t i = 0; i < build->mesh->texture_count; i++) {
        host_picture_free(&build->pictures[i]);
        free(build->picture_keys[i]);
    }
    free(build->pictures);
    free(build->picture_keys);
    free(build->vertices);
    free(build->indices);
}

bool host_mesh_load_kept(host_device *device, const char *path, const float world_from_model[12], host_mesh *mesh,
                         host_vertex **vertices, uint32_t **indices, char *error, size_t error_size)
{
    memset(mesh, 0, sizeof *mesh);
    *vertices = NULL;
    *indices = NULL;
    const struct aiScene *scene = import(path, error, error_size);
    if (!scene)
        return false;
    host_mesh_build build = {
        .device = device, .scene = scene, .path = path, .mesh = mesh, .error = error, .error_size = error_size};
    mesh->path = strdup(path);
    bool ok = run_build(&build, world_from_model);
    if (ok) {
        *vertices = build.vertices;
        *indices = build.indices;
        build.vertices = NULL;
        build.indices = NULL;
    }
    end_build(&build);
    aiReleaseImport(scene);
    if (!ok)
        host_mesh_destroy(device, mesh);
    return ok;
}

bool host_mesh_load(host_device *device, const char *path, const float world_from_model[12], host_mesh *mesh,
                    char *error, size_t error_size)
{
    host_vertex *vertices;
    uint32_t *indices;
    const bool ok = host_mesh_load_kept(device, path, world_from_model, mesh, &vertices, &indices, error, error_size);
    free(vertices);
    free(indices);
    return ok;
}

/* Appends the corners of a primitive's triangles, without sharing vertices. */
static void copy_primitive(const host_mesh_build *build, const host_primitive *primitive, host_vertex *vertices,
                           uint32_t *indices, uint32_t *count)
{
    for (uint32_t i = 0; i < primitive->index_count; i++, ++*count) {
        vertices[*count] = build->vertices[build->indices[primitive->first_index + i]];
        indices[*count] = *count;
    }
}

static bool read_named(const host_mesh_build *build, const char *name, host_vertex **vertices, uint32_t **indices,
                       uint32_t *count)
{
    *vertices = malloc((build->index_count + 1) * sizeof **vertices);
    *indices = malloc((build->index_count + 1) * sizeof **indices);
    if (!*vertices || !*indices)
        return host_fail(build->error, build->error_size, "%s: out of memory", build->path);
    for (uint32_t i = 0; i < build->mesh->primitive_count; i++) {
        const host_primitive *primitive = &build->mesh->primitives[i];
        if (host_name_contains(primitive->name, name) ||
            host_name_contains(build->mesh->materials[primitive->material].name, name))
            copy_primitive(build, primitive, *vertices, *indices, count);
    }
    return true;
}

bool host_mesh_read(host_device *device, const char *path, const float world_from_model[12], const char *name,
                    host_vertex **vertices, uint32_t **indices, uint32_t *count, char *error, size_t error_size)
{
    host_mesh mesh = {0};
    *vertices = NULL;
    *indices = NULL;
    *count = 0;
    const struct aiScene *scene = import(path, error, error_size);
    if (!scene)
        return false;
    host_mesh_build build = {
        .device = device, .scene = scene, .path = path, .mesh = &mesh, .error = error, .error_size = error_size};
    bool ok = host_mesh_build_materials(&build) && host_mesh_build_geometry(&build, world_from_model);
    ok = ok && read_named(&build, name, vertices, indices, count);
    end_build(&build);
    aiReleaseImport(scene);
    free(mesh.materials);
    free(mesh.primitives);
    if (!ok) {
        free(*vertices);
        free(*indices);
    }
    return ok;
}

bool host_mesh_bounds(const host_mesh *mesh, const host_primitive *primitive, const float **low, const float **high)
{
    *low = mesh->moves ? mesh->low : primitive->low;
    *high = mesh->moves ? mesh->high : primitive->high;
    return !mesh->apart && (mesh->moves || primitive->still);
}

void host_mesh_move(VkCommandBuffer cmd, const host_mesh *mesh, const host_vertex *vertices)
{
    host_buffer_update(cmd, &mesh->vertices, vertices, mesh->vertex_count * sizeof *vertices,
                       VK_PIPELINE_STAGE_VERTEX_INPUT_BIT, VK_ACCESS_VERTEX_ATTRIBUTE_READ_BIT);
}

bool host_mesh_create(host_device *device, const host_vertex *vertices, uint32_t vertex_count, const uint32_t *indices,
                      uint32_t index_count, const host_material *material, host_mesh *mesh, char *error,
                      size_t error_size)
{
    memset(mesh, 0, sizeof *mesh);
    mesh->materials = calloc(1, sizeof *mesh->materials);
    mesh->primitives = calloc(1, sizeof *mesh->primitives);
    if (!mesh->materials || !mesh->primitives) {
        host_mesh_destroy(device, mesh);
        return host_fail(error, error_size, "mesh: out of memory");
    }
    mesh->materials[0] = *material;
    mesh->materials[0].base_texture = mesh->materials[0].emissive_texture = -1;
    mesh->primitives[0] = (host_primitive){.index_count = index_count, .level_count = index_count, .cover = 1.0f};
    memcpy(mesh->primitives[0].name, material->name, sizeof mesh->primitives[0].name);
    mesh->primitives[0].surface = host_guess_material(material->name);
    mesh->primitives[0].ground = host_is_ground(material->name, mesh->primitives[0].surface);
    mesh->material_count = mesh->primitive_count = 1;
    for (int c = 0; c < 3; c++) {
        mesh->low[c] = FLT_MAX;
        mesh->high[c] = -FLT_MAX;
        for (uint32_t i = 0; i < vertex_count; i++) {
            mesh->low[c] = fminf(mesh->low[c], vertices[i].position[c]);
            mesh->high[c] = fmaxf(mesh->high[c], vertices[i].position[c]);
        }
        mesh->primitives[0].low[c] = mesh->low[c];
        mesh->primitives[0].high[c] = mesh->high[c];
    }
    if (upload_geometry(device, mesh, vertices, vertex_count, indices, index_count, error, error_size))
        return true;
    host_mesh_destroy(device, mesh);
    return false;
}

void host_mesh_destroy(host_device *device, host_mesh *mesh)
{
    for (uint32_t i = 0; mesh->textures && i < mesh->texture_count; i++)
        host_image_destroy(device, &mesh->textures[i]);
    host_buffer_destroy(device, &mesh->vertices);
    host_buffer_destroy(device, &mesh->indices);
    free(mesh->textures);
    free(mesh->materials);
    free(mesh->primitives);
    free(mesh->feet);
    free(mesh->path);
    memset(mesh, 0, sizeof *mesh);
}

uint32_t host_mesh_occluders(const host_mesh *mesh, virga_occluder *occluders, uint32_t capacity)
{
    for (uint32_t i = 0; i < mesh->primitive_count && i < capacity; i++) {
        const host_primitive *primitive = &mesh->primitives[i];
        occluders[i] = (virga_occluder){
            .vertices = mesh->vertices.buffer,
            .vertex_stride = sizeof(host_vertex),
            .indices = mesh->indices.buffer,
            .index_offset = (VkDeviceSize)primitive->first_index * sizeof(uint32_t),
            .index_type = VK_INDEX_TYPE_UINT32,
            .index_count = primitive->index_count,
            .world_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
            .material = primitive->surface,
            .ground = primitive->ground,
            .cover = primitive->cover > 0.01f ? primitive->cover : 0.01f, /* 0 means 1 */
        };
    }
    return mesh->primitive_count;
}
