/* mesh.c - marching tetrahedra. */
#include "mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIDE      FIELD_SIDE
#define EDGES     7 /* that begin at a point: to the other corners of its cube */
#define NO_VERTEX UINT32_MAX

/* Corners of a cube by bits: 1 is x, 2 is y, 4 is z. From corner 0 to corner 7 there are six paths along the cube's
 * edges, and each has the corners of one tetrahedron. Two corners are swapped where its volume would be negative. */
static const uint8_t tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                         {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

/* Even permutations, which keep the sign of the volume: with the corners that are inside first. */
static const uint8_t orders[16][4] = {
    [1] = {0, 1, 2, 3},  [2] = {1, 0, 3, 2},  [4] = {2, 3, 0, 1},  [8] = {3, 2, 1, 0},  [3] = {0, 1, 2, 3},
    [5] = {0, 2, 3, 1},  [9] = {0, 3, 1, 2},  [6] = {1, 2, 0, 3},  [10] = {1, 3, 2, 0}, [12] = {2, 3, 0, 1},
    [14] = {0, 1, 2, 3}, [13] = {1, 0, 3, 2}, [11] = {2, 3, 0, 1}, [7] = {3, 2, 1, 0},
};

typedef struct builder {
    const field *from;
    float level;
    water_mesh *mesh;
    size_t vertex_room, triangle_room;
    uint32_t **edges; /* for each block, vertices of its points' edges, EDGES a point; NULL: none yet */
} builder;

/* A block and its seven neighbours on the upper sides; corners as of a cube. UINT32_MAX: there is none. */
typedef struct around {
    uint32_t index[8];
} around;

static const field_point nothing;

static uint32_t index_of(const field *from, const int32_t cell[3])
{
    const field_block *block = field_find(from, cell);
    if (!block)
        return UINT32_MAX;
    return block->index;
}

static around find_around(const field *from, uint32_t index)
{
    around found;
    for (int corner = 0; corner < 8; corner++) {
        int32_t cell[3];
        for (int axis = 0; axis < 3; axis++)
            cell[axis] = from->blocks[index]->cell[axis] + (corner >> axis & 1);
        found.index[corner] = index_of(from, cell);
    }
    return found;
}

/* Where a point is: coordinates from the current block's first point, from 0 to SIDE. */
typedef struct place {
    uint32_t block, point;
} place;

static place place_of(const around *near, const int32_t at[3])
{
    uint32_t corner = 0, point = 0;
    for (int axis = 2; axis >= 0; axis--) {
        corner |= (uint32_t)(at[axis] >= SIDE) << axis;
        point = point * SIDE + (uint32_t)at[axis] % SIDE;
    }
    return (place){near->index[corner], point};
}

static const field_point *point_at(const field *from, place at)
{
    return at.block == UINT32_MAX ? &nothing : &from->blocks[at.block]->points[at.point];
}

/* ---- vertices */

static const field_point *point_far(const field *from, const int32_t at[3])
{
    int32_t cell[3];
    uint32_t point = 0;
    for (int axis = 2; axis >= 0; axis--) {
        cell[axis] = (at[axis] < 0 ? at[axis] - (SIDE - 1) : at[axis]) / SIDE;
        point = point * SIDE + (uint32_t)(at[axis] - cell[axis] * SIDE);
    }
    const field_block *block = field_find(from, cell);
    return block ? &block->points[point] : &nothing;
}

/* The density falls along it: out of the water. Central differences, not yet of unit length. */
static void slope_at(const field *from, const int32_t at[3], double slope[3])
{
    for (int axis = 0; axis < 3; axis++) {
        int32_t low[3] = {at[0], at[1], at[2]}, high[3] = {at[0], at[1], at[2]};
        low[axis]--;
        high[axis]++;
        slope[axis] = (double)point_far(from, low)->density - (double)point_far(from, high)->density;
    }
}

static void normalize(double v[3], float out[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int axis = 0; axis < 3; axis++)
        out[axis] = length > 0 ? (float)(v[axis] / length) : (float)(axis == 1);
}

static void fill_vertex(const builder *b, const int32_t a[3], const int32_t c[3], mesh_vertex *out)
{
    const field_point *pa = point_far(b->from, a), *pc = point_far(b->from, c);
    const double t = ((double)b->level - (double)pa->density) / ((double)pc->density - (double)pa->density);
    double sa[3], sc[3], slope[3];
    slope_at(b->from, a, sa);
    slope_at(b->from, c, sc);
    for (int axis = 0; axis < 3; axis++) {
        const double momentum = (double)pa->momentum[axis] * (1 - t) + (double)pc->momentum[axis] * t;
        out->position[axis] = (float)(b->from->point_m * (a[axis] + t * (c[axis] - a[axis])));
        out->velocity[axis] = (float)(momentum / (double)b->level); /* which is the density there */
        slope[axis] = sa[axis] * (1 - t) + sc[axis] * t;
    }
    normalize(slope, out->normal);
}

static bool grow(void **rows, size_t *room, size_t used, size_t size)
{
    if (used < *room)
        return true;
    const size_t more = *room ? 2 * *room : 4096;
    void *grown = used < 0x7fffffff ? realloc(*rows, more * size) : NULL;
    if (!grown)
        return false;
    *rows = grown;
    *room = more;
    return true;
}

/* The entry for the edge of two corners of a cube; it is kept with the lower corner. */
static uint32_t *edge_entry(builder *b, const around *near, const int32_t low[3], int to)
{
    const place at = place_of(near, low);
    if (at.block == UINT32_MAX)
        return NULL;
    uint32_t **edges = &b->edges[at.block];
    if (!*edges) {
        *edges = malloc((size_t)FIELD_POINTS * EDGES * sizeof **edges);
        if (!*edges)
            return NULL;
        memset(*edges, 0xff, (size_t)FIELD_POINTS * EDGES * sizeof **edges);
    }
    return &(*edges)[at.point * EDGES + (uint32_t)to - 1];
}

/* The vertex on the edge between two corners. NO_VERTEX: no memory. */
static uint32_t vertex_on(builder *b, const around *near, const int32_t cube[3], int a, int c)
{
    const int lower = a & c; /* one of the two: all corners of a tetrahedron are on one path */
    const int upper = a | c;
    const int32_t *first = b->from->blocks[near->index[0]]->cell;
    int32_t low[3], from[3], to[3];
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = cube[axis] + (lower >> axis & 1);
        from[axis] = first[axis] * SIDE + low[axis];
        to[axis] = first[axis] * SIDE + cube[axis] + (upper >> axis & 1);
    }
    uint32_t *entry = edge_entry(b, near, low, upper & ~lower);
    if (!entry)
        return NO_VERTEX;
    if (*entry != NO_VERTEX)
        return *entry;
    if (!grow((void **)&b->mesh->vertices, &b->vertex_room, b->mesh->vertex_count, sizeof(mesh_vertex)))
        return NO_VERTEX;
    fill_vertex(b, from, to, &b->mesh->vertices[b->mesh->vertex_count]);
    return *entry = b->mesh->vertex_count++;
}

/* ---- triangles */

static bool add_triangle(builder *b, const uint32_t corners[3])
{
    water_mesh *mesh = b->mesh;
    if (corners[0] == NO_VERTEX || corners[1] == NO_VERTEX || corners[2] == NO_VERTEX ||
        !grow((void **)&mesh->triangles, &b->triangle_room, mesh->triangle_count, sizeof *mesh->triangles))
        return false;
    memcpy(mesh->triangles[mesh->triangle_count++], corners, sizeof *mesh->triangles);
    return true;
}

/* The surface in one tetrahedron of positive volume: around the one corner that is inside or outside, or between two
 * and two. */
static bool add_tetrahedron(builder *b, const around *near, const int32_t cube[3], const uint8_t corners[4],
                            uint32_t inside)
{
    const uint8_t *order = orders[inside];
    int c[4];
    uint32_t v[4];
    for (int i = 0; i < 4; i++)
        c[i] = corners[order[i]];
    const bool two = inside == 3 || inside == 5 || inside == 9 || inside == 6 || inside == 10 || inside == 12;
    if (two) {
        v[0] = vertex_on(b, near, cube, c[0], c[2]);
        v[1] = vertex_on(b, near, cube, c[0], c[3]);
        v[2] = vertex_on(b, near, cube, c[1], c[3]);
        v[3] = vertex_on(b, near, cube, c[1], c[2]);
        return add_triangle(b, v) && add_triangle(b, (uint32_t[]){v[0], v[2], v[3]});
    }
    const bool one_inside = (inside & (inside - 1)) == 0;
    v[0] = vertex_on(b, near, cube, c[0], c[1]);
    v[1] = vertex_on(b, near, cube, c[0], c[one_inside ? 2 : 3]);
    v[2] = vertex_on(b, near, cube, c[0], c[one_inside ? 3 : 2]);
    return add_triangle(b, v);
}

static bool add_cube(builder *b, const around *near, const int32_t cube[3])
{
    uint32_t inside = 0;
    for (int corner = 0; corner < 8; corner++) {
        int32_t at[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = cube[axis] + (corner >> axis & 1);
        inside |= (uint32_t)(point_at(b->from, place_of(near, at))->density > b->level) << corner;
    }
    if (inside == 0 || inside == 255)
        return true;
    for (int i = 0; i < 6; i++) {
        uint32_t mask = 0;
        for (int k = 0; k < 4; k++)
            mask |= (inside >> tetrahedra[i][k] & 1) << k;
        if (mask && mask != 15 && !add_tetrahedron(b, near, cube, tetrahedra[i], mask))
            return false;
    }
    return true;
}

static bool add_block(builder *b, uint32_t index)
{
    const around near = find_around(b->from, index);
    int32_t cube[3];
    for (cube[2] = 0; cube[2] < SIDE; cube[2]++)
        for (cube[1] = 0; cube[1] < SIDE; cube[1]++)
            for (cube[0] = 0; cube[0] < SIDE; cube[0]++)
                if (!add_cube(b, &near, cube))
                    return false;
    return true;
}

bool water_mesh_create(water_mesh *mesh, const field *from, double level)
{
    builder b = {.from = from, .level = (float)level, .mesh = mesh};
    *mesh = (water_mesh){0};
    b.edges = calloc((size_t)from->count + 1, sizeof *b.edges);
    bool ok = b.edges;
    for (uint32_t i = 0; i < from->count && ok; i++)
        ok = add_block(&b, i);
    for (uint32_t i = 0; i < from->count && b.edges; i++)
        free(b.edges[i]);
    free(b.edges);
    if (!ok)
        water_mesh_destroy(mesh);
    return ok;
}

void water_mesh_destroy(water_mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->triangles);
    *mesh = (water_mesh){0};
}
