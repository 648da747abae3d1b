/* drip_model.c - see drip_model.h. */
#include "drip_model.h"

#include "drip_edges.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define REACH_M   0.06 /* on the way down, water finds what is that near to it */
#define GAP_M     0.03 /* and over a gap of a door or a fold */
#define ASIDE_M   0.25 /* it follows a side that leans inwards up to here, and falls then */
#define LEAST_M   1e-3 /* lower is no way */
#define MAX_WAYS  64
#define MAX_SPEED 100.0 /* virga_drip_site */

/* ---- the way down */

#define MAX_CORNERS 7 /* of a triangle that four planes cut */

/* Cuts a polygon where sign * (its coordinate `axis`) is above `most`. Returns the number of corners that are left. */
static uint32_t cut(double corners[MAX_CORNERS][3], uint32_t count, int axis, double sign, double most)
{
    double out[MAX_CORNERS][3];
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double *a = corners[i], *b = corners[(i + 1) % count];
        const double in_a = most - sign * a[axis], in_b = most - sign * b[axis];
        if (in_a >= 0)
            memcpy(out[left++], a, sizeof out[0]);
        if ((in_a < 0) == (in_b < 0))
            continue;
        for (int k = 0; k < 3; k++)
            out[left][k] = a[k] + in_a / (in_a - in_b) * (b[k] - a[k]);
        left++;
    }
    memcpy(corners, out, left * sizeof out[0]);
    return left;
}

/* Of a polygon's lowest edge the middle. */
static void take_lowest(double corners[MAX_CORNERS][3], uint32_t count, const double at[3], double lowest[3])
{
    double high = -INFINITY, low = INFINITY, sum[3] = {0};
    uint32_t lows = 0;
    for (uint32_t i = 0; i < count; i++) {
        high = fmax(high, corners[i][1]);
        low = fmin(low, corners[i][1]);
    }
    if (high < at[1] - GAP_M || low >= lowest[1] - LEAST_M)
        return;
    for (uint32_t i = 0; i < count; i++)
        if (corners[i][1] < low + LEAST_M) {
            lows++;
            for (int k = 0; k < 3; k++)
                sum[k] += corners[i][k];
        }
    for (int k = 0; k < 3; k++)
        lowest[k] = sum[k] / lows;
}

/* The part of a triangle in a column around `at`. Where it begins at `at` or higher and goes lower than `lowest`, that
 * becomes its lowest point. */
static void look_lower(const host_vertex *vertices, const uint32_t index[3], const double at[3], double lowest[3])
{
    double corners[MAX_CORNERS][3], high = -INFINITY, low = INFINITY;
    for (int n = 0; n < 3; n++)
        for (int k = 0; k < 3; k++) {
            corners[n][k] = (double)vertices[index[n]].position[k];
            high = k == 1 ? fmax(high, corners[n][1]) : high;
            low = k == 1 ? fmin(low, corners[n][1]) : low;
        }
    if (high < at[1] - GAP_M || low >= lowest[1] - LEAST_M)
        return;
    uint32_t count = 3;
    for (int side = 0; side < 4 && count; side++) {
        const int axis = side / 2 * 2;
        const double sign = side % 2 ? 1 : -1;
        count = cut(corners, count, axis, sign, sign * at[axis] + REACH_M);
    }
    take_lowest(corners, count, at, lowest);
}

static void run_down(const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices, double at[3])
{
    const double from[2] = {at[0], at[2]};
    for (int way = 0; way < MAX_WAYS; way++) {
        double lowest[3] = {at[0], at[1], at[2]};
        for (uint32_t i = 0; i < mesh->primitive_count; i++)
            for (uint32_t k = 0; k + 2 < mesh->primitives[i].index_count; k += 3)
                look_lower(vertices, &indices[mesh->primitives[i].first_index + k], at, lowest);
        if (lowest[1] >= at[1] || hypot(lowest[0] - from[0], lowest[2] - from[1]) > ASIDE_M)
            return;
        memcpy(at, lowest, sizeof lowest);
    }
}

/* ---- places */

/* A level ground below all of the model, and a margin around it. */
static void add_ground(host_drip_edges *edges, const double center_m[2], double half_m, double ground_m)
{
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    host_vertex vertices[4] = {0};
    host_primitive primitive = {.index_count = 6, .ground = true, .cover = 1};
    const host_mesh mesh = {.primitives = &primitive, .primitive_count = 1};
    for (int i = 0; i < 4; i++) {
        vertices[i].position[0] = (float)(center_m[0] + (i == 1 || i == 2 ? half_m : -half_m));
        vertices[i].position[1] = (float)ground_m;
        vertices[i].position[2] = (float)(center_m[1] + (i >= 2 ? half_m : -half_m));
    }
    host_drip_edges_add(edges, &mesh, vertices, indices);
}

/* The bounds of what is drawn of it, in x and z. */
static void find_bounds(const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices, double low[2],
                        double high[2])
{
    for (int axis = 0; axis < 2; axis++) {
        low[axis] = INFINITY;
        high[axis] = -INFINITY;
    }
    for (uint32_t i = 0; i < mesh->primitive_count; i++)
        for (uint32_t k = 0; k < mesh->primitives[i].index_count; k++)
            for (int axis = 0; axis < 2; axis++) {
                const float at = vertices[indices[mesh->primitives[i].first_index + k]].position[2 * axis];
                low[axis] = fmin(low[axis], (double)at);
                high[axis] = fmax(high[axis], (double)at);
            }
}

uint32_t host_drip_model_find(const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices,
                              double ground_m, virga_drip_site *sites, uint32_t capacity, uint32_t *found)
{
    double low[2], high[2];
    host_eave *eaves = NULL;
    uint32_t eave_count = 0;
    *found = 0;
    find_bounds(mesh, vertices, indices, low, high);
    if (!(high[0] > low[0] && high[1] > low[1]))
        return 0;
    const double center_m[2] = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])};
    const double half_m = 0.5 * fmax(high[0] - low[0], high[1] - low[1]) + 0.5;
    host_drip_edges *edges = host_drip_edges_begin(center_m, half_m);
    if (!edges)
        return UINT32_MAX;
    add_ground(edges, center_m, half_m, ground_m);
    host_drip_edges_add(edges, mesh, vertices, indices);
    /* Nothing that moves has gutters. */
    const uint32_t count = host_drip_edges_find(edges, INFINITY, sites, capacity, found, &eaves, &eave_count);
    host_drip_edges_end(edges);
    free(eaves);
    for (uint32_t i = 0; i < count && count != UINT32_MAX; i++)
        run_down(mesh, vertices, indices, sites[i].position_m);
    return count;
}

static void to_world(const float transform[12], const double local[3], double world[3])
{
    for (int row = 0; row < 3; row++) {
        world[row] = (double)transform[4 * row + 3];
        for (int column = 0; column < 3; column++)
            world[row] += (double)transform[4 * row + column] * local[column];
    }
}

void host_drip_model_move(const virga_drip_site *at_rest, uint32_t count, const float transform[12],
                          const float before[12], double apart_s, virga_drip_site *out)
{
    for (uint32_t i = 0; i < count; i++) {
        double then_m[3];
        out[i] = at_rest[i];
        out[i].moves = true;
        to_world(transform, at_rest[i].position_m, out[i].position_m);
        to_world(before, at_rest[i].position_m, then_m);
        for (int axis = 0; axis < 3; axis++) {
            const double speed = (out[i].position_m[axis] - then_m[axis]) / apart_s;
            out[i].velocity_m_s[axis] = (float)fmin(fmax(speed, -MAX_SPEED), MAX_SPEED);
        }
    }
}
