/* plate_light.c - looks up a picture in all directions. */
#include "shot/plate_light.h"

#include <math.h>

enum { SIDE = 4 }; /* of the grid of directions whose mean is a pixel of the panorama */

#define FADE (20 * M_PI / 180)

typedef struct light {
    const float *rgba;
    const host_camera *camera;
    double half[2];    /* of the picture, as angles from its middle: to the side, and up */
    double edge[2][3]; /* mean of the upper and of the lower rows */
} light;

static void mean_rows(const light *l, uint32_t first, uint32_t last, double mean[3])
{
    const size_t width = l->camera->width;
    mean[0] = mean[1] = mean[2] = 0;
    for (size_t i = first * width; i < last * width; i++)
        for (size_t c = 0; c < 3; c++)
            mean[c] += (double)l->rgba[i * 4 + c] / (double)((last - first) * width);
}

/* Back and forth between -half and half. */
static double fold(double angle, double half)
{
    const double turn = fabs(fmod(angle + half, 4 * half));
    return (turn > 2 * half ? 4 * half - turn : turn) - half;
}

static size_t index_of(double share, uint32_t count)
{
    const double at = floor((0.5 + 0.5 * share) * count);
    return at < 0 ? 0 : at >= count ? count - 1 : (size_t)at;
}

/* Light from a direction of unit length in the camera's space: right, up, back. */
static void look_up(const light *l, const double v[3], double rgb[3])
{
    const double up = asin(fmax(-1, fmin(v[1], 1))), beyond = fabs(up) - l->half[1];
    const double angle[2] = {fold(atan2(v[0], -v[2]), l->half[0]), fmax(-l->half[1], fmin(up, l->half[1]))};
    const double away = fmax(0, fmin(beyond / FADE, 1)), fade = away * away * (3 - 2 * away);
    const double across = tan(angle[0]) / tan(l->half[0]);
    const double down = -tan(angle[1]) / cos(angle[0]) / tan(l->half[1]);
    const float *pixel =
        l->rgba + 4 * (index_of(down, l->camera->height) * l->camera->width + index_of(across, l->camera->width));
    for (size_t c = 0; c < 3; c++)
        rgb[c] = (1 - fade) * fmax((double)pixel[c], 0) + fade * fmax(l->edge[up < 0][c], 0);
}

/* The direction of a place of the panorama, turned into the camera's space. */
static void direction_of(const light *l, double column, double row, double out[3])
{
    const double around = (column - 0.5) * 2 * M_PI, down = row * M_PI;
    const double world[3] = {sin(down) * sin(around), cos(down), -sin(down) * cos(around)};
    const float *m = l->camera->view_from_world;
    for (int i = 0; i < 3; i++)
        out[i] = (double)m[i] * world[0] + (double)m[4 + i] * world[1] + (double)m[8 + i] * world[2];
}

void plate_light_panorama(const float *rgba, const host_camera *camera, float *rgb, uint32_t width, uint32_t height)
{
    light l = {.rgba = rgba, .camera = camera};
    for (int axis = 0; axis < 2; axis++)
        l.half[axis] = atan(1 / fabs((double)camera->clip_from_view_plain[5 * axis]));
    const uint32_t tenth = camera->height / 10 ? camera->height / 10 : 1;
    mean_rows(&l, 0, tenth, l.edge[0]);
    mean_rows(&l, camera->height - tenth, camera->height, l.edge[1]);
    for (uint32_t i = 0; i < width * height; i++) {
        double sum[3] = {0}, v[3], one[3];
        for (int k = 0; k < SIDE * SIDE; k++) {
            direction_of(&l, (i % width + (k % SIDE + 0.5) / SIDE) / width,
                         (i / width + (k / SIDE + 0.5) / SIDE) / height, v);
            look_up(&l, v, one);
            for (int c = 0; c < 3; c++)
                sum[c] += one[c] / (SIDE * SIDE);
        }
        for (int c = 0; c < 3; c++)
            rgb[i * 3 + (uint32_t)c] = (float)sum[c];
    }
}
