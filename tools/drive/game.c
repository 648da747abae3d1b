/* game.c - the camera, the keys and the title of the window; and frames without one. */
#include "game.h"

#include "png.h"

#include <math.h>
#include <stdio.h>

void move_camera(drive *d, double dt_s)
{
    const double behind[3] = {0.5, 2.1, 6.2}, at[3] = {0, 1.0, -2};
    double wanted[3], aim[3], length = 0;
    car_point(&d->car, behind, wanted);
    for (int i = 0; i < 3; i++)
        d->eye_m[i] = dt_s > 0 ? d->eye_m[i] + (wanted[i] - d->eye_m[i]) * fmin(5 * dt_s, 1) : wanted[i];
    car_point(&d->car, car_eye_m, d->camera.position_m);
    car_point(&d->car, at, aim);
    for (int i = 0; i < 3; i++) { /* the driver looks a little down the road */
        const double down = 0.03 * (double)d->car.axes[3 + i];
        if (d->outside)
            d->camera.position_m[i] = d->eye_m[i];
        d->camera.forward[i] = d->outside ? aim[i] - d->eye_m[i] : -(double)d->car.axes[6 + i] - down;
        length += d->camera.forward[i] * d->camera.forward[i];
    }
    double f[3], up[3] = {0, 1, 0}, lifted = 0, upright = 0;
    for (int i = 0; i < 3; i++)
        f[i] = d->camera.forward[i] /= sqrt(length);
    for (int i = 0; i < 3; i++)
        lifted += up[i] * f[i];
    for (int i = 0; i < 3; i++) {
        up[i] -= lifted * f[i];
        upright += up[i] * up[i];
    }
    for (int i = 0; i < 3; i++)
        d->camera.up[i] = up[i] / sqrt(upright);
    d->camera.fov_deg = d->outside ? 48 : 50;
    stage_camera_set(&d->stage, &d->camera);
}

static void on_key(GLFWwindow *window, int key, int code, int action, int modifiers)
{
    drive *d = glfwGetWindowUserPointer(window);
    (void)code;
    (void)modifiers;
    if (action == GLFW_RELEASE)
        return;
    switch (key) {
    case GLFW_KEY_C:
        d->outside = !d->outside;
        d->has_last_camera = d->stage.has_last = false; /* a cut: no motion blur across it */
        break;
    case GLFW_KEY_W: d->wiper_speed = (d->wiper_speed + 1) % WIPER_SPEEDS; break;
    case GLFW_KEY_A: d->car.autopilot = true; break;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD: set_rate(d, d->rate_mm_h < 1 ? 1 : d->rate_mm_h * 1.25f); break;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT: set_rate(d, d->rate_mm_h < 1 ? 0 : d->rate_mm_h / 1.25f); break;
    case GLFW_KEY_ESCAPE: glfwSetWindowShouldClose(window, GLFW_TRUE); break;
    default: break;
    }
}

static void read_keys(drive *d)
{
    d->keys = (car_keys){.gas = glfwGetKey(d->window, GLFW_KEY_UP) == GLFW_PRESS,
                         .brake = glfwGetKey(d->window, GLFW_KEY_DOWN) == GLFW_PRESS,
                         .left = glfwGetKey(d->window, GLFW_KEY_LEFT) == GLFW_PRESS,
                         .right = glfwGetKey(d->window, GLFW_KEY_RIGHT) == GLFW_PRESS};
}

/* Shows rain rate, speed and frames per second, twice a second. */
static void update_title(drive *d, double now_s)
{
    static double since_s;
    static uint32_t frames;
    char title[160];
    frames++;
    if (now_s - since_s < 0.5)
        return;
    snprintf(title, sizeof title, "drive - rain %.1f mm/h - %.0f km/h - wipers %s - %.0f fps", (double)d->rate_mm_h,
             d->car.speed_m_s * 3.6, wiper_names[d->wiper_speed], frames / (now_s - since_s));
    glfwSetWindowTitle(d->window, title);
    since_s = now_s;
    frames = 0;
}

bool run_window(drive *d)
{
    double then_s = glfwGetTime();
    glfwSetWindowUserPointer(d->window, d);
    glfwSetKeyCallback(d->window, on_key);
    for (uint32_t i = 0; !glfwWindowShouldClose(d->window) && (!d->chosen.frames || i < d->chosen.frames); i++) {
        glfwPollEvents();
        read_keys(d);
        const double now_s = glfwGetTime(), dt_s = fmin(fmax(now_s - then_s, 0), 0.1); /* a long frame is shortened */
        then_s = now_s;
        if (!run_frame(d, dt_s, false))
            return false;
        update_title(d, now_s);
    }
    return host_wait(&d->device, d->error, sizeof d->error);
}

bool run_file(drive *d)
{
    for (uint32_t i = 0; i < d->chosen.frames; i++)
        if (!run_frame(d, 1.0 / d->chosen.fps, i + 1 == d->chosen.frames))
            return false;
    if (!host_wait(&d->device, d->error, sizeof d->error))
        return false;
    return png_write(d->chosen.out, d->stage.width, d->stage.height, 4, stage_picture(&d->stage), d->error,
                     sizeof d->error);
}
