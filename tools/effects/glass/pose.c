/* pose.c - where panes are and how they move: with the camera, or as the scene gives it. */
#include "panes.h"

#include <math.h>
#include <string.h>

typedef struct frame3 {
    double origin[3], axes[3][3]; /* axes[i] is the i-th in the world */
} frame3;

/* What a pane's position and angles are given in. A pane that follows the camera faces ahead, so its X points to the
 * left. */
static frame3 frame_of(const shot *s, const scene_pane *pane, double time_s)
{
    frame3 f = {.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (pane->follow != SCENE_PANE_CAMERA)
        return f;
    host_camera camera;
    host_camera_at(&s->path, time_s, s->options.width, s->options.height, NULL, &camera);
    for (int axis = 0; axis < 3; axis++) {
        f.origin[axis] = camera.position_m[axis];
        f.axes[0][axis] = -(double)camera.view_from_world[4 * axis];
        f.axes[1][axis] = (double)camera.view_from_world[4 * axis + 1];
        f.axes[2][axis] = -(double)camera.view_from_world[4 * axis + 2];
    }
    return f;
}

/* An offset or a direction as the scene gives it, to the right where the pane follows the camera. */
static void to_world(const frame3 *f, const scene_pane *pane, const double given[3], double out[3])
{
    const double side = pane->follow == SCENE_PANE_CAMERA ? -1 : 1;
    for (int axis = 0; axis < 3; axis++)
        out[axis] = side * given[0] * f->axes[0][axis] + given[1] * f->axes[1][axis] + given[2] * f->axes[2][axis];
}

/* Rotates two axes in their plane, `a` towards `b`. */
static void turn_axes(double a[3], double b[3], double angle_deg)
{
    const double c = cos(angle_deg * M_PI / 180), sn = sin(angle_deg * M_PI / 180);
    for (int i = 0; i < 3; i++) {
        const double x = a[i], y = b[i];
        a[i] = c * x + sn * y;
        b[i] = c * y - sn * x;
    }
}

/* Applies yaw, then pitch about the new right axis, then roll. */
static frame3 pose_of(const shot *s, const scene_pane *pane, double time_s)
{
    frame3 f = frame_of(s, pane, time_s);
    double offset[3];
    to_world(&f, pane, pane->position_m, offset);
    for (int axis = 0; axis < 3; axis++)
        f.origin[axis] += offset[axis];
    turn_axes(f.axes[2], f.axes[0], pane->yaw_deg);
    turn_axes(f.axes[2], f.axes[1], pane->pitch_deg);
    turn_axes(f.axes[0], f.axes[1], pane->roll_deg);
    return f;
}

void glass_pose(const shot *s, const scene_pane *pane, double time_s, virga_glass_pose *pose)
{
    const frame3 f = pose_of(s, pane, time_s);
    memset(pose, 0, sizeof *pose);
    memcpy(pose->position_m, f.origin, sizeof pose->position_m);
    for (int i = 0; i < 9; i++)
        pose->world_from_pane[i] = (float)f.axes[i / 3][i % 3];
}

/* The part of the camera's path around a time that one shot moves along; false where it stands. */
static bool moving_span(const shot *s, double time_s, double half_s, double span[2])
{
    const double shot_start = host_camera_shot_start(&s->path, time_s);
    uint32_t first = 0, last = 0;
    while (first + 1 < s->path.count && s->path.keys[first].time_s < shot_start)
        first++;
    for (last = first; last + 1 < s->path.count && !s->path.keys[last + 1].cut;)
        last++;
    span[0] = fmax(time_s - half_s, s->path.keys[first].time_s);
    span[1] = fmin(time_s + half_s, s->path.keys[last].time_s);
    return span[1] - span[0] > 0.5 * half_s;
}

static void velocity_at(const shot *s, const scene_pane *pane, double time_s, double velocity[3], double turn[3])
{
    double span[2];
    memset(velocity, 0, 3 * sizeof *velocity);
    memset(turn, 0, 3 * sizeof *turn);
    if (!moving_span(s, time_s, 0.25 / s->scene->frames.fps, span))
        return;
    const frame3 a = pose_of(s, pane, span[0]), b = pose_of(s, pane, span[1]);
    const double time = span[1] - span[0];
    for (int axis = 0; axis < 3; axis++) {
        const int y = (axis + 1) % 3, z = (axis + 2) % 3;
        velocity[axis] = (b.origin[axis] - a.origin[axis]) / time;
        /* The angular velocity w moves each axis e by de/dt = w x e. So w is half the sum of e x de/dt. */
        for (int e = 0; e < 3; e++)
            turn[axis] += 0.5 * (a.axes[e][y] * b.axes[e][z] - a.axes[e][z] * b.axes[e][y]) / time;
    }
}

/* Computes the motion by differences along the camera's path. At the end of the path the pane stops without a
 * deceleration. A film holds its last image there, and a deceleration would only throw drops forward. */
static void move_along_path(const shot *s, const scene_pane *pane, double time_s, virga_scene_pane *out)
{
    double velocity[3], turn[3], before[3], after[3], ignored[3], span[2];
    if (pane->follow != SCENE_PANE_CAMERA)
        return;
    /* Before the path begins (pre-roll) the pane has the constant velocity of the path's start. */
    const bool ahead = time_s < s->path.keys[0].time_s;
    velocity_at(s, pane, ahead ? s->path.keys[0].time_s : time_s, velocity, turn);
    const bool moves = !ahead && moving_span(s, time_s, 1 / s->scene->frames.fps, span);
    velocity_at(s, pane, span[0], before, ignored);
    velocity_at(s, pane, span[1], after, ignored);
    for (int axis = 0; axis < 3; axis++) {
        out->velocity_m_s[axis] = (float)velocity[axis];
        out->angular_velocity_rad_s[axis] = ahead ? 0 : (float)turn[axis];
        out->acceleration_m_s2[axis] = moves ? (float)((after[axis] - before[axis]) / (span[1] - span[0])) : 0;
    }
}

static void move_as_given(const shot *s, const scene_pane *pane, double time_s, virga_scene_pane *out)
{
    const frame3 f = frame_of(s, pane, time_s);
    double velocity[3], acceleration[3], turn[3];
    to_world(&f, pane, pane->velocity_m_s, velocity);
    to_world(&f, pane, pane->acceleration_m_s2, acceleration);
    to_world(&f, pane, pane->angular_velocity_deg_s, turn);
    for (int axis = 0; axis < 3; axis++) {
        out->velocity_m_s[axis] = (float)velocity[axis];
        out->acceleration_m_s2[axis] = (float)acceleration[axis];
        out->angular_velocity_rad_s[axis] = (float)(turn[axis] * M_PI / 180);
    }
}

void glass_place(const shot *s, const scene_pane *pane, double time_s, virga_scene_pane *out)
{
    memset(out, 0, sizeof *out);
    glass_pose(s, pane, time_s, &out->pose);
    if (pane->motion == SCENE_PANE_MOTION_GIVEN)
        move_as_given(s, pane, time_s, out);
    else
        move_along_path(s, pane, time_s, out);
    out->shelter = (float)pane->shelter;
}

void glass_pose_moving(const shot *s, const scene_pane *pane, double camera_s, virga_glass_pose *pose)
{
    virga_glass_pose before;
    const host_camera_path eye = shot_eye(s);
    const double shot_start = host_camera_shot_start(&eye, camera_s);
    glass_pose(s, pane, camera_s, pose);
    glass_pose(s, pane, fmax(camera_s - 1 / s->scene->frames.fps, shot_start), &before);
    memcpy(pose->previous_position_m, before.position_m, sizeof before.position_m);
    memcpy(pose->previous_world_from_pane, before.world_from_pane, sizeof before.world_from_pane);
}
