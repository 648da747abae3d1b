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

bool water_make_field(shot *s, water_state *state, field *made, char *error, size_t error_size)
{
    const scene_water *from = scene_water_of(s->scene);
    field_def def = {.spacing_m = state->source.spacing_m,
                     .volume_m3 = from->volume * pow(state->source.spacing_m, 3),
                     .kernel_spacings = from->kernel_spacings};
    virga_particle_gpu *particles = water_copy_particles(s, state, &def.count, error, error_size);
    if (!particles)
        return false;
    def.particles = particles;
    const bool ok = field_create(made, &def);
    free(particles);
    return ok || host_fail(error, error_size, "no memory for the density of %u particles", def.count);
}

static bool make(shot *s, void *state, tool_mesh_data *data, char *error, size_t error_size)
{
    const scene_water *from = scene_water_of(s->scene);
    field made;
    water_mesh mesh = {0};
    if (!water_make_field(s, state, &made, error, error_size))
        return false;
    const bool ok = water_mesh_create(&mesh, &made, from->level);
    field_destroy(&made);
    if (!ok)
        return host_fail(error, error_size, "no memory for the mesh of the water");
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
