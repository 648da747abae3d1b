/* mesh_geometry.h - shared by mesh.c, mesh_geometry.c and mesh_material.c while a file is loaded. */
#ifndef VIRGA_HOST_MESH_GEOMETRY_H
#define VIRGA_HOST_MESH_GEOMETRY_H

#include <assimp/scene.h>

#include "gltf.h"
#include "mesh.h"
#include "texture.h"

typedef struct host_mesh_build {
    host_device *device;
    const struct aiScene *scene;
    const char *path;
    host_gltf *gltf; /* while materials are read; NULL if the file is no glTF */
    host_mesh *mesh;
    host_vertex *vertices;
    uint32_t *indices;
    uint32_t vertex_count, index_count, primitive_count; /* filled so far */
    host_picture *pictures; /* as many as mesh->textures, without mips until all materials are read */
    char **picture_keys;
    char *error;
    size_t error_size;
} host_mesh_build;

/* Fills vertices, indices and primitives from all nodes of the scene. */
bool host_mesh_build_geometry(host_mesh_build *build, const float world_from_model[12]);

/* Cuts triangles in two where they rise through HOST_CLIMB_CUT_M above most of the model's ground, unless it has none:
 * what water may climb is then a small part of a wall. */
bool host_mesh_cut_feet(host_mesh_build *build);

/* Sorts the indices of each primitive by kind of triangle (host_primitive.level_count), then by host_mesh.feet. */
bool host_mesh_sort_level(host_mesh_build *build);

/* Fills materials and pictures. */
bool host_mesh_build_materials(host_mesh_build *build);

#endif
