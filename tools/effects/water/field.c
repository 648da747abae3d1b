/* field.c - particles added up on a sparse grid. */
#include "field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define POINTS_PER_RADIUS 4   /* as VIRGA_WATER_SIDE */
#define FAR               1e8 /* points; a particle that is farther from the origin is left out */
#define NO_BLOCK          UINT32_MAX

static uint32_t hash_of(const int32_t cell[3])
{
    uint64_t hash = (uint64_t)(uint32_t)cell[0] * 0x9e3779b97f4a7c15u;
    hash = (hash ^ (hash >> 29)) + (uint64_t)(uint32_t)cell[1] * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ (hash >> 29)) + (uint64_t)(uint32_t)cell[2] * 0x94d049bb133111ebu;
    return (uint32_t)((hash ^ (hash >> 32)) * 0x9e3779b97f4a7c15u >> 32);
}

/* The entry of a cell, or the free one where it belongs. */
static uint32_t *entry_of(const field *from, const int32_t cell[3])
{
    uint32_t at = hash_of(cell) & from->table_mask;
    while (from->table[at] != NO_BLOCK && memcmp(from->blocks[from->table[at]]->cell, cell, 3 * sizeof *cell) != 0)
        at = (at + 1) & from->table_mask;
    return &from->table[at];
}

field_block *field_find(const field *from, const int32_t cell[3])
{
    const uint32_t index = from->table ? *entry_of(from, cell) : NO_BLOCK;
    return index == NO_BLOCK ? NULL : from->blocks[index];
}

/* Twice the room, and a table that is at most half full. */
static bool grow(field *made)
{
    const uint32_t room = made->room ? 2 * made->room : 256;
    field_block **blocks = realloc(made->blocks, room * sizeof *blocks);
    if (blocks)
        made->blocks = blocks;
    uint32_t *table = malloc((size_t)room * 2 * sizeof *table);
    if (!blocks || !table) {
        free(table);
        return false;
    }
    free(made->table);
    made->table = table;
    made->table_mask = 2 * room - 1;
    made->room = room;
    memset(table, 0xff, (size_t)room * 2 * sizeof *table);
    for (uint32_t i = 0; i < made->count; i++)
        *entry_of(made, made->blocks[i]->cell) = i;
    return true;
}

static field_block *find_or_add(field *made, const int32_t cell[3])
{
    field_block *block = field_find(made, cell);
    if (block)
        return block;
    if (made->count == made->room && !grow(made))
        return NULL;
    block = calloc(1, sizeof *block);
    if (!block)
        return NULL;
    memcpy(block->cell, cell, sizeof block->cell);
    block->index = made->count;
    *entry_of(made, cell) = made->count;
    made->blocks[made->count++] = block;
    return block;
}

/* ---- a particle */

typedef struct splat {
    double at[3], h, weight; /* in points; of the kernel's middle */
    float velocity[3];
    int32_t low[3], high[3]; /* points that it reaches */
} splat;

static bool make_splat(const field_def *def, double point_m, const virga_particle_gpu *from, splat *out)
{
    const double h = def->kernel_spacings * def->spacing_m;
    *out = (splat){.h = h / point_m, .weight = 315 * def->volume_m3 * (double)from->share / (64 * M_PI * h * h * h)};
    if (!(from->share > 0 && from->share <= 1))
        return false;
    for (int axis = 0; axis < 3; axis++) {
        out->at[axis] = (double)from->position[axis] / point_m;
        out->velocity[axis] = isfinite(from->velocity[axis]) ? from->velocity[axis] : 0;
        if (!(fabs(out->at[axis]) < FAR))
            return false;
        out->low[axis] = (int32_t)ceil(out->at[axis] - out->h);
        out->high[axis] = (int32_t)floor(out->at[axis] + out->h);
    }
    return true;
}

/* Equations 1 and 2: W'(r) = 315 v / (64 pi h^3) (1 - (r / h)^2)^3. */
static void add_to_block(const splat *from, field_block *block)
{
    for (int i = 0; i < FIELD_POINTS; i++) {
        const int32_t at[3] = {i % FIELD_SIDE, i / FIELD_SIDE % FIELD_SIDE, i / FIELD_SIDE / FIELD_SIDE};
        double r2 = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double apart = block->cell[axis] * FIELD_SIDE + at[axis] - from->at[axis];
            r2 += apart * apart;
        }
        const double u = 1 - r2 / (from->h * from->h);
        if (!(u > 0))
            continue;
        const double density = from->weight * u * u * u;
        block->points[i].density += (float)density;
        for (int axis = 0; axis < 3; axis++)
            block->points[i].momentum[axis] += (float)(density * (double)from->velocity[axis]);
    }
}

static int32_t block_of(int32_t point)
{
    return (point < 0 ? point - (FIELD_SIDE - 1) : point) / FIELD_SIDE;
}

/* Blocks reach one point lower than the particle, so that cubes and edges that end at a point with density begin in a
 * block. */
static bool add_particle(field *made, const splat *from)
{
    int32_t low[3], high[3], cell[3];
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = block_of(from->low[axis] - 1);
        high[axis] = block_of(from->high[axis]);
    }
    for (cell[2] = low[2]; cell[2] <= high[2]; cell[2]++)
        for (cell[1] = low[1]; cell[1] <= high[1]; cell[1]++)
            for (cell[0] = low[0]; cell[0] <= high[0]; cell[0]++) {
                field_block *block = find_or_add(made, cell);
                if (!block)
                    return false;
                add_to_block(from, block);
            }
    return true;
}

bool field_create(field *made, const field_def *def)
{
    splat from;
    *made = (field){.point_m = def->kernel_spacings * def->spacing_m / POINTS_PER_RADIUS};
    for (uint32_t i = 0; i < def->count; i++)
        if (make_splat(def, made->point_m, &def->particles[i], &from) && !add_particle(made, &from)) {
            field_destroy(made);
            return false;
        }
    return true;
}

void field_destroy(field *made)
{
    for (uint32_t i = 0; i < made->count; i++)
        free(made->blocks[i]);
    free(made->blocks);
    free(made->table);
    *made = (field){0};
}
