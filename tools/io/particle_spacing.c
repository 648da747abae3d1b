/* particle_spacing.c - distances to neighbours, and the number of particles per volume.
 *
 * The median distance to the nearest neighbour is the scale on which to look, but not the spacing: on a lattice both
 * are the same, and in a jittered set the nearest neighbour is nearer. The number density is what counts, as the volume
 * of a particle is its inverse. It is the sum of a kernel over the neighbours (Monaghan 2005, "Smoothed particle
 * hydrodynamics", equation 2.5 with masses of 1), at some hundred particles. Those near the surface see less, so the
 * upper decile stands for the inside. */
#include "particle_spacing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 768, MIN_PARTICLES = 64, MAX_SEARCH = 3, REFINEMENTS = 12, CROWDED = 24 };

#define KERNEL_NEAREST 4.0 /* radius of the kernel, in median distances to the nearest neighbour */

/* Rows by hashed cell: those of bucket k are order[start[k]] to order[start[k + 1] - 1]. */
typedef struct cells {
    const particles *frame;
    double side;
    uint32_t mask;
    uint32_t *start, *order;
} cells;

static bool is_finite(const float at[3])
{
    return isfinite(at[0]) && isfinite(at[1]) && isfinite(at[2]);
}

static int64_t cell_of(const cells *grid, double at)
{
    const double cell = floor(at / grid->side);
    return cell > 1e15 ? (int64_t)1e15 : cell < -1e15 ? (int64_t)-1e15 : (int64_t)cell;
}

static uint32_t bucket_of(const cells *grid, const int64_t cell[3])
{
    uint64_t hash = (uint64_t)cell[0] * 0x9e3779b97f4a7c15u;
    hash = (hash ^ (hash >> 29)) + (uint64_t)cell[1] * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ (hash >> 29)) + (uint64_t)cell[2] * 0x94d049bb133111ebu;
    hash = (hash ^ (hash >> 32)) * 0x9e3779b97f4a7c15u;
    return (uint32_t)(hash >> 32) & grid->mask;
}

static uint32_t bucket_at(const cells *grid, uint32_t row)
{
    int64_t cell[3];
    for (int axis = 0; axis < 3; axis++)
        cell[axis] = cell_of(grid, (double)grid->frame->position[row][axis]);
    return bucket_of(grid, cell);
}

/* A counting sort by bucket. */
static void sort_cells(cells *grid, double side)
{
    const uint32_t count = grid->frame->count;
    grid->side = side;
    memset(grid->start, 0, ((size_t)grid->mask + 2) * sizeof *grid->start);
    for (uint32_t row = 0; row < count; row++)
        if (is_finite(grid->frame->position[row]))
            grid->start[bucket_at(grid, row) + 1]++;
    for (uint32_t i = 0; i <= grid->mask; i++)
        grid->start[i + 1] += grid->start[i];
    for (uint32_t row = 0; row < count; row++)
        if (is_finite(grid->frame->position[row]))
            grid->order[grid->start[bucket_at(grid, row)]++] = row;
    memmove(grid->start + 1, grid->start, ((size_t)grid->mask + 1) * sizeof *grid->start);
    grid->start[0] = 0;
}

/* Particles in the bucket of a particle, on average over particles. */
static double crowd(const cells *grid)
{
    double squares = 0;
    for (uint32_t i = 0; i <= grid->mask; i++) {
        const double there = grid->start[i + 1] - grid->start[i];
        squares += there * there;
    }
    return squares / fmax(grid->start[grid->mask + 1], 1);
}

/* Calls for every other particle within `reach` cells. A bucket can hold other cells, so the caller looks at distances;
 * two cells of one bucket give its particles twice, so those of other cells are left out here. */
static void visit(const cells *grid, uint32_t row, int reach, void (*call)(double distance2, void *user), void *user)
{
    const float *at = grid->frame->position[row];
    int64_t middle[3], cell[3];
    for (int axis = 0; axis < 3; axis++)
        middle[axis] = cell_of(grid, (double)at[axis]);
    for (int i = 0; i < (2 * reach + 1) * (2 * reach + 1) * (2 * reach + 1); i++) {
        cell[0] = middle[0] + i % (2 * reach + 1) - reach;
        cell[1] = middle[1] + i / (2 * reach + 1) % (2 * reach + 1) - reach;
        cell[2] = middle[2] + i / (2 * reach + 1) / (2 * reach + 1) - reach;
        const uint32_t bucket = bucket_of(grid, cell);
        for (uint32_t k = grid->start[bucket]; k < grid->start[bucket + 1]; k++) {
            const float *other = grid->frame->position[grid->order[k]];
            double distance2 = 0;
            bool same = grid->order[k] != row;
            for (int axis = 0; axis < 3; axis++) {
                same = same && cell_of(grid, (double)other[axis]) == cell[axis];
                distance2 += ((double)other[axis] - (double)at[axis]) * ((double)other[axis] - (double)at[axis]);
            }
            if (same)
                call(distance2, user);
        }
    }
}

static void keep_nearest(double distance2, void *user)
{
    double *nearest2 = user;
    *nearest2 = fmin(*nearest2, distance2);
}

typedef struct kernel_sum {
    double radius, sum;
} kernel_sum;

/* (1 - q^2)^3, whose integral over the ball of radius R is 64 pi R^3 / 315. It is as smooth as a sum over a lattice
 * needs to be within 1 % of the integral. */
static void add_kernel(double distance2, void *user)
{
    kernel_sum *kernel = user;
    const double u = 1 - distance2 / (kernel->radius * kernel->radius);
    kernel->sum += u > 0 ? u * u * u : 0;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Rows that are looked at: spread over all. */
static uint32_t sample_row(const particles *frame, uint32_t i)
{
    return frame->count <= SAMPLES ? i : (uint32_t)((uint64_t)frame->count * i / SAMPLES);
}

static uint32_t sample_count(const particles *frame)
{
    return frame->count < SAMPLES ? frame->count : SAMPLES;
}

/* The side of a cell from the middle 90 % of the particles, which one that flew off does not change. */
static double first_side(const particles *frame)
{
    double values[SAMPLES], widest = 0;
    for (int axis = 0; axis < 3; axis++) {
        uint32_t count = 0;
        for (uint32_t i = 0; i < sample_count(frame); i++)
            if (is_finite(frame->position[sample_row(frame, i)]))
                values[count++] = (double)frame->position[sample_row(frame, i)][axis];
        if (count < MIN_PARTICLES / 2)
            return 0;
        qsort(values, count, sizeof *values, compare);
        widest = fmax(widest, values[count - 1 - count / 20] - values[count / 20]);
    }
    return 2 * widest / cbrt(frame->count);
}

static double median_nearest(const cells *grid)
{
    double values[SAMPLES];
    uint32_t count = 0;
    for (uint32_t i = 0; i < sample_count(grid->frame); i++) {
        const uint32_t row = sample_row(grid->frame, i);
        double nearest2 = INFINITY;
        for (int reach = 1; reach <= MAX_SEARCH && is_finite(grid->frame->position[row]); reach++) {
            visit(grid, row, reach, keep_nearest, &nearest2);
            if (nearest2 <= reach * reach * grid->side * grid->side)
                break; /* what is farther than the cells that were looked at can not be nearer */
        }
        if (isfinite(nearest2))
            values[count++] = sqrt(nearest2);
    }
    if (count < MIN_PARTICLES / 2)
        return 0;
    qsort(values, count, sizeof *values, compare);
    return values[count / 2];
}

static double inner_density(const cells *grid, double radius)
{
    double values[SAMPLES];
    uint32_t count = 0;
    for (uint32_t i = 0; i < sample_count(grid->frame); i++) {
        const uint32_t row = sample_row(grid->frame, i);
        kernel_sum kernel = {.radius = radius, .sum = 1}; /* its own */
        if (!is_finite(grid->frame->position[row]))
            continue;
        visit(grid, row, (int)ceil(radius / grid->side), add_kernel, &kernel);
        values[count++] = kernel.sum * 315 / (64 * M_PI * radius * radius * radius);
    }
    qsort(values, count, sizeof *values, compare);
    return count ? values[count * 9 / 10] : 0;
}

static bool measure(cells *grid, double side, particle_spacing *guess)
{
    sort_cells(grid, side);
    for (int i = 0; i < REFINEMENTS && crowd(grid) > CROWDED; i++)
        sort_cells(grid, grid->side / 2);
    guess->nearest = median_nearest(grid);
    if (!(guess->nearest > 0))
        return false;
    sort_cells(grid, KERNEL_NEAREST / 2 * guess->nearest);
    guess->spacing = 1 / cbrt(inner_density(grid, KERNEL_NEAREST * guess->nearest));
    return isfinite(guess->spacing) && guess->spacing > 0;
}

bool particle_spacing_guess(const particles *frame, particle_spacing *guess)
{
    *guess = (particle_spacing){0};
    const double side = frame->count < MIN_PARTICLES ? 0 : first_side(frame);
    cells grid = {.frame = frame, .mask = 1023};
    if (!(side > 0 && isfinite(side)))
        return false;
    while (grid.mask < frame->count)
        grid.mask = 2 * grid.mask + 1;
    grid.start = malloc(((size_t)grid.mask + 2) * sizeof *grid.start);
    grid.order = malloc((size_t)frame->count * sizeof *grid.order);
    const bool ok = grid.start && grid.order && measure(&grid, side, guess);
    free(grid.start);
    free(grid.order);
    return ok;
}

bool particles_bounds(const particles *frame, float low[3], float high[3], uint32_t *invalid)
{
    *invalid = 0;
    for (uint32_t row = 0; row < frame->count; row++) {
        const float *at = frame->position[row];
        if (!is_finite(at)) {
            ++*invalid;
            continue;
        }
        const bool first = row == *invalid;
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = first || at[axis] < low[axis] ? at[axis] : low[axis];
            high[axis] = first || at[axis] > high[axis] ? at[axis] : high[axis];
        }
    }
    return *invalid < frame->count;
}
