/* fluid/body_map.c - what a body means for particles near it, on a grid around it.
 *
 * Koschier and Bender (2017, Density Maps for Improved SPH Boundary Handling; Bender et al. 2019, Volume Maps) replace
 * particles on a boundary by integrals that are tabulated on a grid: nothing moves along with a body, a neighbour is
 * not needed for each of its faces, and flat faces are flat. So is it here, with what shaders/fluid/kernel.glsl has for
 * the walls of the box: at the distance z (in spacings) from a flat wall its part of the density is
 *
 *     D(z) = P(z + 1/2) + P(z + 3/2).
 *
 * A body is not flat everywhere. Its part is D times the share of the kernel's volume that lies in it, over that which
 * would lie behind a flat wall at the same distance: 1 at faces, less at edges and corners, more in hollows. */
#include "fluid/body_mesh.h"

#include <virga/shared/fluid_gpu.h>

#include <math.h>
#include <string.h>

#define MARGIN 2.5 /* spacings of nodes around the mesh */
/* Nodes in a kernel's radius. */
#define REACH_NODES 4

uint64_t body_map_size(const body_mass *mass, double spacing, body_map *map)
{
    double count = 1;
    map->node = spacing / 2;
    for (int axis = 0; axis < 3; axis++) {
        const double side = mass->high[axis] - mass->low[axis];
        const double nodes = ceil((side + 2 * MARGIN * spacing) / map->node) + 1;
        const double over = (nodes - 1) * map->node - side;
        map->low[axis] = mass->low[axis] - mass->center[axis] - over / 2;
        map->dims[axis] = nodes < 1e6 ? (uint32_t)nodes : 0;
        count *= nodes;
    }
    return count < 2147483648.0 ? (uint64_t)count : 0;
}

/* ---- the mesh in nodes */

typedef struct triangle {
    double corners[3][3]; /* in nodes */
} triangle;

typedef struct fill {
    const body_mesh *mesh;
    const body_mass *mass;
    const body_map *map;
    double per_spacing;     /* nodes: 2 */
    float *distance, *part; /* of each node, in nodes; the body's part of the density */
    float *share;           /* of a node's cube that is in the body */
    double *crossings;      /* of a row, with their signs */
} fill;

#define MAX_CROSSINGS(mesh) ((size_t)(mesh)->index_count / 3 * 2)

static size_t node_count(const body_map *map)
{
    return (size_t)map->dims[0] * map->dims[1] * map->dims[2];
}

size_t body_map_bytes(const body_mesh *mesh, const body_map *map)
{
    return 3 * node_count(map) * sizeof(float) + (MAX_CROSSINGS(mesh) + 2) * sizeof(double);
}

static void triangle_of(const fill *f, uint32_t index, triangle *out)
{
    for (int i = 0; i < 3; i++) {
        float at[3];
        memcpy(at, (const char *)f->mesh->positions + f->mesh->indices[index * 3 + (uint32_t)i] * f->mesh->stride,
               sizeof at);
        for (int axis = 0; axis < 3; axis++)
            out->corners[i][axis] = ((double)at[axis] - f->mass->center[axis] - f->map->low[axis]) / f->map->node;
    }
}

static size_t node_at(const body_map *map, int64_t x, int64_t y, int64_t z)
{
    return ((size_t)z * map->dims[1] + (size_t)y) * map->dims[0] + (size_t)x;
}

/* ---- distance: that to the nearest triangle (Ericson 2005, Real-Time Collision Detection, section 5.1.5) */

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double distance2_to_edge(const double a[3], const double b[3], const double p[3])
{
    double ab[3], ap[3];
    for (int axis = 0; axis < 3; axis++) {
        ab[axis] = b[axis] - a[axis];
        ap[axis] = p[axis] - a[axis];
    }
    const double length2 = dot3(ab, ab), t = length2 > 0 ? fmin(fmax(dot3(ap, ab) / length2, 0), 1) : 0;
    double r2 = 0;
    for (int axis = 0; axis < 3; axis++)
        r2 += pow(ap[axis] - t * ab[axis], 2);
    return r2;
}

/* If the foot of the perpendicular lies in the triangle, its length; else the nearest edge decides. */
static double distance2_to_triangle(const triangle *t, const double p[3])
{
    double u[3], v[3], w[3];
    for (int axis = 0; axis < 3; axis++) {
        u[axis] = t->corners[1][axis] - t->corners[0][axis];
        v[axis] = t->corners[2][axis] - t->corners[0][axis];
        w[axis] = p[axis] - t->corners[0][axis];
    }
    const double uu = dot3(u, u), uv = dot3(u, v), vv = dot3(v, v), wu = dot3(w, u), wv = dot3(w, v);
    const double area2 = uu * vv - uv * uv;
    const double b = area2 > 0 ? (vv * wu - uv * wv) / area2 : -1, c = area2 > 0 ? (uu * wv - uv * wu) / area2 : -1;
    if (b >= 0 && c >= 0 && b + c <= 1)
        return fmax(dot3(w, w) - b * wu - c * wv, 0);
    return fmin(
        distance2_to_edge(t->corners[0], t->corners[1], p),
        fmin(distance2_to_edge(t->corners[1], t->corners[2], p), distance2_to_edge(t->corners[2], t->corners[0], p)));
}

/* Nodes of an axis that are within the reach of a triangle. */
static void nodes_along(const fill *f, const triangle *t, int axis, int64_t *first, int64_t *last)
{
    const double reach = f->per_spacing * VIRGA_FLUID_MAP_REACH;
    const double low = fmin(t->corners[0][axis], fmin(t->corners[1][axis], t->corners[2][axis])) - reach;
    const double high = fmax(t->corners[0][axis], fmax(t->corners[1][axis], t->corners[2][axis])) + reach;
    *first = (int64_t)fmax(ceil(low), 0);
    *last = (int64_t)fmin(floor(high), f->map->dims[axis] - 1);
}

static void near_triangle(fill *f, const triangle *t)
{
    int64_t first[3], last[3];
    for (int axis = 0; axis < 3; axis++)
        nodes_along(f, t, axis, &first[axis], &last[axis]);
    for (int64_t z = first[2]; z <= last[2]; z++)
        for (int64_t y = first[1]; y <= last[1]; y++)
            for (int64_t x = first[0]; x <= last[0]; x++) {
                const double p[3] = {(double)x, (double)y, (double)z};
                float *nearest = &f->distance[node_at(f->map, x, y, z)];
                *nearest = fminf(*nearest, (float)sqrt(distance2_to_triangle(t, p)));
            }
}

/* ---- sign: the triangles that the row of nodes along x goes through, in and out */

/* A little off the nodes, so that a row does not run through corners and edges that lie on the grid. */
static const double row_offset[2] = {1.37e-5, 2.61e-5};

/* Where a row meets a triangle. False: nowhere. */
static bool crossing(const triangle *t, double y, double z, double *x, int *sign)
{
    double edge[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        const double *a = t->corners[i], *b = t->corners[(i + 1) % 3];
        /* The same bits for both triangles of an edge. */
        const bool swap = a[1] > b[1] || (a[1] == b[1] && a[2] > b[2]);
        const double *from = swap ? b : a, *to = swap ? a : b;
        const double e = (to[1] - from[1]) * (z - from[2]) - (to[2] - from[2]) * (y - from[1]);
        edge[(i + 2) % 3] = swap ? -e : e;
        sum += swap ? -e : e;
    }
    if (!((edge[0] > 0 && edge[1] > 0 && edge[2] > 0) || (edge[0] < 0 && edge[1] < 0 && edge[2] < 0)))
        return false;
    *x = (edge[0] * t->corners[0][0] + edge[1] * t->corners[1][0] + edge[2] * t->corners[2][0]) / sum;
    *sign = sum > 0 ? 1 : -1;
    return true;
}

/* Makes distances negative inside. False: something that was entered was not left. */
static bool sign_row(fill *f, int64_t y, int64_t z)
{
    size_t count = 0;
    int winding = 0;
    for (uint32_t i = 0; i < f->mesh->index_count / 3; i++) {
        triangle t;
        double x;
        int sign;
        triangle_of(f, i, &t);
        if (crossing(&t, (double)y + row_offset[0], (double)z + row_offset[1], &x, &sign)) {
            f->crossings[count++] = x;
            f->crossings[count++] = sign;
        }
    }
    for (int64_t x = 0; x < f->map->dims[0]; x++) {
        winding = 0;
        for (size_t i = 0; i < count; i += 2)
            winding += f->crossings[i] < (double)x ? (int)f->crossings[i + 1] : 0;
        if (winding)
            f->distance[node_at(f->map, x, y, z)] *= -1;
    }
    return !winding;
}

/* ---- the body's part of the density */

static double kernel(double q)
{
    return (pow(fmax(2 - q, 0), 3) - 4 * pow(fmax(1 - q, 0), 3)) / (4 * M_PI);
}

/* P, and its derivative -2 pi s W(s); see shaders/fluid/kernel.glsl. */
static double plane(double s)
{
    const double a = fmax(2 - s, 0), b = fmax(1 - s, 0);
    return 0.5 * (pow(a, 4) * (0.5 - 0.2 * a) - pow(b, 4) * (1 - 0.8 * b));
}

static double plane_slope(double s)
{
    return -2 * M_PI * s * kernel(s);
}

/* D, its derivative with the factor of the mirror image, and the wall's part of the sum of |x . grad W|. */
static void wall(double z, double out[3])
{
    const double near = fmax(z, 0) + 0.5, far = fmax(z, 0) + 1.5;
    out[0] = plane(near) + plane(far);
    out[1] = 2 * (plane_slope(near) + plane_slope(far));
    out[2] = 2 * out[0] - near * plane_slope(near) - far * plane_slope(far);
}

typedef struct stencil {
    struct {
        int x, y, z;
        double weight;
    } at[(2 * REACH_NODES + 1) * (2 * REACH_NODES + 1) * (2 * REACH_NODES + 1)];
    int count;
    double flat[2 * REACH_NODES + 1]; /* sums over a plane of nodes at this distance */
} stencil;

static void make_stencil(stencil *s)
{
    *s = (stencil){.count = 0};
    for (int z = -REACH_NODES; z <= REACH_NODES; z++)
        for (int y = -REACH_NODES; y <= REACH_NODES; y++)
            for (int x = -REACH_NODES; x <= REACH_NODES; x++) {
                const double weight = kernel(sqrt(x * x + y * y + z * z) / 2) / 8;
                if (!(weight > 0))
                    continue;
                s->at[s->count].x = x;
                s->at[s->count].y = y;
                s->at[s->count].z = z;
                s->at[s->count++].weight = weight;
                s->flat[x + REACH_NODES] += weight;
            }
}

/* Share of a cube of nodes that is inside, at a distance of its middle. */
static double share_inside(double distance)
{
    return fmin(fmax(0.5 - distance, 0), 1);
}

static double volume_behind_flat(const stencil *s, double distance)
{
    double sum = 0;
    for (int i = 0; i <= 2 * REACH_NODES; i++)
        sum += s->flat[i] * share_inside(distance + (i - REACH_NODES));
    return sum;
}

static double volume_inside(const fill *f, const stencil *s, int64_t x, int64_t y, int64_t z)
{
    double sum = 0;
    for (int i = 0; i < s->count; i++) {
        const int64_t at[3] = {x + s->at[i].x, y + s->at[i].y, z + s->at[i].z};
        if (at[0] < 0 || at[1] < 0 || at[2] < 0 || at[0] >= f->map->dims[0] || at[1] >= f->map->dims[1] ||
            at[2] >= f->map->dims[2])
            continue;
        sum += s->at[i].weight * (double)f->share[node_at(f->map, at[0], at[1], at[2])];
    }
    return sum;
}

/* The share of the kernel that is in the body over that behind a flat wall. */
static double bend(const fill *f, const stencil *s, int64_t x, int64_t y, int64_t z)
{
    const double distance = (double)f->distance[node_at(f->map, x, y, z)];
    if (distance >= REACH_NODES - 0.6 || distance <= 0)
        return 1;
    const double flat = volume_behind_flat(s, distance);
    return flat > 1e-5 ? fmin(volume_inside(f, s, x, y, z) / flat, 4) : 1;
}

static uint32_t pack(double a, double b)
{
    const double u = 32767 * fmin(fmax(a, -1), 1), v = 32767 * fmin(fmax(b, -1), 1);
    return (uint32_t)(uint16_t)(int16_t)lround(u) | (uint32_t)(uint16_t)(int16_t)lround(v) << 16;
}

static uint32_t float_bits(double value)
{
    const float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    return bits;
}

/* (f(x + 1) - f(x - 1)) / 2 along an axis, one-sided at the border. */
static double slope_along(const fill *f, const float *values, const int64_t at[3], int axis)
{
    int64_t before[3] = {at[0], at[1], at[2]}, after[3] = {at[0], at[1], at[2]};
    before[axis] -= before[axis] > 0;
    after[axis] += after[axis] + 1 < f->map->dims[axis];
    const double rise = (double)values[node_at(f->map, after[0], after[1], after[2])] -
                        (double)values[node_at(f->map, before[0], before[1], before[2])];
    return rise / (double)(after[axis] - before[axis]);
}

/* grad (D B) = D' B grad z + D grad B, where z is the distance and B the bend. The first is that of the closed form, so
 * it has no error of the grid at a flat face. `part` holds B. */
static void pack_node(const fill *f, const int64_t at[3], uint32_t node[4])
{
    const size_t index = node_at(f->map, at[0], at[1], at[2]);
    const double z = (double)f->distance[index] / f->per_spacing, bent = (double)f->part[index];
    double flat[3], normal[3], gradient[3];
    wall(z, flat);
    for (int axis = 0; axis < 3; axis++)
        normal[axis] = slope_along(f, f->distance, at, axis);
    const double length = sqrt(dot3(normal, normal));
    for (int axis = 0; axis < 3; axis++) {
        const double along = length > 0.1 ? normal[axis] / length : 0;
        const double bending = z > 0 ? f->per_spacing * slope_along(f, f->part, at, axis) : 0;
        gradient[axis] = (flat[1] * bent * along + 2 * flat[0] * bending) / VIRGA_FLUID_MAP_GRADIENT;
    }
    node[0] = pack(gradient[0], gradient[1]);
    node[1] = pack(gradient[2], flat[0] * bent);
    node[2] = float_bits(z);
    node[3] = float_bits(flat[2] * bent);
}

static body_map_result fill_distances(fill *f)
{
    const size_t count = node_count(f->map);
    double deepest = 0;
    for (size_t i = 0; i < count; i++)
        f->distance[i] = (float)(f->per_spacing * VIRGA_FLUID_MAP_REACH);
    for (uint32_t i = 0; i < f->mesh->index_count / 3; i++) {
        triangle t;
        triangle_of(f, i, &t);
        near_triangle(f, &t);
    }
    for (int64_t z = 0; z < f->map->dims[2]; z++)
        for (int64_t y = 0; y < f->map->dims[1]; y++)
            if (!sign_row(f, y, z))
                return BODY_MAP_OPEN;
    for (size_t i = 0; i < count; i++) {
        f->share[i] = (float)share_inside((double)f->distance[i]);
        deepest = fmax(deepest, -(double)f->distance[i]);
    }
    return deepest >= 0.5 ? BODY_MAP_DONE : BODY_MAP_THIN; /* nodes: a quarter of a spacing */
}

body_map_result body_map_fill(const body_mesh *mesh, const body_mass *mass, const body_map *map, double spacing,
                              void *memory, uint32_t (*nodes)[4])
{
    const size_t count = node_count(map);
    double *crossings = memory;
    float *floats = (float *)(crossings + MAX_CROSSINGS(mesh) + 2);
    fill f = {.mesh = mesh,
              .mass = mass,
              .map = map,
              .per_spacing = spacing / map->node,
              .distance = floats,
              .part = floats + count,
              .share = floats + 2 * count,
              .crossings = crossings};
    stencil s;
    const body_map_result result = fill_distances(&f);
    if (result)
        return result;
    make_stencil(&s);
    for (int64_t z = 0; z < map->dims[2]; z++)
        for (int64_t y = 0; y < map->dims[1]; y++)
            for (int64_t x = 0; x < map->dims[0]; x++)
                f.part[node_at(map, x, y, z)] = (float)bend(&f, &s, x, y, z);
    for (int64_t z = 0; z < map->dims[2]; z++)
        for (int64_t y = 0; y < map->dims[1]; y++)
            for (int64_t x = 0; x < map->dims[0]; x++)
                pack_node(&f, (const int64_t[3]){x, y, z}, nodes[node_at(map, x, y, z)]);
    return BODY_MAP_DONE;
}
