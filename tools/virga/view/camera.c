/* camera.c - the free camera: the mouse rotates it while the right button is down, W A S D Q E move it. */
#include "view/view.h"

#include <math.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#define TURN_PER_PX 0.004
#define MAX_PITCH   1.55
#define FIRST_M_S   3.0

static void direction_of(const view_camera *c, double out[3])
{
    out[0] = -sin(c->yaw) * cos(c->pitch);
    out[1] = sin(c->pitch);
    out[2] = -cos(c->yaw) * cos(c->pitch);
}

/* Starts at the current camera of the path. */
static void set_free(viewer *v)
{
    view_camera *c = &v->camera;
    const float *m = v->seen.view_from_world; /* its third row points back */
    if (c->free)
        return;
    c->free = true;
    c->speed_m_s = c->speed_m_s > 0 ? c->speed_m_s : FIRST_M_S;
    memcpy(c->position_m, v->seen.position_m, sizeof c->position_m);
    c->pitch = asin(fmax(-1, fmin(1, -(double)m[6])));
    c->yaw = atan2((double)m[2], (double)m[10]);
}

void view_camera_to_path(viewer *v)
{
    v->camera.free = false;
    v->shot.eye_free = false;
}

void view_camera_place(viewer *v, const double position_m[3], double yaw_deg, double pitch_deg)
{
    set_free(v);
    memcpy(v->camera.position_m, position_m, sizeof v->camera.position_m);
    v->camera.yaw = yaw_deg * M_PI / 180;
    v->camera.pitch = fmax(-MAX_PITCH, fmin(MAX_PITCH, pitch_deg * M_PI / 180));
    memset(&v->camera.last, 0, sizeof v->camera.last);
}

static void turn(viewer *v, bool allowed)
{
    double x, y;
    view_camera *c = &v->camera;
    const bool down = glfwGetMouseButton(v->window.glfw, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
    glfwGetCursorPos(v->window.glfw, &x, &y);
    if (down && !c->looking && allowed) {
        set_free(v);
        c->looking = true;
    } else if (!down) {
        c->looking = false;
    } else if (c->looking) {
        c->yaw -= (x - c->mouse[0]) * TURN_PER_PX;
        c->pitch = fmax(-MAX_PITCH, fmin(MAX_PITCH, c->pitch - (y - c->mouse[1]) * TURN_PER_PX));
    }
    c->mouse[0] = x;
    c->mouse[1] = y;
}

static double axis_of(const viewer *v, int plus, int minus)
{
    return (glfwGetKey(v->window.glfw, plus) == GLFW_PRESS) - (glfwGetKey(v->window.glfw, minus) == GLFW_PRESS);
}

static void walk(viewer *v, double dt_s)
{
    view_camera *c = &v->camera;
    double ahead[3];
    const double forward = axis_of(v, GLFW_KEY_W, GLFW_KEY_S), side = axis_of(v, GLFW_KEY_D, GLFW_KEY_A),
                 up = axis_of(v, GLFW_KEY_E, GLFW_KEY_Q);
    if (forward == 0 && side == 0 && up == 0)
        return;
    set_free(v);
    const bool fast = glfwGetKey(v->window.glfw, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS;
    const double way = c->speed_m_s * fmin(dt_s, 0.25) * (fast ? 4 : 1);
    direction_of(c, ahead);
    for (int i = 0; i < 3; i++)
        c->position_m[i] += way * forward * ahead[i];
    c->position_m[0] += way * side * cos(c->yaw);
    c->position_m[2] -= way * side * sin(c->yaw);
    c->position_m[1] += way * up;
}

void view_camera_move(viewer *v, double wall_s, double dt_s)
{
    view_camera *c = &v->camera;
    shot *s = &v->shot;
    double ahead[3];
    turn(v, !view_panel_has_mouse());
    if (!view_panel_has_keys())
        walk(v, wall_s);
    s->eye_free = c->free;
    if (!c->free) {
        memset(&c->last, 0, sizeof c->last);
        return;
    }
    host_camera_key now = {.time_s = s->camera_time_s};
    direction_of(c, ahead);
    for (int i = 0; i < 3; i++) {
        now.position_m[i] = c->position_m[i];
        now.look_at_m[i] = c->position_m[i] + ahead[i];
    }
    /* Two keys a frame apart, so that the camera's motion is visible as motion blur. */
    const double frame_s = 1 / s->scene->frames.fps;
    const bool moved = c->last.look_at_m[0] != 0 || c->last.look_at_m[1] != 0 || c->last.look_at_m[2] != 0;
    s->eye_keys[0] = moved ? c->last : now;
    s->eye_keys[1] = now;
    const double time_s = s->camera_time_s + dt_s;
    s->eye_keys[1].time_s = time_s;
    s->eye_keys[0].time_s = time_s - frame_s;
    c->last = now;
}
