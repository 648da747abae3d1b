/* mesh_file.c - the triangle mesh of the newest step, for the program's files. */
#include "water_state.h"

#include "point_columns.h"
#include "water/mesh.h"

#include <math.h>
#include <stdlib.h>

static const ply_property vertex_columns[] = {
    {"x", PLY_FLOAT, POINT_COLUMN(mesh_vertex, position, 0)},
    {"y", PLY_FLOAT, POINT_COLUMN(mesh_vertex, position, 1)},
    {"z", PLY_FLOAT, POINT_COLUMN(mesh_vertex, position, 2)},
    {"vx", PLY_FLOAT, POINT_COLUMN(mesh_vertex, velocity, 0)},
    {"vy", PLY_FLOAT, POINT_COLUMN(mesh_vertex, velocity, 1)},
    {"vz", PLY_FLOAT, POINT_COLUMN(mesh_vertex, velocity, 2)},
    {"nx", PLY_FLOAT, POINT_COLUMN(mesh_vertex, normal, 0)},
    {"ny", PLY_FLOAT, POINT_COLUMN(mesh_vertex, normal, 1)},
    {"nz", PLY_FLOAT, POINT_COLUMN(mesh_vertex, normal, 2)},
};

static bool make_mesh(const scene_file *scene, const water_state *state, const virga_particle_gpu *particles,
                      uint32_t count, water_mesh *mesh)
{
    const scene_water *from = scene_water_of(scene);
    const field_def def = {.particles = particles,
                           .count = count,
                           .spacing_m = state->source.spacing_m,
                           .volume_m3 = from->volume * pow(state->source.spacing_m, 3),
                           .kernel_spacings = from->kernel_spacings};
    field made;
    const bool ok = field_create(&made, &def) && water_mesh_create(mesh, &made, from->level);
    field_destroy(&made);
    return ok;
}

static bool make(shot *s, void *state, tool_mesh_data *data, char *error, size_t error_size)
{
    water_state *p = state;
    const scene_water *from = scene_water_of(s->scene);
    uint32_t count;
    water_mesh mesh = {0};
    virga_particle_gpu *particles = water_copy_particles(s, p, &count, error, error_size);
    if (!particles)
        return false;
    const bool ok = make_mesh(s->scene, p, particles, count, &mesh);
    free(particles);
    if (!ok)
        return host_fail(error, error_size, "no memory for the mesh of %u particles", count);
    for (uint32_t i = 0; i < mesh.vertex_count; i++)
        for (int axis = 0; axis < 3; axis++)
            mesh.vertices[i].position[axis] = (float)((double)mesh.vertices[i].position[axis] + from->position_m[axis]);
    *data = (tool_mesh_data){mesh.vertices, mesh.vertex_count, mesh.triangles, mesh.triangle_count};
    return true;
}

const tool_mesh water_surface_mesh = {
    .name = "water_mesh",
    .properties = vertex_columns,
    .property_count = sizeof vertex_columns / sizeof vertex_columns[0],
    .stride = sizeof(mesh_vertex),
    .comment = "virga water: the surface; metres and seconds; normals point out of the water",
    .help = "the surface of water as closed triangles (isotropic kernel)",
    .make = make,
};
