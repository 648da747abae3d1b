/* particle_pair.c - partners by id, Hermite curves, and fading. */
#include "particle_pair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- partners */

static bool is_there(const particles *frame, uint32_t row)
{
    const float *at = frame->position[row];
    return isfinite(at[0]) && isfinite(at[1]) && isfinite(at[2]);
}

/* A hash table of rows by id, with open addressing. */
typedef struct id_table {
    uint32_t *rows; /* PAIR_NONE: free */
    uint32_t mask;
} id_table;

/* The entry of an id, or the free one where it belongs. */
static uint32_t *find_entry(const id_table *table, const particles *frame, uint32_t id)
{
    uint32_t at = (uint32_t)((id * 0x9e3779b97f4a7c15u) >> 32) & table->mask;
    while (table->rows[at] != PAIR_NONE && frame->id[table->rows[at]] != id)
        at = (at + 1) & table->mask;
    return &table->rows[at];
}

static bool make_table(id_table *table, const particles *frame, uint32_t *twice)
{
    uint32_t size = 16;
    while (size < 2 * frame->count)
        size *= 2;
    *twice = PAIR_NONE;
    table->mask = size - 1;
    table->rows = malloc((size_t)size * sizeof *table->rows);
    if (!table->rows)
        return false;
    memset(table->rows, 0xff, (size_t)size * sizeof *table->rows);
    for (uint32_t row = 0; row < frame->count; row++) {
        uint32_t *entry = find_entry(table, frame, frame->id[row]);
        if (*entry != PAIR_NONE) {
            *twice = row;
            free(table->rows);
            return false;
        }
        *entry = row;
    }
    return true;
}

static void join(particle_pair *pair, uint32_t row_a, uint32_t row_b)
{
    if (!is_there(pair->a, row_a) || !is_there(pair->b, row_b) || pair->partner_of_b[row_b] != PAIR_NONE)
        return;
    pair->partner_of_a[row_a] = row_b;
    pair->partner_of_b[row_b] = row_a;
}

static bool join_ids(particle_pair *pair, uint32_t *twice)
{
    id_table table;
    if (!make_table(&table, pair->b, twice))
        return false;
    for (uint32_t row = 0; row < pair->a->count; row++) {
        const uint32_t other = *find_entry(&table, pair->b, pair->a->id[row]);
        if (other != PAIR_NONE)
            join(pair, row, other);
    }
    free(table.rows);
    return true;
}

static uint32_t *make_partners(uint32_t count)
{
    uint32_t *partners = malloc(((size_t)count + 1) * sizeof *partners);
    if (partners)
        memset(partners, 0xff, ((size_t)count + 1) * sizeof *partners);
    return partners;
}

bool pair_match(particle_pair *pair, const particles *a, const particles *b, particle_ids ids, uint32_t *twice)
{
    *pair = (particle_pair){.a = a, .b = b};
    *twice = PAIR_NONE;
    if (ids == PARTICLE_IDS_NONE || (ids == PARTICLE_IDS_FILE && (!a->id || !b->id)))
        return true;
    pair->partner_of_a = make_partners(a->count);
    pair->partner_of_b = make_partners(b->count);
    bool ok = pair->partner_of_a && pair->partner_of_b;
    if (ok && ids == PARTICLE_IDS_FILE)
        ok = join_ids(pair, twice);
    else
        for (uint32_t row = 0; ok && row < a->count && row < b->count; row++)
            join(pair, row, row);
    if (!ok)
        pair_free(pair);
    return ok;
}

void pair_free(particle_pair *pair)
{
    free(pair->partner_of_a);
    free(pair->partner_of_b);
    *pair = (particle_pair){0};
}

/* ---- between two frames */

static uint32_t id_of(const particles *frame, uint32_t row)
{
    return frame->id ? frame->id[row] : row;
}

static double velocity_of(const particles *frame, uint32_t row, int axis)
{
    return frame->velocity && isfinite(frame->velocity[row][axis]) ? (double)frame->velocity[row][axis] : 0;
}

/* The cubic that has position and velocity of both ends, and its derivative. With s = t / h and p, v at the ends a, b:
 *
 *     p(s) = (2s^3 - 3s^2 + 1) p_a + (s^3 - 2s^2 + s) h v_a + (3s^2 - 2s^3) p_b + (s^3 - s^2) h v_b
 *
 * It is off by at most h^4 / 384 times the fourth derivative of the motion. */
static void mix_curve(const particle_pair *pair, uint32_t row_a, uint32_t row_b, double h, double s,
                      particle_sample *out)
{
    for (int axis = 0; axis < 3; axis++) {
        const double pa = (double)pair->a->position[row_a][axis], pb = (double)pair->b->position[row_b][axis];
        const bool moving = pair->a->velocity && pair->b->velocity;
        const double va = moving ? velocity_of(pair->a, row_a, axis) : (pb - pa) / h;
        const double vb = moving ? velocity_of(pair->b, row_b, axis) : (pb - pa) / h;
        const double up = s * s * (3 - 2 * s), rise = 6 * s * (1 - s) / h;
        out->position[axis] = (float)(pa + up * (pb - pa) + s * (1 - s) * h * ((1 - s) * va - s * vb));
        out->velocity[axis] = (float)(rise * (pb - pa) + (1 - s) * (1 - 3 * s) * va + s * (3 * s - 2) * vb);
    }
    out->share = 1;
    out->id = id_of(pair->a, row_a);
}

/* Moves by its own velocity for `dt` seconds. */
static void mix_alone(const particles *frame, uint32_t row, double dt, double share, particle_sample *out)
{
    for (int axis = 0; axis < 3; axis++) {
        const double v = velocity_of(frame, row, axis);
        out->position[axis] = (float)((double)frame->position[row][axis] + v * dt);
        out->velocity[axis] = (float)v;
    }
    out->share = (float)share;
    out->id = id_of(frame, row);
}

uint32_t pair_mix(const particle_pair *pair, double interval_s, double part, particle_sample *samples)
{
    const double share = part * part * (3 - 2 * part);
    uint32_t count = 0;
    for (uint32_t row = 0; row < pair->a->count; row++) {
        const uint32_t partner = pair->partner_of_a ? pair->partner_of_a[row] : PAIR_NONE;
        if (partner != PAIR_NONE)
            mix_curve(pair, row, partner, interval_s, part, &samples[count++]);
        else if (is_there(pair->a, row))
            mix_alone(pair->a, row, part * interval_s, 1 - share, &samples[count++]);
    }
    for (uint32_t row = 0; row < pair->b->count && share > 0; row++)
        if (!(pair->partner_of_b && pair->partner_of_b[row] != PAIR_NONE) && is_there(pair->b, row))
            mix_alone(pair->b, row, (part - 1) * interval_s, share, &samples[count++]);
    return count;
}

uint32_t pair_rest(const particles *a, particle_sample *samples)
{
    const particles still = {.count = a->count, .position = a->position, .id = a->id};
    uint32_t count = 0;
    for (uint32_t row = 0; row < a->count; row++)
        if (is_there(a, row))
            mix_alone(&still, row, 0, 1, &samples[count++]);
    return count;
}
