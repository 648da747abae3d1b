/* distort.c - resamples between a pinhole's picture and that of a real lens. */
#include "shot/distort.h"

#include "host.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool shot_distortion_open(shot_distortion *d, const distortion_map *map, char *error, size_t error_size)
{
    const uint32_t width = map->size[0], height = map->size[1];
    d->map = *map;
    d->pinhole_at = malloc((size_t)width * height * 2 * sizeof *d->pinhole_at);
    if (!d->pinhole_at)
        return host_fail(error, error_size, "no memory for the distortion of %u x %u pixels", width, height);
    for (size_t i = 0; i < (size_t)width * height; i++) {
        const double at[2] = {(double)(i % width) + 0.5, (double)(i / width) + 0.5};
        double pinhole[2] = {0, 0};
        distortion_map_undo(map, at, pinhole); /* the map's border was looked at when it was opened */
        d->pinhole_at[2 * i] = (float)pinhole[0];
        d->pinhole_at[2 * i + 1] = (float)pinhole[1];
    }
    return true;
}

void shot_distortion_close(shot_distortion *d)
{
    free(d->pinhole_at);
    d->pinhole_at = NULL;
}

/* ---- the filter */

/* A quadratic B-spline as wide as a pixel of either picture, whichever is larger: never below zero, so that nothing
 * rings, and its mean over places is 1, so that rain neither gains nor loses light. */
static double spline(double t)
{
    const double away = fabs(t);
    return away < 0.5 ? 0.75 - t * t : away < 1.5 ? 0.5 * (1.5 - away) * (1.5 - away) : 0;
}

#define MOST_TAPS 32 /* to each side, of a pixel that covers many */

typedef struct footprint {
    double at[2];      /* in the picture that is read */
    double inverse[2]; /* half the box of pixels that count */
    double m[2][2];    /* from pixels that are read to the spline's argument */
} footprint;

/* `jacobian`: pixels that are written a pixel that is read. */
static footprint footprint_of(const double at[2], const double jacobian[2][2])
{
    footprint f = {.at = {at[0], at[1]}};
    for (int row = 0; row < 2; row++) {
        const double larger = fmax(1, hypot(jacobian[row][0], jacobian[row][1]));
        for (int column = 0; column < 2; column++)
            f.m[row][column] = jacobian[row][column] / larger;
    }
    const double det = fabs(f.m[0][0] * f.m[1][1] - f.m[0][1] * f.m[1][0]);
    for (int axis = 0; axis < 2; axis++) {
        const double sum = fabs(f.m[!axis][!axis]) + fabs(f.m[axis == 0 ? 0 : 1][axis == 0 ? 1 : 0]);
        f.inverse[axis] = det > 0 ? fmin(1.5 * sum / det, MOST_TAPS) : MOST_TAPS;
    }
    return f;
}

static size_t clamped(int i, uint32_t count)
{
    return (size_t)(i < 0 ? 0 : i >= (int)count ? (int)count - 1 : i);
}

/* Means of RGBA pictures of one size over a footprint. */
static void gather(const footprint *f, const float *const *pictures, uint32_t count, const uint32_t size[2],
                   double (*sums)[4])
{
    double weights = 0;
    memset(sums, 0, count * sizeof *sums);
    const int first[2] = {(int)ceil(f->at[0] - f->inverse[0] - 0.5), (int)ceil(f->at[1] - f->inverse[1] - 0.5)};
    const int last[2] = {(int)floor(f->at[0] + f->inverse[0] - 0.5), (int)floor(f->at[1] + f->inverse[1] - 0.5)};
    for (int y = first[1]; y <= last[1]; y++)
        for (int x = first[0]; x <= last[0]; x++) {
            const double off[2] = {x + 0.5 - f->at[0], y + 0.5 - f->at[1]};
            const double weight =
                spline(f->m[0][0] * off[0] + f->m[0][1] * off[1]) * spline(f->m[1][0] * off[0] + f->m[1][1] * off[1]);
            const size_t pixel = clamped(y, size[1]) * size[0] + clamped(x, size[0]);
            weights += weight;
            for (uint32_t k = 0; k < count && weight > 0; k++)
                for (size_t c = 0; c < 4; c++)
                    sums[k][c] += weight * (double)pictures[k][4 * pixel + c];
        }
    for (uint32_t k = 0; k < count; k++)
        for (size_t c = 0; c < 4; c++)
            sums[k][c] /= weights;
}

/* ---- undone */

static void invert(double m[2][2])
{
    const double det = m[0][0] * m[1][1] - m[0][1] * m[1][0], first = m[0][0];
    m[0][0] = m[1][1] / det;
    m[1][1] = first / det;
    m[0][1] /= -det;
    m[1][0] /= -det;
}

void shot_distortion_undo_color(const shot_distortion *d, const float *rgba, float *pinhole)
{
    const distortion_map *map = &d->map;
    for (size_t i = 0; i < (size_t)map->pinhole_size[0] * map->pinhole_size[1]; i++) {
        const double at[2] = {(double)(i % map->pinhole_size[0]) + 0.5, (double)(i / map->pinhole_size[0]) + 0.5};
        double seen[2], jacobian[2][2], sum[1][4];
        distortion_map_apply(map, at, seen, jacobian);
        invert(jacobian);
        for (int axis = 0; axis < 2; axis++)
            seen[axis] = fmin(fmax(seen[axis], 0.5), map->size[axis] - 0.5);
        const footprint f = footprint_of(seen, jacobian);
        gather(&f, &rgba, 1, map->size, sum);
        for (size_t c = 0; c < 4; c++)
            pinhole[4 * i + c] = (float)sum[0][c];
    }
}

void shot_distortion_undo_nearest(const shot_distortion *d, const float *values, float *pinhole)
{
    const distortion_map *map = &d->map;
    for (size_t i = 0; i < (size_t)map->pinhole_size[0] * map->pinhole_size[1]; i++) {
        const double at[2] = {(double)(i % map->pinhole_size[0]) + 0.5, (double)(i / map->pinhole_size[0]) + 0.5};
        double seen[2];
        distortion_map_apply(map, at, seen, NULL);
        pinhole[i] = values[clamped((int)floor(seen[1]), map->size[1]) * map->size[0] +
                            clamped((int)floor(seen[0]), map->size[0])];
    }
}

/* ---- redone */

/* An offset of the pinhole's picture as one of the distorted picture. */
static void distort_offset(const distortion_map *map, const double at[2], shot_distortion_kind kind, float offset[2])
{
    const double sign = kind == SHOT_DISTORT_MOTION ? -1 : 1;
    const double other[2] = {at[0] + sign * (double)offset[0], at[1] + sign * (double)offset[1]};
    double here[2], there[2];
    if (offset[0] == 0 && offset[1] == 0)
        return;
    distortion_map_apply(map, at, here, NULL);
    distortion_map_apply(map, other, there, NULL);
    for (int axis = 0; axis < 2; axis++)
        offset[axis] = (float)(sign * (there[axis] - here[axis]));
}

typedef struct redo {
    const shot_distortion *d;
    const host_drawn *pinhole;
    const shot_distortion_kind *kinds;
    uint32_t layer_count;
    const shot_distortion_plate *plate;
    host_drawn *to;
} redo;

/* The colors of a pixel: its layers, and what is behind them. */
static void redo_colors(const redo *r, size_t pixel, const footprint *f)
{
    const float *pictures[HOST_MAX_LAYERS + 2];
    float *to[HOST_MAX_LAYERS + 2];
    double sums[HOST_MAX_LAYERS + 2][4];
    uint32_t count = 0;
    const bool changed = !r->plate->color || r->plate->undone;
    for (uint32_t i = 0; i < r->layer_count; i++)
        if (r->kinds[i] == SHOT_DISTORT_COLOR) {
            pictures[count] = r->pinhole->layers[i];
            to[count++] = r->to->layers[i] + 4 * pixel;
        }
    const uint32_t layers = count;
    if (changed)
        pictures[count++] = r->pinhole->color;
    if (r->plate->undone)
        pictures[count++] = r->plate->undone;
    gather(f, pictures, count, r->d->map.pinhole_size, sums);
    for (uint32_t k = 0; k < layers; k++)
        for (size_t c = 0; c < 4; c++)
            to[k][c] = (float)sums[k][c];
    for (size_t c = 0; c < 4; c++) {
        const double below = r->plate->color ? (double)r->plate->color[4 * pixel + c] : 0;
        const double undone = r->plate->undone ? sums[layers + 1][c] : 0;
        r->to->color[4 * pixel + c] = (float)(changed ? below + sums[layers][c] - undone : below);
    }
}

/* What has no mean is that of the nearest pixel. */
static void redo_data(const redo *r, size_t pixel, const double at[2])
{
    const distortion_map *map = &r->d->map;
    const host_drawn *from = r->pinhole;
    const size_t near = clamped((int)floor(at[1]), map->pinhole_size[1]) * map->pinhole_size[0] +
                        clamped((int)floor(at[0]), map->pinhole_size[0]);
    memcpy(r->to->normal + 4 * pixel, from->normal + 4 * near, 4 * sizeof(float));
    memcpy(r->to->velocity + 2 * pixel, from->velocity + 2 * near, 2 * sizeof(float));
    memcpy(r->to->water + 2 * pixel, from->water + 2 * near, 2 * sizeof(float));
    r->to->depth[pixel] = r->plate->depth ? r->plate->depth[pixel] : from->depth[near];
    r->to->id[pixel] = from->id[near];
    distort_offset(map, at, SHOT_DISTORT_MOTION, r->to->velocity + 2 * pixel);
    for (uint32_t i = 0; i < r->layer_count; i++) {
        if (r->kinds[i] == SHOT_DISTORT_COLOR)
            continue;
        float *values = r->to->layers[i] + 4 * pixel;
        memcpy(values, from->layers[i] + 4 * near, 4 * sizeof(float));
        if (r->kinds[i] != SHOT_DISTORT_DATA)
            distort_offset(map, at, r->kinds[i], values);
    }
}

void shot_distortion_redo(const shot_distortion *d, const host_drawn *pinhole,
                          const shot_distortion_kind kinds[HOST_MAX_LAYERS], uint32_t layer_count,
                          const shot_distortion_plate *plate, host_drawn *to)
{
    const redo r = {d, pinhole, kinds, layer_count, plate, to};
    for (size_t i = 0; i < (size_t)to->width * to->height; i++) {
        const double at[2] = {(double)d->pinhole_at[2 * i], (double)d->pinhole_at[2 * i + 1]};
        double seen[2], jacobian[2][2];
        distortion_map_apply(&d->map, at, seen, jacobian);
        const footprint f = footprint_of(at, jacobian);
        redo_colors(&r, i, &f);
        redo_data(&r, i, at);
    }
}
