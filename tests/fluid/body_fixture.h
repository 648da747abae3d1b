/* body_fixture.h - boxes as bodies in a fluid. */
#ifndef VIRGA_TESTS_BODY_FIXTURE_H
#define VIRGA_TESTS_BODY_FIXTURE_H

#include "fluid_fixture.h"

/* Corners of a unit cube around the origin, and its triangles. */
static const float cube_corners[8][3] = {{-0.5f, -0.5f, -0.5f}, {0.5f, -0.5f, -0.5f}, {-0.5f, 0.5f, -0.5f},
                                         {0.5f, 0.5f, -0.5f},   {-0.5f, -0.5f, 0.5f}, {0.5f, -0.5f, 0.5f},
                                         {-0.5f, 0.5f, 0.5f},   {0.5f, 0.5f, 0.5f}};
static const uint32_t cube_indices[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                          2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

typedef struct box_mesh {
    float corners[8][3];
} box_mesh;

static inline box_mesh box_of(double x, double y, double z)
{
    const double side[3] = {x, y, z};
    box_mesh box;
    for (int i = 0; i < 8; i++)
        for (int axis = 0; axis < 3; axis++)
            box.corners[i][axis] = cube_corners[i][axis] * (float)side[axis];
    return box;
}

static inline virga_fluid_body body_of(const box_mesh *box, double density, double x, double y, double z)
{
    return (virga_fluid_body){.positions = box->corners[0],
                              .stride = sizeof box->corners[0],
                              .vertex_count = 8,
                              .indices = cube_indices,
                              .index_count = 36,
                              .density = (float)density,
                              .friction = 0.4f,
                              .position_m = {(float)x, (float)y, (float)z}};
}

static inline void body_fixture_open(fluid_fixture *f)
{
    virga_fluid_def def = fluid_fixture_def();
    def.max_bodies = 2;
    def.max_iterations = 30;
    fluid_fixture_open_with(f, &def, false);
}

static inline uint32_t body_fixture_add(fluid_fixture *f, const virga_fluid_body *body)
{
    uint32_t index = 99;
    REQUIRE(virga_fluid_body_add(f->fluid, body, &index) == VIRGA_OK);
    return index;
}

static inline virga_fluid_pose pose_of(fluid_fixture *f, uint32_t body)
{
    virga_fluid_pose pose;
    REQUIRE(virga_fluid_body_get(f->fluid, body, &pose));
    return pose;
}

/* A vector that the body's rotation turns; `way` -1: back. */
static inline void turn_by(const virga_fluid_pose *pose, double way, const double v[3], double out[3])
{
    const double q[4] = {way * (double)pose->rotation[0], way * (double)pose->rotation[1],
                         way * (double)pose->rotation[2], (double)pose->rotation[3]};
    double c[3];
    /* v + 2 q x (q x v + w v) */
    for (int k = 0; k < 3; k++)
        c[k] = q[(k + 1) % 3] * v[(k + 2) % 3] - q[(k + 2) % 3] * v[(k + 1) % 3] + q[3] * v[k];
    for (int k = 0; k < 3; k++)
        out[k] = v[k] + 2 * (q[(k + 1) % 3] * c[(k + 2) % 3] - q[(k + 2) % 3] * c[(k + 1) % 3]);
}

/* Where a particle is in the axes of the body. */
static inline void in_body(const virga_fluid_pose *pose, const float p[3], double at[3])
{
    double arm[3];
    for (int axis = 0; axis < 3; axis++)
        arm[axis] = (double)p[axis] - (double)pose->position_m[axis];
    turn_by(pose, -1, arm, at);
}

/* How far a particle is inside a box of half sides (m); negative outside. */
static inline double depth_in_box(const virga_fluid_pose *pose, const double half[3], const float p[3])
{
    double at[3], deep = 1e30;
    in_body(pose, p, at);
    for (int axis = 0; axis < 3; axis++)
        deep = fmin(deep, half[axis] - fabs(at[axis]));
    return deep;
}

#endif
