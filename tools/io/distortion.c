/* distortion.c - Brown and Conrady's lens, forwards and back, and how large a pinhole's picture must be. */
#include "distortion.h"

#include "file.h"
#include "picture.h"

#include <math.h>

bool distortion_is_given(const distortion *lens)
{
    return lens->k1 != 0 || lens->k2 != 0 || lens->p1 != 0 || lens->p2 != 0 || lens->k3 != 0;
}

void distortion_apply(const distortion *lens, const double xy[2], double seen[2], double jacobian[2][2])
{
    const double x = xy[0], y = xy[1], r2 = x * x + y * y, p1 = lens->p1, p2 = lens->p2;
    const double radial = 1 + r2 * (lens->k1 + r2 * (lens->k2 + r2 * lens->k3));
    const double by_r2 = lens->k1 + r2 * (2 * lens->k2 + r2 * 3 * lens->k3); /* d radial / d r2 */
    seen[0] = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
    seen[1] = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
    if (!jacobian)
        return;
    jacobian[0][0] = radial + 2 * x * x * by_r2 + 2 * p1 * y + 6 * p2 * x;
    jacobian[0][1] = 2 * x * y * by_r2 + 2 * p1 * x + 2 * p2 * y;
    jacobian[1][0] = jacobian[0][1];
    jacobian[1][1] = radial + 2 * y * y * by_r2 + 6 * p1 * y + 2 * p2 * x;
}

/* ---- back */

static double determinant(const double m[2][2])
{
    return m[0][0] * m[1][1] - m[0][1] * m[1][0];
}

/* Without the tangential part: r (1 + k1 r2 + k2 r4 + k3 r6), and how fast it rises. */
static double radius_seen(const distortion *lens, double r, double *rise)
{
    const double r2 = r * r;
    *rise = 1 + r2 * (3 * lens->k1 + r2 * (5 * lens->k2 + r2 * 7 * lens->k3));
    return r * (1 + r2 * (lens->k1 + r2 * (lens->k2 + r2 * lens->k3)));
}

/* The first radius that is seen at `seen`, by steps from the axis on and then by halves. */
static bool undo_radius(const distortion *lens, double seen, double *radius)
{
    double low = 0, high = 0, rise;
    const double step = seen / 16;
    while (radius_seen(lens, high, &rise) < seen) {
        if (rise <= 0 || high > 64 * seen)
            return false;
        low = high;
        high += step;
    }
    for (int i = 0; i < 40; i++) {
        const double middle = 0.5 * (low + high);
        *(radius_seen(lens, middle, &rise) < seen ? &low : &high) = middle;
    }
    *radius = 0.5 * (low + high);
    return true;
}

/* Whether the way from the axis to a direction has no fold. */
static bool is_before_fold(const distortion *lens, const double xy[2])
{
    enum { STEPS = 16 };
    for (int i = 1; i <= STEPS; i++) {
        const double at[2] = {xy[0] * i / STEPS, xy[1] * i / STEPS};
        double seen[2], jacobian[2][2];
        distortion_apply(lens, at, seen, jacobian);
        if (!(determinant(jacobian) > 0) || !(jacobian[0][0] > 0))
            return false;
    }
    return true;
}

/* The radial part first, as a start for Newton's method, which adds the small tangential part. */
bool distortion_undo(const distortion *lens, const double seen[2], double xy[2])
{
    const double length = hypot(seen[0], seen[1]);
    double radius = 0, off = INFINITY;
    if (length > 0 && !undo_radius(lens, length, &radius))
        return false;
    for (int axis = 0; axis < 2; axis++)
        xy[axis] = length > 0 ? seen[axis] * radius / length : 0;
    for (int i = 0; i < 30 && off > 1e-14; i++) {
        double now[2], m[2][2];
        distortion_apply(lens, xy, now, m);
        const double det = determinant(m), wrong[2] = {seen[0] - now[0], seen[1] - now[1]};
        if (!(det > 0))
            return false;
        xy[0] += (m[1][1] * wrong[0] - m[0][1] * wrong[1]) / det;
        xy[1] += (m[0][0] * wrong[1] - m[1][0] * wrong[0]) / det;
        off = hypot(wrong[0], wrong[1]);
    }
    return off < 1e-9 && is_before_fold(lens, xy);
}

/* ---- pictures */

enum { BORDER = 128 }; /* points on each side of the picture */

/* A point of the picture's border. */
static void border_point(const distortion_map *map, int i, double at[2])
{
    const double share = (double)(i % BORDER) / BORDER;
    const double x[] = {share, 1, 1 - share, 0}, y[] = {0, share, 1, 1 - share};
    at[0] = x[i / BORDER] * map->size[0];
    at[1] = y[i / BORDER] * map->size[1];
}

/* How much the lens enlarges at most, on the ways from the axis to the border. */
static double largest_scale(const distortion *lens, const double edge[2])
{
    enum { STEPS = 8 };
    double largest = 1;
    for (int i = 1; i <= STEPS; i++) {
        const double at[2] = {edge[0] * i / STEPS, edge[1] * i / STEPS};
        double seen[2], m[2][2];
        distortion_apply(lens, at, seen, m);
        const double mean = 0.5 * (m[0][0] + m[1][1]), half = 0.5 * (m[0][0] - m[1][1]);
        largest = fmax(largest, mean + hypot(half, m[0][1])); /* its larger eigenvalue: it is symmetric */
    }
    return largest;
}

bool distortion_map_open(distortion_map *map, char *error, size_t error_size)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, scale = 1;
    map->reach = 0;
    for (int i = 0; i < 4 * BORDER; i++) {
        double at[2], seen[2], xy[2];
        border_point(map, i, at);
        for (int axis = 0; axis < 2; axis++)
            seen[axis] = (at[axis] - map->center_px[axis]) / map->focal_px[axis];
        if (!distortion_undo(&map->lens, seen, xy))
            return file_fail(error, error_size,
                             "expected a lens that can be undone over the whole picture; this one folds before [%.0f, "
                             "%.0f] of %u x %u pixels",
                             at[0], at[1], map->size[0], map->size[1]);
        for (int axis = 0; axis < 2; axis++) {
            low[axis] = fmin(low[axis], xy[axis]);
            high[axis] = fmax(high[axis], xy[axis]);
        }
        map->reach = fmax(map->reach, hypot(xy[0], xy[1]));
        scale = fmax(scale, largest_scale(&map->lens, xy));
    }
    for (int axis = 0; axis < 2; axis++) {
        const double focal_px = map->focal_px[axis] * fmin(scale, 2);
        const double pixels = ceil((high[axis] - low[axis]) * focal_px) + 2 * DISTORTION_MARGIN_PX;
        if (!(pixels <= PICTURE_MAX_SIDE))
            return file_fail(error, error_size,
                             "expected a picture of at most %d pixels on a side without distortion, got %.0f",
                             PICTURE_MAX_SIDE, pixels);
        map->pinhole_size[axis] = (uint32_t)pixels;
        map->pinhole_focal_px[axis] = focal_px;
        map->pinhole_center_px[axis] = DISTORTION_MARGIN_PX - low[axis] * focal_px;
    }
    return true;
}

void distortion_map_apply(const distortion_map *map, const double pinhole[2], double seen[2], double jacobian[2][2])
{
    double xy[2];
    for (int axis = 0; axis < 2; axis++)
        xy[axis] = (pinhole[axis] - map->pinhole_center_px[axis]) / map->pinhole_focal_px[axis];
    const double r = hypot(xy[0], xy[1]), pull = r > map->reach ? map->reach / r : 1;
    for (int axis = 0; axis < 2; axis++)
        xy[axis] *= pull;
    distortion_apply(&map->lens, xy, seen, jacobian);
    for (int row = 0; row < 2; row++) {
        seen[row] = seen[row] * map->focal_px[row] + map->center_px[row];
        for (int column = 0; jacobian && column < 2; column++)
            jacobian[row][column] *= map->focal_px[row] / map->pinhole_focal_px[column];
    }
}

bool distortion_map_undo(const distortion_map *map, const double seen[2], double pinhole[2])
{
    double xy[2];
    const double at[2] = {(seen[0] - map->center_px[0]) / map->focal_px[0],
                          (seen[1] - map->center_px[1]) / map->focal_px[1]};
    if (!distortion_undo(&map->lens, at, xy))
        return false;
    for (int axis = 0; axis < 2; axis++)
        pinhole[axis] = xy[axis] * map->pinhole_focal_px[axis] + map->pinhole_center_px[axis];
    return true;
}
