/* focus.c - the focus of the window: the left mouse button picks what is sharp, and the focus goes there. */
#include "view/view.h"

#include "shot/focus.h"

#include <math.h>
#include <stdio.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#define EASE_S   0.2  /* after this time the focus has done 63 % of its way */
#define COVERAGE 0.25 /* water that covers less of a pixel is not what the user means */

bool view_focus_at(viewer *v, double x, double y)
{
    const shot *s = &v->shot;
    if (s->scene->camera.aperture_f <= 0) {
        view_print(v, "everything is sharp; set camera.aperture_f for a focus");
        return false;
    }
    v->pick_at[0] = (uint32_t)fmin(fmax(x, 0) * s->target.width, s->target.width - 1);
    v->pick_at[1] = (uint32_t)fmin(fmax(y, 0) * s->target.height, s->target.height - 1);
    v->picking = true;
    return true;
}

/* The button was pressed on the picture. */
static void click(viewer *v, const float area[4])
{
    double x, y;
    const bool down = glfwGetMouseButton(v->window.glfw, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
    const bool pressed = down && !v->mouse_down;
    v->mouse_down = down;
    if (!pressed || view_panel_has_mouse())
        return;
    glfwGetCursorPos(v->window.glfw, &x, &y);
    x = (x - (double)area[0]) / (double)area[2];
    y = (y - (double)area[1]) / (double)area[3];
    if (x >= 0 && x < 1 && y >= 0 && y < 1)
        view_focus_at(v, x, y);
}

void view_focus_move(viewer *v, const float area[4], double time_s)
{
    shot *s = &v->shot;
    click(v, area);
    if (!s->focus_picked)
        return;
    const double focus_m = s->scene->camera.focus_m, wanted = focus_m > 0 ? 1 / focus_m : 0;
    s->picked_inv_m += (wanted - s->picked_inv_m) * (1 - exp(-time_s / EASE_S));
}

bool view_focus_pick(viewer *v)
{
    shot *s = &v->shot;
    char assignment[64];
    v->picking = false;
    if (!host_wait(&s->device, v->error, sizeof v->error))
        return false;
    const double focus_m =
        host_camera_distance(&v->seen, host_target_picked_depth(&s->device, &s->target, (float)COVERAGE));
    s->picked_inv_m = shot_focus_inv_m(s, s->camera_time_s);
    s->focus_picked = true;
    snprintf(assignment, sizeof assignment, "camera.focus_m=%.4g", focus_m < 1e6 ? focus_m : 0);
    if (view_assign(v, assignment))
        view_print(v, "%s", focus_m < 1e6 ? assignment : "focus at infinity");
    return true;
}
