/* gpu/world.c - converts a host's units, axes and projections to those of views. */
#include "core/settings.h"

#include <virga/world.h>

#include <math.h>
#include <string.h>

virga_world virga_default_world(void)
{
    return (virga_world){.size = sizeof(virga_world),
                         .cookie = virga_settings_cookie("world"),
                         .metres_per_unit = 1,
                         .up = VIRGA_AXIS_Y};
}

static bool is_sound(const virga_world *world)
{
    return world && !virga_settings_check(NULL, "world", world->size, sizeof *world, world->cookie) &&
           world->metres_per_unit > 0 && world->metres_per_unit <= 1e6 && (uint32_t)world->up <= VIRGA_AXIS_Z &&
           (uint32_t)world->clip <= VIRGA_CLIP_GL;
}

/* The rows of a rotation that turns the host's up axis to Y, about one of the other axes. Left-handed axes are mirrored
 * as well. */
static void fill_axes(const virga_world *world, double axes[3][3])
{
    static const double rotations[3][3][3] = {
        {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}, /* X up */
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
        {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, /* Z up */
    };
    memcpy(axes, rotations[world->up], 9 * sizeof(double));
    for (int i = 0; world->left_handed && i < 3; i++)
        axes[2][i] = -axes[2][i];
}

virga_result virga_world_position(const virga_world *world, const double position[3], double position_m[3])
{
    double axes[3][3], out[3];
    if (!is_sound(world) || !position || !position_m)
        return VIRGA_ERROR_INVALID;
    fill_axes(world, axes);
    for (int i = 0; i < 3; i++)
        out[i] =
            world->metres_per_unit * (axes[i][0] * position[0] + axes[i][1] * position[1] + axes[i][2] * position[2]);
    memcpy(position_m, out, sizeof out);
    return VIRGA_OK;
}

virga_result virga_world_direction(const virga_world *world, const float direction[3], float out[3])
{
    double axes[3][3];
    if (!is_sound(world) || !direction || !out)
        return VIRGA_ERROR_INVALID;
    fill_axes(world, axes);
    const double d[3] = {(double)direction[0], (double)direction[1], (double)direction[2]};
    for (int i = 0; i < 3; i++)
        out[i] = (float)(axes[i][0] * d[0] + axes[i][1] * d[1] + axes[i][2] * d[2]);
    return VIRGA_OK;
}

virga_result virga_world_mesh(const virga_world *world, const float world_from_mesh[12], float out[12])
{
    double axes[3][3];
    float made[12];
    if (!is_sound(world) || !world_from_mesh || !out)
        return VIRGA_ERROR_INVALID;
    fill_axes(world, axes);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            double sum = 0;
            for (int i = 0; i < 3; i++)
                sum += axes[row][i] * (double)world_from_mesh[4 * i + column];
            made[4 * row + column] = (float)(world->metres_per_unit * sum);
        }
    memcpy(out, made, sizeof made);
    return VIRGA_OK;
}

/* ---- cameras */

static double determinant(double m[3][3])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* Where the host's view space is: position = -transposed rotation x translation. */
static void find_position(const float view_from_world[16], double position[3])
{
    for (int i = 0; i < 3; i++) {
        position[i] = 0;
        for (int row = 0; row < 3; row++)
            position[i] -= (double)view_from_world[4 * i + row] * (double)view_from_world[12 + row];
    }
}

/* Virga's view space is the host's, in metres, with each axis as it is or turned round: `turn`. z is turned so that the
 * camera looks along -z, x so that the whole is a rotation and no mirror. So with positions v of the host's view space,
 * and V of Virga's, V = turn v metres_per_unit; and with rotations R of the host and r, and axes A: r = turn R A^T. */
static void fill_rotation(const virga_world *world, const float view_from_world[16], double turn[3], float out[16])
{
    double axes[3][3], rotation[3][3];
    fill_axes(world, axes);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            rotation[row][column] = 0;
            for (int i = 0; i < 3; i++)
                rotation[row][column] += (double)view_from_world[4 * i + row] * axes[column][i];
        }
    turn[0] = determinant(rotation) * turn[2] < 0 ? -1 : 1;
    turn[1] = 1;
    memset(out, 0, 16 * sizeof *out);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            out[4 * column + row] = (float)(turn[row] * rotation[row][column]);
    out[15] = 1;
}

/* clip = P v with v = turn V / metres_per_unit. All of it may be multiplied by a number: w becomes -z. */
static void fill_projection(const virga_world *world, const float p[16], const double turn[3], float out[16])
{
    const double all = 1 / fabs((double)p[11]);
    for (int column = 0; column < 4; column++) {
        const double scale = all * (column < 3 ? turn[column] : world->metres_per_unit);
        double x = (double)p[4 * column], y = (double)p[4 * column + 1], z = (double)p[4 * column + 2],
               w = (double)p[4 * column + 3];
        y = world->clip == VIRGA_CLIP_VULKAN ? y : -y;
        z = world->clip == VIRGA_CLIP_GL ? 0.5 * (z + w) : z;
        const double clip[4] = {x, y, z, w};
        for (int row = 0; row < 4; row++)
            out[4 * column + row] = (float)(scale * clip[row]);
    }
}

/* Writes a camera of Virga's into these members of a view. A camera that is refused changes nothing. */
static virga_result convert(const virga_world *world, const float view_from_world[16], const float clip_from_view[16],
                            const double *position, double out_position_m[3], float out_view_from_world[16],
                            float out_clip_from_view[16])
{
    if (!is_sound(world) || !view_from_world || !clip_from_view || !(fabsf(clip_from_view[11]) > 0))
        return VIRGA_ERROR_INVALID;
    double turn[3] = {1, 1, clip_from_view[11] > 0 ? -1 : 1}, found[3];
    find_position(view_from_world, found);
    const virga_result result = virga_world_position(world, position ? position : found, out_position_m);
    if (result)
        return result;
    fill_rotation(world, view_from_world, turn, out_view_from_world);
    fill_projection(world, clip_from_view, turn, out_clip_from_view);
    return VIRGA_OK;
}

virga_result virga_world_camera(const virga_world *world, const float view_from_world[16],
                                const float clip_from_view[16], const double *position, virga_view *view)
{
    if (!view || convert(world, view_from_world, clip_from_view, position, view->position_m, view->view_from_world,
                         view->clip_from_view))
        return VIRGA_ERROR_INVALID;
    /* depth = -p10 + p14 / distance: it falls with the distance where p14 > 0. */
    view->reversed_depth = view->clip_from_view[14] > 0;
    return virga_world_open_camera(world, view_from_world, clip_from_view, position, view);
}

virga_result virga_world_open_camera(const virga_world *world, const float view_from_world[16],
                                     const float clip_from_view[16], const double *position, virga_view *view)
{
    return view && !convert(world, view_from_world, clip_from_view, position, view->open_position_m,
                            view->open_view_from_world, view->open_clip_from_view)
               ? VIRGA_OK
               : VIRGA_ERROR_INVALID;
}
