/* mesh.h - a model file as one vertex and one index buffer, with materials and textures. */
#ifndef VIRGA_HOST_MESH_H
#define VIRGA_HOST_MESH_H

#include <virga/rain.h>

#include "materials.h"
#include "memory.h"

typedef struct host_vertex {
    float position[3]; /* in the world: transforms are applied while loading */
    float normal[3];   /* unit length */
    float uv[2];
} host_vertex;

typedef enum host_alpha {
    HOST_ALPHA_OPAQUE = 0,
    HOST_ALPHA_MASK = 1,  /* cut out below the cutoff */
    HOST_ALPHA_GLASS = 2, /* thin glass: transparent, with reflections */
    HOST_ALPHA_SWEPT = 3, /* opaque, and moves while the shutter is open: see swept.h. Needs independent blending */
} host_alpha;

typedef struct host_material {
    char name[96];
    float base_color[4]; /* linear, times the texture's */
    float emissive[3];   /* radiance, times the texture's */
    float roughness, metallic;
    float passes;     /* [0; 1] part of its diffuse light that comes out of the other side: of cloth, and of leaves */
    float sky_passes; /* [0; 1] part of the sky's light that comes through, its colours' mean: `passes` of what it is */
    float cutoff;     /* (mask) */
    host_alpha alpha;
    bool two_sided;
    int32_t base_texture;     /* into host_mesh::textures, or -1 */
    int32_t emissive_texture; /* likewise */
    bool joints;              /* the base texture's alpha is that of host_picture_add_joints */
} host_material;

typedef struct host_primitive {
    char name[96]; /* of the mesh, or of its node */
    uint32_t first_index, index_count;
    uint32_t level_count;  /* the first indices: triangles that water may lie on. The others are too steep for it ... */
    uint32_t ground_count; /* ... the first of the first: of ground so level that no rain is driven against it */
    bool still;            /* its vertices do not move: the bounds hold */
    uint32_t material;     /* into host_mesh::materials */
    uint32_t surface;      /* host_guess_material of its names: what drops land on */
    bool ground;           /* host_is_ground of its name */
    float cover;           /* share of the surface that is not cut out; 1 for opaque materials */
    float low[3], high[3]; /* bounds */
    float middle[3];       /* mean of its vertices ... */
    float slope[2];        /* ... and slopes of the plane through them (least squares of y): along x, along z ... */
    float off;             /* ... and the farthest of them from it, along y */
} host_primitive;

typedef struct host_mesh {
    char *path;
    host_buffer vertices, indices; /* host_vertex, and uint32 from the first vertex on */
    uint32_t vertex_count, index_count;
    host_primitive *primitives;
    uint32_t primitive_count;
    /* Of triangle i (indices from 3 i on): its lowest height (m); not of glass. In a primitive it rises from one
     * triangle to the next of the same kind. NULL: not known */
    float *feet;
    host_material *materials;
    uint32_t material_count;
    host_image *textures;
    uint32_t texture_count;
    float low[3], high[3];
    bool apart;     /* moves with the camera: it casts no shade in the skylight and is not mirrored. Default false */
    bool moves;     /* it casts no shade in the skylight, made once; who moves it sets low and high. Default false */
    float travel_m; /* how far its points go at most while the shutter is open; who moves it sets it. Default 0 */
} host_mesh;

/* Loads a model. `world_from_model` is 3 x 4, row-major, and may be NULL. Missing normals and UVs are replaced; so are
 * missing textures, with a warning. Everything else is an error. */
bool host_mesh_load(host_device *device, const char *path, const float world_from_model[12], host_mesh *mesh,
                    char *error, size_t error_size);

/* The same, and hands over its vertices and indices on the host, to be freed by free(): for a mesh that moves. */
bool host_mesh_load_kept(host_device *device, const char *path, const float world_from_model[12], host_mesh *mesh,
                         host_vertex **vertices, uint32_t **indices, char *error, size_t error_size);

/* Creates a mesh of one opaque primitive from memory. */
bool host_mesh_create(host_device *device, const host_vertex *vertices, uint32_t vertex_count, const uint32_t *indices,
                      uint32_t index_count, const host_material *material, host_mesh *mesh, char *error,
                      size_t error_size);

/* Where all of a primitive is (m). False: it is not known, as it moves with the camera, or in a way that only who made
 * it knows. */
bool host_mesh_bounds(const host_mesh *mesh, const host_primitive *primitive, const float **low, const float **high);

/* How many of `count` indices of a primitive, from `first` on, are of triangles that begin below a height: those come
 * first. The indices are all of one kind: see host_primitive. If it is not known, all, or none of a mesh that moves and
 * is higher. */
uint32_t host_mesh_low_count(const host_mesh *mesh, const host_primitive *primitive, uint32_t first, uint32_t count,
                             float height_m);

/* Records an update of all vertices. Outside a render pass. */
void host_mesh_move(VkCommandBuffer cmd, const host_mesh *mesh, const host_vertex *vertices);

/* Reads the triangles of primitives whose name, or the name of their material, contains `name`, in any case: `count`
 * vertices and indices, to be freed by free(). V runs from the top row of a picture down. If nothing matches, *count is
 * 0, which is no error. */
bool host_mesh_read(host_device *device, const char *path, const float world_from_model[12], const char *name,
                    host_vertex **vertices, uint32_t **indices, uint32_t *count, char *error, size_t error_size);

void host_mesh_destroy(host_device *device, host_mesh *mesh);

/* Fills up to `capacity` occluders, one for each primitive, and returns their total number. Glass stops drops too. */
uint32_t host_mesh_occluders(const host_mesh *mesh, virga_occluder *occluders, uint32_t capacity);

#endif
