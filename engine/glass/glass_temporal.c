/* glass/glass_temporal.c - computes the motion of a pane since the previous frame, for motion vectors. */
#include "glass/glass_internal.h"

#include "gpu/view.h"

#include <string.h>

/* out = a b, for 3 x 3 rotation matrices in column-major order. */
static void turn(const double a[9], const double b[9], double out[9])
{
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++) {
            out[3 * column + row] = 0;
            for (int i = 0; i < 3; i++)
                out[3 * column + row] += a[3 * i + row] * b[3 * column + i];
        }
}

/* Whether the host gave the previous pose. Otherwise the current pose is used. */
static bool has_before(const virga_glass_pose *pose)
{
    for (int i = 0; i < 9; i++)
        if (pose->previous_world_from_pane[i] != 0)
            return true;
    return false;
}

/* A point that does not move on the pane is now at x, relative to the camera. In the previous frame it was at Q x + t,
 * relative to that frame's camera. Q (rotation) maps the pane's current axes to its previous axes. t (shift) follows
 * from the current and the previous position of the pane's origin. */
static void motion_of_pane(const virga_view *view, const virga_glass_pose *pose, const float world_from_pane[9],
                           const double camera[3], double rotation[9], double shift[3])
{
    double before[9], inverse[9];
    const bool given = has_before(pose);
    const double *origin = given ? pose->previous_position_m : pose->position_m;
    for (int i = 0; i < 9; i++) {
        before[i] = (double)(given ? pose->previous_world_from_pane[i] : world_from_pane[i]);
        inverse[i] = (double)world_from_pane[i % 3 * 3 + i / 3];
    }
    turn(before, inverse, rotation);
    for (int row = 0; row < 3; row++) {
        shift[row] = origin[row] - camera[row];
        for (int i = 0; i < 3; i++)
            shift[row] -= rotation[3 * i + row] * (pose->position_m[i] - view->position_m[i]);
    }
}

void glass_fill_before(const virga_view *view, const virga_glass_pose *pose, virga_glass_picture_gpu *look)
{
    double camera[3], rotation[9], shift[3];
    float clip[16];
    virga_view_previous(view, camera, clip);
    motion_of_pane(view, pose, look->world_from_pane, camera, rotation, shift);
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++) {
            const double *way = column < 3 ? rotation + (size_t)3 * (size_t)column : shift;
            double sum = column < 3 ? 0 : (double)clip[12 + row];
            for (int i = 0; i < 3; i++)
                sum += (double)clip[4 * i + row] * way[i];
            look->previous_from_here[4 * column + row] = (float)sum;
        }
    /* The previous eye position: the x for which Q x + t is 0. */
    for (int column = 0; column < 3; column++) {
        double sum = 0;
        for (int i = 0; i < 3; i++)
            sum -= rotation[3 * column + i] * shift[i];
        look->previous_eye[column] = (float)sum;
    }
}
