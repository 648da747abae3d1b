/* fluid/body_mesh.c - mass and outermost points of a body. */
#include "fluid/body_mesh.h"

#include <math.h>
#include <string.h>

static void vertex_of(const body_mesh *mesh, uint32_t vertex, double out[3])
{
    float at[3];
    memcpy(at, (const char *)mesh->positions + vertex * mesh->stride, sizeof at);
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (double)at[axis];
}

static void corners_of(const body_mesh *mesh, uint32_t triangle, const double origin[3], double corners[3][3])
{
    for (uint32_t i = 0; i < 3; i++) {
        vertex_of(mesh, mesh->indices[triangle * 3 + i], corners[i]);
        for (int axis = 0; axis < 3; axis++)
            corners[i][axis] -= origin[axis];
    }
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        out[axis] = a[u] * b[v] - a[v] * b[u];
    }
}

static double area_of(double c[3][3])
{
    double u[3], v[3], normal[3];
    for (int axis = 0; axis < 3; axis++) {
        u[axis] = c[1][axis] - c[0][axis];
        v[axis] = c[2][axis] - c[0][axis];
    }
    cross(u, v, normal);
    return 0.5 * sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
}

static void bounds_of(const body_mesh *mesh, body_mass *mass)
{
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        double p[3];
        vertex_of(mesh, mesh->indices[i], p);
        for (int axis = 0; axis < 3; axis++) {
            mass->low[axis] = i ? fmin(mass->low[axis], p[axis]) : p[axis];
            mass->high[axis] = i ? fmax(mass->high[axis], p[axis]) : p[axis];
        }
    }
}

static const int pairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

/* Adds the integrals of 1, x and x x over the tetrahedron of a triangle and the origin. With its corners a, b, c and s
 * = a + b + c, its volume is V = a . (b x c) / 6, the integral of x is V s / 4, and that of x_i x_j is V (a_i a_j + b_i
 * b_j + c_i c_j + s_i s_j) / 20. */
static void add_tetrahedron(double c[3][3], body_mass *mass, double moments[6])
{
    double normal[3], s[3];
    cross(c[1], c[2], normal);
    const double volume = (c[0][0] * normal[0] + c[0][1] * normal[1] + c[0][2] * normal[2]) / 6;
    mass->volume += volume;
    mass->area += area_of(c);
    for (int axis = 0; axis < 3; axis++) {
        s[axis] = c[0][axis] + c[1][axis] + c[2][axis];
        mass->center[axis] += volume * s[axis] / 4;
    }
    for (int k = 0; k < 6; k++) {
        const int i = pairs[k][0], j = pairs[k][1];
        moments[k] += volume * (c[0][i] * c[0][j] + c[1][i] * c[1][j] + c[2][i] * c[2][j] + s[i] * s[j]) / 20;
    }
}

static void set_inertia(body_mass *mass, double moments[6])
{
    for (int k = 0; k < 6; k++)
        moments[k] -= mass->volume * mass->center[pairs[k][0]] * mass->center[pairs[k][1]];
    for (int k = 0; k < 3; k++)
        mass->inertia[k] = moments[(k + 1) % 3] + moments[(k + 2) % 3];
    for (int k = 3; k < 6; k++)
        mass->inertia[k] = -moments[k];
}

void body_mass_of(const body_mesh *mesh, body_mass *mass)
{
    double moments[6] = {0}, middle[3], corners[3][3];
    *mass = (body_mass){0};
    bounds_of(mesh, mass);
    for (int axis = 0; axis < 3; axis++)
        middle[axis] = 0.5 * (mass->low[axis] + mass->high[axis]);
    for (uint32_t i = 0; i < mesh->index_count / 3; i++) {
        corners_of(mesh, i, middle, corners);
        add_tetrahedron(corners, mass, moments);
    }
    /* Triangles that are wound the other way make all sums negative. */
    const double sign = mass->volume < 0 ? -1 : 1;
    mass->volume *= sign;
    for (int k = 0; k < 6; k++)
        moments[k] *= sign;
    for (int axis = 0; axis < 3; axis++)
        mass->center[axis] *= mass->volume > 0 ? sign / mass->volume : 0;
    set_inertia(mass, moments);
    for (int axis = 0; axis < 3; axis++)
        mass->center[axis] += middle[axis];
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        double p[3], r2 = 0;
        vertex_of(mesh, mesh->indices[i], p);
        for (int axis = 0; axis < 3; axis++)
            r2 += (p[axis] - mass->center[axis]) * (p[axis] - mass->center[axis]);
        mass->radius = fmax(mass->radius, sqrt(r2));
    }
}

/* Distance squared to the nearest of the points, or to the center if there is none yet. */
static double apart(const double p[3], float (*points)[4], uint32_t count)
{
    double nearest = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    for (uint32_t i = 0; i < count; i++) {
        double r2 = 0;
        for (int axis = 0; axis < 3; axis++)
            r2 += (p[axis] - (double)points[i][axis]) * (p[axis] - (double)points[i][axis]);
        nearest = i ? fmin(nearest, r2) : r2;
    }
    return nearest;
}

uint32_t body_points(const body_mesh *mesh, const body_mass *mass, uint32_t capacity, float (*points)[4])
{
    for (uint32_t count = 0; count < capacity; count++) {
        double farthest = 0, best[3] = {0};
        for (uint32_t i = 0; i < mesh->index_count; i++) {
            double p[3];
            vertex_of(mesh, mesh->indices[i], p);
            for (int axis = 0; axis < 3; axis++)
                p[axis] -= mass->center[axis];
            const double r2 = apart(p, points, count);
            if (r2 > farthest) {
                farthest = r2;
                memcpy(best, p, sizeof best);
            }
        }
        if (farthest <= 1e-10 * mass->radius * mass->radius)
            return count;
        for (int axis = 0; axis < 3; axis++)
            points[count][axis] = (float)best[axis];
        points[count][3] = 0;
    }
    return capacity;
}
