/* plate_light.c - looks up a picture in all directions. */
#include "shot/plate_light.h"

#include <math.h>

enum { SIDE = 4 }; /* of the grid of directions whose mean is a pixel of the panorama */

#define FADE (20 * M_PI / 180)

typedef struct light {
    const float *rgba;
    const host_camera *camera;
    double low[2];     /* of the picture, as angles from the camera's axis: its left and lower side, */
    double high[2];    /* its right and upper side */
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

/* Back and forth between two angles. */
static double fold(double angle, double low, double high)
{
    const double wide = high - low, turn = fabs(fmod(angle - low, 2 * wide));
    return low + (turn > wide ? 2 * wide - turn : turn);
}

static size_t index_of(double share, uint32_t count)
{
    const double at = floor(share * count);
    return at < 0 ? 0 : at >= count ? count - 1 : (size_t)at;
}

/* Light from a direction of unit length in the camera's space: right, up, back. */
static void look_up(const light *l, const double v[3], double rgb[3])
{
    const double up = asin(fmax(-1, fmin(v[1], 1))), beyond = fmax(up - l->high[1], l->low[1] - up);
    const double angle[2] = {fold(atan2(v[0], -v[2]), l->low[0], l->high[0]), fmax(l->low[1], fmin(up, l->high[1]))};
    const double away = fmax(0, fmin(beyond / FADE, 1)), fade = away * away * (3 - 2 * away);
    const float *clip = l->camera->clip_from_view_plain;
    const double across = 0.5 + 0.5 * ((double)clip[0] * tan(angle[0]) - (double)clip[8]);
    const double down = 0.5 + 0.5 * ((double)clip[5] * tan(angle[1]) / cos(angle[0]) - (double)clip[9]);
    const float *pixel =
        l->rgba + 4 * (index_of(down, l->camera->height) * l->camera->width + index_of(across, l->camera->width));
    for (size_t c = 0; c < 3; c++)
        rgb[c] = (1 - fade) * fmax((double)pixel[c], 0) + fade * fmax(l->edge[up < l->low[1]][c], 0);
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
    const float *clip = camera->clip_from_view_plain; /* down, so clip[5] is below zero */
    for (int axis = 0; axis < 2; axis++) {
        const double a = atan(((double)clip[8 + axis] - 1) / (double)clip[5 * axis]);
        const double b = atan(((double)clip[8 + axis] + 1) / (double)clip[5 * axis]);
        l.low[axis] = fmin(a, b);
        l.high[axis] = fmax(a, b);
    }
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
