/* surroundings.c - six small pictures around a place, and their harmonics. */
#include "surroundings.h"

#include <math.h>
#include <string.h>

#include "panorama.h"
#include "renderer_internal.h"

/* Pixels along a side of 90 degrees: 2.8 degrees each. Harmonics of degree 2 see nothing finer. */
#define SIDE   32
#define UP     3 /* direction */
#define NEAR_M 0.05
#define FAR_M  2000.0

bool host_surroundings_create(host_device *device, host_surroundings *s, char *error, size_t error_size)
{
    return host_target_create(device, SIDE, SIDE, &s->target, error, error_size);
}

void host_surroundings_destroy(host_device *device, host_surroundings *s)
{
    if (s->target.width)
        host_target_destroy(device, &s->target);
    memset(s, 0, sizeof *s);
}

void host_surroundings_look(const double position_m[3], uint32_t direction, host_camera *camera)
{
    const uint32_t axis = direction / 2, up = axis == 1 ? 2 : 1;
    float back[3] = {0}, above[3] = {0};
    back[axis] = direction % 2 ? -1.0f : 1.0f;
    above[up] = 1.0f;
    memset(camera, 0, sizeof *camera);
    memcpy(camera->position_m, position_m, sizeof camera->position_m);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        float *column = &camera->view_from_world[4 * i];
        column[0] = above[j] * back[k] - above[k] * back[j]; /* right */
        column[1] = above[i];
        column[2] = back[i];
    }
    for (int row = 0; row < 3; row++)
        for (int i = 0; i < 3; i++)
            camera->view_from_world[12 + row] -= camera->view_from_world[4 * i + row] * (float)position_m[i];
    camera->view_from_world[15] = 1.0f;
    float *p = camera->clip_from_view;
    p[0] = 1.0f;
    p[5] = -1.0f;
    p[10] = (float)(FAR_M / (NEAR_M - FAR_M));
    p[11] = -1.0f;
    p[14] = (float)(NEAR_M * FAR_M / (NEAR_M - FAR_M));
    memcpy(camera->clip_from_view_plain, p, sizeof camera->clip_from_view);
    camera->near_m = NEAR_M;
    camera->far_m = FAR_M;
    camera->width = camera->height = SIDE;
    camera->samples = 1;
}

/* Solid angle of the part of a plane 1 away that lies between its middle and (x, y). */
static double corner_angle(double x, double y)
{
    return atan2(x * y, sqrt(x * x + y * y + 1));
}

/* Middle of a pixel, as the sky's shader has it, and its solid angle. */
static void place_pixel(const host_camera *camera, uint32_t column, uint32_t row, float d[3], double *angle)
{
    const double pixel = 2.0 / SIDE, x = (column + 0.5) * pixel - 1, y = (row + 0.5) * pixel - 1, h = 0.5 * pixel;
    const double length = sqrt(x * x + y * y + 1);
    const float *view = camera->view_from_world;
    for (int i = 0; i < 3; i++)
        d[i] = (float)(((double)view[4 * i] * x - (double)view[4 * i + 1] * y - (double)view[4 * i + 2]) / length);
    *angle = corner_angle(x + h, y + h) - corner_angle(x - h, y + h) - corner_angle(x + h, y - h) +
             corner_angle(x - h, y - h);
}

/* One picture, of the scene or of the environment alone. */
static bool draw(host_surroundings *s, host_renderer *r, const host_camera *camera, bool scene, char *error,
                 size_t error_size)
{
    VkCommandBuffer cmd;
    if (!host_begin_frame(r->device, &cmd, error, error_size))
        return false;
    const bool drawn = host_renderer_draw_still(r, cmd, &s->target, camera, scene, error, error_size);
    host_target_copy_out(&s->target, cmd, 1u << HOST_COLOR | 1u << HOST_DEPTH);
    return host_submit(r->device, error, error_size) && host_wait(r->device, error, error_size) && drawn;
}

/* What hides the environment takes its place: the difference of both, over the pixels where something stands. */
static bool add_direction(host_surroundings *s, host_renderer *r, const host_camera *camera, double sum[9][3],
                          char *error, size_t error_size)
{
    float sky[SIDE * SIDE * 4];
    const float limit = r->environment->brightest;
    if (!draw(s, r, camera, false, error, error_size))
        return false;
    memcpy(sky, host_target_floats(r->device, &s->target, HOST_COLOR), sizeof sky);
    if (!draw(s, r, camera, true, error, error_size))
        return false;
    const float *color = host_target_floats(r->device, &s->target, HOST_COLOR);
    const float *depth = host_target_floats(r->device, &s->target, HOST_DEPTH);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        float d[3], basis[9];
        double angle;
        if (depth[i] >= 1.0f)
            continue;
        place_pixel(camera, i % SIDE, i / SIDE, d, &angle);
        panorama_basis(d, basis);
        for (int k = 0; k < 9; k++)
            for (int c = 0; c < 3; c++)
                sum[k][c] +=
                    angle * (double)basis[k] * ((double)color[4 * i + c] - (double)fminf(sky[4 * i + c], limit));
    }
    return true;
}

double host_surroundings_above(const host_surroundings *s)
{
    return s->above_m;
}

bool host_surroundings_light(host_surroundings *s, host_renderer *r, const double position_m[3], float sh[9][3],
                             char *error, size_t error_size)
{
    double sum[9][3];
    for (int k = 0; k < 9; k++)
        for (int c = 0; c < 3; c++)
            sum[k][c] = (double)r->environment->sh[k][c];
    for (uint32_t direction = 0; direction < 6; direction++) {
        host_camera camera;
        host_surroundings_look(position_m, direction, &camera);
        if (!add_direction(s, r, &camera, sum, error, error_size))
            return false;
        if (direction == UP)
            s->above_m = host_camera_distance(
                &camera, host_target_floats(r->device, &s->target, HOST_DEPTH)[SIDE * SIDE / 2 + SIDE / 2]);
    }
    for (int k = 0; k < 9; k++)
        for (int c = 0; c < 3; c++)
            sh[k][c] = (float)sum[k][c];
    return true;
}
