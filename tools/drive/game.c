/* game.c - the camera, the keys, and what a frame is: of the window, or of a file. */
#include "game.h"

#include "png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define LONGEST_FRAME_S 0.1 /* the world's time in a frame that took longer */

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

/* Outside there is no windshield before the camera. */
void move_focus(drive *d, double dt_s)
{
    const double wanted = d->focused && !d->outside ? 1 : 0;
    d->focus = d->time_s > 0 ? d->focus + (wanted - d->focus) * fmin(5 * dt_s, 1) : wanted;
    if (fabs(wanted - d->focus) < 0.01)
        d->focus = wanted;
    d->time_s += dt_s;
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
    case GLFW_KEY_F: d->focused = !d->focused; break;
    case GLFW_KEY_W: d->wiper_speed = (d->wiper_speed + 1) % WIPER_SPEEDS; break;
    case GLFW_KEY_A: d->car.autopilot = true; break;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD: d->rate_mm_h = d->rate_mm_h < 1 ? 1 : fminf(d->rate_mm_h * 1.25f, MAX_RATE_MM_H); break;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT: d->rate_mm_h = d->rate_mm_h < 1 ? 0 : d->rate_mm_h / 1.25f; break;
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

static bool next_of_window(drive *d, double *dt_s)
{
    if (!d->frame) {
        glfwSetWindowUserPointer(d->window, d);
        glfwSetKeyCallback(d->window, on_key);
        d->last_s = glfwGetTime();
    } else {
        update_title(d, d->last_s);
    }
    if (d->chosen.frames && d->frame == d->chosen.frames)
        return false;
    glfwPollEvents();
    read_keys(d);
    const double now_s = glfwGetTime();
    *dt_s = fmin(fmax(now_s - d->last_s, 0), LONGEST_FRAME_S);
    d->last_s = now_s;
    d->frame++;
    return !glfwWindowShouldClose(d->window);
}

/* ---- frames without a window */

#define WARM_UP_FRAMES 8 /* they are not counted: pipelines are compiled when they are first used, maps are new */

static double seconds(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* How even the frames were. A frame lasts from its beginning to that of the next one. The processor's time, of all its
 * cores, does not depend on what else the machine does; with software Vulkan it has all of the work. */
static void print_frame_times(const char *name, double *frame_s, uint32_t count)
{
    if (count <= WARM_UP_FRAMES)
        return;
    frame_s += WARM_UP_FRAMES;
    count -= WARM_UP_FRAMES;
    qsort(frame_s, count, sizeof *frame_s, by_size);
    printf("%-24s %8.3f ms median, 90 %% %.3f, 99 %% %.3f, longest %.3f, of %u frames\n", name,
           1e3 * frame_s[count / 2], 1e3 * frame_s[count * 9 / 10], 1e3 * frame_s[count * 99 / 100],
           1e3 * frame_s[count - 1], count);
}

/* Time passes by equal steps, or as long as the frame before has taken, as in a window. */
static bool next_of_file(drive *d, double *dt_s)
{
    const double now_s = seconds(CLOCK_MONOTONIC), work_s = seconds(CLOCK_PROCESS_CPUTIME_ID);
    *dt_s = 1.0 / d->chosen.fps;
    if (!d->frame) {
        d->frame_s = calloc(d->chosen.frames, sizeof *d->frame_s);
        d->work_s = calloc(d->chosen.frames, sizeof *d->work_s);
    }
    if (!d->frame_s || !d->work_s)
        return host_fail(d->error, sizeof d->error, "no memory for the times of %u frames", d->chosen.frames);
    if (d->frame) {
        d->frame_s[d->frame - 1] = now_s - d->last_s;
        d->work_s[d->frame - 1] = work_s - d->last_work_s;
        if (d->chosen.real_time)
            *dt_s = fmin(now_s - d->last_s, LONGEST_FRAME_S);
    }
    d->last_s = now_s;
    d->last_work_s = work_s;
    if (d->frame == d->chosen.frames)
        return false;
    d->frame++;
    return true;
}

bool next_frame(drive *d, double *dt_s)
{
    return d->window ? next_of_window(d, dt_s) : next_of_file(d, dt_s);
}

bool finish_file(drive *d)
{
    if (d->error[0])
        return false;
    print_frame_times("frame", d->frame_s, d->frame);
    print_frame_times("processor", d->work_s, d->frame);
    return png_write(d->chosen.out, d->stage.width, d->stage.height, 4, stage_picture(&d->stage), d->error,
                     sizeof d->error);
}
