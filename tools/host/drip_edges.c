/* drip_edges.c - finds the places from which rain drips.
 *
 * Directions of flow by "priority flood" (Barnes, Lehman and Mulla 2014): cells are taken in the order of their
 * heights, beginning at the borders. A cell drains to the neighbour to which it is steepest, and where none is lower to
 * the one from which it was reached. So hollows and level surfaces drain too, over their lowest border and the shortest
 * way. */
#include "drip_edges.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <virga/shared/random.h>

#define CELL_M    0.05 /* two drops hang side by side on it */
#define FALL_M    0.25 /* lower steps are kerbs and thresholds, over which water runs */
#define CLIFF_M   0.10 /* on a lower step water runs down as on a slope; over a higher one it falls */
#define NOTHING_M (-1e9f)
#define MAX_CELLS (2048u * 2048u)
#define MIN_SLOPE 0.02 /* of surfaces that are level */
#define LEVEL     1e-4 /* a smaller slope is none */
#define OUTSIDE_M 0.015
#define SLIDES    0.2 /* slope of an edge, from which on its drops run along it */
#define NO_CELL   UINT32_MAX

typedef struct drip_cell {
    float height_m;
    bool ground;
} drip_cell;

typedef struct drip_flow {
    uint32_t to;     /* the cell that it drains to; NO_CELL: ground, or nothing there */
    float flooded_m; /* height of the water when it flows off */
    float cells;     /* whose rain it has */
    float way_m;     /* the longest that this rain has run */
    bool edge;       /* beside ground or nothing */
} drip_flow;

struct host_drip_edges {
    double low_m[2];
    double cell_m;
    uint32_t side; /* cells along it */
    drip_cell *cells;
};

host_drip_edges *host_drip_edges_begin(const double center_m[2], double half_m)
{
    host_drip_edges *edges = calloc(1, sizeof *edges);
    if (!edges)
        return NULL;
    edges->cell_m = fmax(CELL_M, 2 * half_m / sqrt((double)MAX_CELLS));
    edges->side = (uint32_t)fmax(ceil(2 * half_m / edges->cell_m), 3);
    for (int axis = 0; axis < 2; axis++)
        edges->low_m[axis] = center_m[axis] - 0.5 * edges->side * edges->cell_m;
    edges->cells = malloc((size_t)edges->side * edges->side * sizeof *edges->cells);
    if (!edges->cells) {
        free(edges);
        return NULL;
    }
    for (size_t i = 0; i < (size_t)edges->side * edges->side; i++)
        edges->cells[i] = (drip_cell){NOTHING_M, false};
    return edges;
}

void host_drip_edges_end(host_drip_edges *edges)
{
    if (!edges)
        return;
    free(edges->cells);
    free(edges);
}

/* ---- heights */

/* A triangle in units of cells, with its height. */
typedef struct corner {
    double x, z, y;
} corner;

static double twice_area(const corner *a, const corner *b, const corner *c)
{
    return (b->x - a->x) * (c->z - a->z) - (c->x - a->x) * (b->z - a->z);
}

static uint32_t clamp_cell(const host_drip_edges *edges, double at)
{
    return (uint32_t)fmin(fmax(at, 0), edges->side);
}

/* At the middles of cells. A cut-out covers a random choice of them. */
static void draw_triangle(host_drip_edges *edges, const corner c[3], bool ground, float cover, uint32_t seed)
{
    const double area = twice_area(&c[0], &c[1], &c[2]);
    if (!(fabs(area) > 1e-9))
        return;
    const uint32_t x0 = clamp_cell(edges, ceil(fmin(fmin(c[0].x, c[1].x), c[2].x) - 0.5)),
                   x1 = clamp_cell(edges, floor(fmax(fmax(c[0].x, c[1].x), c[2].x) - 0.5) + 1),
                   z0 = clamp_cell(edges, ceil(fmin(fmin(c[0].z, c[1].z), c[2].z) - 0.5)),
                   z1 = clamp_cell(edges, floor(fmax(fmax(c[0].z, c[1].z), c[2].z) - 0.5) + 1);
    for (uint32_t z = z0; z < z1; z++)
        for (uint32_t x = x0; x < x1; x++) {
            const corner p = {x + 0.5, z + 0.5, 0};
            const double w[3] = {twice_area(&p, &c[1], &c[2]) / area, twice_area(&c[0], &p, &c[2]) / area,
                                 twice_area(&c[0], &c[1], &p) / area};
            if (w[0] < 0 || w[1] < 0 || w[2] < 0 || virga_unit(virga_hash3(seed, x, z)) >= cover)
                continue;
            const float height = (float)(w[0] * c[0].y + w[1] * c[1].y + w[2] * c[2].y);
            drip_cell *cell = &edges->cells[(size_t)z * edges->side + x];
            if (height > cell->height_m)
                *cell = (drip_cell){height, ground};
        }
}

void host_drip_edges_add(host_drip_edges *edges, const host_mesh *mesh, const host_vertex *vertices,
                         const uint32_t *indices)
{
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const host_primitive *primitive = &mesh->primitives[i];
        for (uint32_t k = 0; k + 2 < primitive->index_count; k += 3) {
            const uint32_t *index = &indices[primitive->first_index + k];
            corner corners[3];
            for (int n = 0; n < 3; n++) {
                const float *at = vertices[index[n]].position;
                corners[n] = (corner){((double)at[0] - edges->low_m[0]) / edges->cell_m,
                                      ((double)at[2] - edges->low_m[1]) / edges->cell_m, (double)at[1]};
            }
            draw_triangle(edges, corners, primitive->ground, primitive->cover, virga_hash2(i, k));
        }
    }
}

/* ---- directions of flow */

static double distance_m(const host_drip_edges *edges, uint32_t a, uint32_t b)
{
    const double x = (double)(a % edges->side) - b % edges->side, z = (double)(a / edges->side) - b / edges->side;
    return hypot(x, z) * edges->cell_m;
}

/* A heap of cells, the lowest first; of equal ones that which came first. */
typedef struct heap_entry {
    float height_m;
    uint32_t order, cell;
} heap_entry;

typedef struct flood {
    const host_drip_edges *edges;
    drip_flow *flows;
    uint32_t *taken; /* cells that are not ground, in the order in which they were taken */
    uint32_t taken_count;
    heap_entry *heap;
    uint32_t count, order;
    host_eave *eaves; /* of roofs */
    uint32_t eave_count, eave_room;
    bool no_memory;
} flood;

static bool is_before(const heap_entry *a, const heap_entry *b)
{
    return a->height_m < b->height_m || (a->height_m <= b->height_m && a->order < b->order);
}

static void heap_push(flood *f, float height_m, uint32_t cell)
{
    const heap_entry entry = {height_m, f->order++, cell};
    uint32_t at = f->count++;
    for (; at > 0 && is_before(&entry, &f->heap[(at - 1) / 2]); at = (at - 1) / 2)
        f->heap[at] = f->heap[(at - 1) / 2];
    f->heap[at] = entry;
}

static heap_entry heap_pop(flood *f)
{
    const heap_entry first = f->heap[0], last = f->heap[--f->count];
    uint32_t at = 0;
    for (;;) {
        uint32_t child = 2 * at + 1;
        if (child >= f->count)
            break;
        if (child + 1 < f->count && is_before(&f->heap[child + 1], &f->heap[child]))
            child++;
        if (!is_before(&f->heap[child], &last))
            break;
        f->heap[at] = f->heap[child];
        at = child;
    }
    f->heap[at] = last;
    return first;
}

static bool is_sink(const drip_cell *cell)
{
    return cell->ground || cell->height_m <= NOTHING_M;
}

/* The neighbours of a cell, at most eight; first those across its sides, so that water goes straight where it can. */
static uint32_t neighbours_of(const host_drip_edges *edges, uint32_t cell, uint32_t out[8])
{
    static const int beside[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    const uint32_t x = cell % edges->side, z = cell / edges->side;
    uint32_t count = 0;
    for (int i = 0; i < 8; i++) {
        const uint32_t nx = x + (uint32_t)beside[i][0], nz = z + (uint32_t)beside[i][1]; /* below 0: very large */
        if (nx < edges->side && nz < edges->side)
            out[count++] = nz * edges->side + nx;
    }
    return count;
}

/* Cells beside ground, and those at the border of the grid, whose water leaves it. */
static void begin_at_borders(flood *f)
{
    const uint32_t cells = f->edges->side * f->edges->side;
    for (uint32_t i = 0; i < cells; i++) {
        uint32_t beside[8];
        const uint32_t count = neighbours_of(f->edges, i, beside);
        if (is_sink(&f->edges->cells[i]))
            continue;
        uint32_t to = NO_CELL;
        for (uint32_t k = 0; k < count && to == NO_CELL; k++)
            if (is_sink(&f->edges->cells[beside[k]]))
                to = beside[k];
        if (to == NO_CELL && count == 8)
            continue;
        f->flows[i].to = to;
        f->flows[i].edge = to != NO_CELL;
        f->flows[i].flooded_m = f->edges->cells[i].height_m;
        heap_push(f, f->flows[i].flooded_m, i);
    }
}

/* Water at an edge hangs below it. Where the edge itself slopes, drops run along it to where it is lowest: the end of
 * an umbrella's rib, a corner of an awning. What holds a drop of d on a wet edge is surface tension times d times the
 * difference of the cosines of its contact angles, some 0.17 for 10 degrees of hysteresis (an estimate). Against its
 * weight pi/6 rho g d^3 that is 0.073 x 0.17 x 6 / (pi 1000 g d^2) of it: 0.15 for 4 mm, 0.27 for 3 mm. */
static void run_along_edge(flood *f, uint32_t cell, const uint32_t *beside, uint32_t count)
{
    drip_flow *flow = &f->flows[cell];
    double steepest = SLIDES;
    for (uint32_t k = 0; k < count; k++) {
        const drip_flow *other = &f->flows[beside[k]];
        const double falls_m = (double)flow->flooded_m - (double)other->flooded_m;
        const double slope = falls_m / distance_m(f->edges, cell, beside[k]);
        if (other->edge && falls_m < CLIFF_M && slope > steepest) {
            steepest = slope;
            flow->to = beside[k];
        }
    }
}

/* All cells that are lower have been taken. */
static void turn_to_steepest(flood *f, uint32_t cell, const uint32_t *beside, uint32_t count)
{
    drip_flow *flow = &f->flows[cell];
    double steepest = LEVEL;
    for (uint32_t k = 0; k < count && flow->to != NO_CELL; k++) {
        const drip_flow *other = &f->flows[beside[k]];
        const double falls_m = (double)flow->flooded_m - (double)other->flooded_m;
        const double slope = falls_m / distance_m(f->edges, cell, beside[k]);
        if (other->flooded_m > NOTHING_M && slope > steepest) {
            steepest = slope;
            flow->to = beside[k];
        }
    }
}

static void find_directions(flood *f)
{
    begin_at_borders(f);
    while (f->count) {
        const heap_entry now = heap_pop(f);
        uint32_t beside[8];
        const uint32_t count = neighbours_of(f->edges, now.cell, beside);
        f->taken[f->taken_count++] = now.cell;
        if (f->flows[now.cell].edge)
            run_along_edge(f, now.cell, beside, count);
        else
            turn_to_steepest(f, now.cell, beside, count);
        for (uint32_t k = 0; k < count; k++) {
            drip_flow *next = &f->flows[beside[k]];
            const drip_cell *cell = &f->edges->cells[beside[k]];
            if (next->flooded_m > NOTHING_M || is_sink(cell))
                continue;
            next->to = now.cell;
            next->flooded_m = fmaxf(cell->height_m, now.height_m);
            heap_push(f, next->flooded_m, beside[k]);
        }
    }
}

/* ---- places */

/* The sine of the angle at which a cell's surface rises beside it, not over a cliff. */
static double slope_at(const host_drip_edges *edges, uint32_t cell)
{
    uint32_t beside[8];
    const uint32_t count = neighbours_of(edges, cell, beside);
    double steepest = 0;
    for (uint32_t k = 0; k < count; k++) {
        const drip_cell *other = &edges->cells[beside[k]];
        const double rise = fabs((double)other->height_m - (double)edges->cells[cell].height_m);
        if (!is_sink(other) && rise < CLIFF_M)
            steepest = fmax(steepest, rise / distance_m(edges, cell, beside[k]));
    }
    return fmax(steepest / sqrt(1 + steepest * steepest), MIN_SLOPE);
}

/* Beside the edge of a cell, over the ground that it drips on. Not in a line of equal distances. */
static virga_drip_site site_of(const host_drip_edges *edges, uint32_t cell, const drip_flow *flow)
{
    const double out_m = 0.5 * distance_m(edges, cell, flow->to) + OUTSIDE_M;
    const double way = distance_m(edges, cell, flow->to),
                 aside_m = edges->cell_m * ((double)virga_unit(virga_hash1(cell)) - 0.5);
    const double d[2] = {((double)(flow->to % edges->side) - cell % edges->side) * edges->cell_m / way,
                         ((double)(flow->to / edges->side) - cell / edges->side) * edges->cell_m / way};
    virga_drip_site site = {.catch_m2 = (float)fmin((double)flow->cells * edges->cell_m * edges->cell_m, 4),
                            .width_m = (float)edges->cell_m,
                            .slope = (float)slope_at(edges, cell)};
    site.position_m[0] = edges->low_m[0] + (cell % edges->side + 0.5) * edges->cell_m + d[0] * out_m - d[1] * aside_m;
    site.position_m[1] = (double)edges->cells[cell].height_m;
    site.position_m[2] = edges->low_m[1] + (cell / edges->side + 0.5) * edges->cell_m + d[1] * out_m + d[0] * aside_m;
    return site;
}

static void add_eave(flood *f, uint32_t cell, const drip_flow *flow)
{
    const host_drip_edges *edges = f->edges;
    const drip_cell *below = &edges->cells[flow->to];
    const virga_drip_site site = site_of(edges, cell, flow);
    if (f->eave_count == f->eave_room) {
        host_eave *more = realloc(f->eaves, (2 * (size_t)f->eave_room + 64) * sizeof *more);
        f->no_memory = f->no_memory || !more;
        if (!more)
            return;
        f->eaves = more;
        f->eave_room = 2 * f->eave_room + 64;
    }
    f->eaves[f->eave_count++] = (host_eave){
        .x = cell % edges->side,
        .z = cell / edges->side,
        .position_m = {site.position_m[0], site.position_m[1], site.position_m[2]},
        .ground_m = below->ground ? (double)below->height_m : NAN,
        .catch_m2 = (double)flow->cells * edges->cell_m * edges->cell_m,
        .width_m = edges->cell_m,
        .slope = (double)site.slope,
    };
}

static int by_catchment(const void *a, const void *b)
{
    const float x = ((const virga_drip_site *)a)->catch_m2, y = ((const virga_drip_site *)b)->catch_m2;
    return (x < y) - (x > y);
}

/* Water goes down, from the highest cells on. Over a cliff it falls; that of roofs comes into gutters there. Returns
 * all places, to be freed. */
static virga_drip_site *collect(flood *f, double reach_m, uint32_t *found)
{
    const host_drip_edges *edges = f->edges;
    virga_drip_site *sites = malloc(((size_t)f->taken_count + 1) * sizeof *sites);
    *found = 0;
    for (uint32_t i = f->taken_count; sites && i-- > 0;) {
        const uint32_t cell = f->taken[i];
        drip_flow *flow = &f->flows[cell];
        flow->cells += 1;
        if (flow->to == NO_CELL)
            continue;
        const drip_cell *below = &edges->cells[flow->to];
        const double falls_m = (double)edges->cells[cell].height_m - (double)below->height_m;
        const bool to_sink = is_sink(below), falls = falls_m >= (to_sink ? FALL_M : CLIFF_M);
        if (falls && (double)flow->way_m > reach_m) {
            add_eave(f, cell, flow);
            continue;
        }
        if (to_sink) {
            if (falls && below->ground)
                sites[(*found)++] = site_of(edges, cell, flow);
            continue;
        }
        const float way_m = flow->way_m + (float)distance_m(edges, cell, flow->to);
        f->flows[flow->to].cells += flow->cells;
        f->flows[flow->to].way_m = fmaxf(f->flows[flow->to].way_m, way_m);
    }
    return sites;
}

uint32_t host_drip_edges_find(host_drip_edges *edges, double reach_m, virga_drip_site *sites, uint32_t capacity,
                              uint32_t *found, host_eave **eaves, uint32_t *eave_count)
{
    const size_t cells = (size_t)edges->side * edges->side;
    flood f = {.edges = edges,
               .flows = malloc(cells * sizeof *f.flows),
               .taken = malloc(cells * sizeof *f.taken),
               .heap = malloc(cells * sizeof *f.heap)};
    virga_drip_site *all = NULL;
    *found = 0;
    for (size_t i = 0; f.flows && i < cells; i++)
        f.flows[i] = (drip_flow){.to = NO_CELL, .flooded_m = NOTHING_M};
    if (f.flows && f.taken && f.heap) {
        find_directions(&f);
        all = collect(&f, reach_m, found);
    }
    const bool ok = all && !f.no_memory;
    if (!ok)
        free(f.eaves);
    *eaves = ok ? f.eaves : NULL;
    *eave_count = ok ? f.eave_count : 0;
    const uint32_t count = *found < capacity ? *found : capacity;
    if (ok && *found > capacity)
        qsort(all, *found, sizeof *all, by_catchment);
    if (ok)
        memcpy(sites, all, count * sizeof *sites);
    free(all);
    free(f.flows);
    free(f.taken);
    free(f.heap);
    return ok ? count : UINT32_MAX;
}
