/* camera.c - interpolation along a path of keys and the matrices of a view. */
#include "camera.h"

#include <math.h>
#include <string.h>

#include "fail.h"

#define PI 3.14159265358979323846

/* ---- path --------------------------------------------------------------------------------------------------- */

static bool finite3(const double v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

bool host_camera_path_check(const host_camera_path *path, char *error, size_t error_size)
{
    if (path->count == 0)
        return host_fail(error, error_size, "camera: needs at least one key");
    if (!(path->fov_deg > 0.0 && path->fov_deg < 180.0))
        return host_fail(error, error_size, "camera: fov_deg %g is not between 0 and 180", path->fov_deg);
    const host_camera_calibration *c = &path->calibration;
    if ((c->focal_px[0] != 0 || c->focal_px[1] != 0) &&
        !(c->focal_px[0] > 0 && c->focal_px[1] > 0 && c->size_px[0] > 0 && c->size_px[1] > 0 &&
          isfinite(c->focal_px[0] + c->focal_px[1] + c->center_px[0] + c->center_px[1])))
        return host_fail(error, error_size, "camera: calibration has a size or a focal length that is not above 0");
    if (!(path->near_m > 0.0 && path->near_m < path->far_m && isfinite(path->far_m)))
        return host_fail(error, error_size, "camera: expected 0 < near_m (%g) < far_m (%g)", path->near_m, path->far_m);
    for (uint32_t i = 0; i < path->count; i++) {
        const host_camera_key *key = &path->keys[i];
        if (!isfinite(key->time_s) || !isfinite(key->roll_deg) || !finite3(key->position_m) || !finite3(key->look_at_m))
            return host_fail(error, error_size, "camera: key %u has a value that is not finite", i);
        if (i > 0 && !(key->time_s > path->keys[i - 1].time_s))
            return host_fail(error, error_size, "camera: time of key %u (%g s) does not rise", i, key->time_s);
        if (memcmp(key->position_m, key->look_at_m, sizeof key->position_m) == 0)
            return host_fail(error, error_size, "camera: key %u looks at its own position", i);
    }
    return true;
}

/* First and last key of the shot at a time. */
static void find_shot(const host_camera_path *path, double time_s, uint32_t *first, uint32_t *last)
{
    *first = 0;
    for (uint32_t i = 1; i < path->count; i++)
        if (path->keys[i].cut && path->keys[i].time_s <= time_s)
            *first = i;
    *last = *first;
    while (*last + 1 < path->count && !path->keys[*last + 1].cut)
        ++*last;
}

double host_camera_shot_start(const host_camera_path *path, double time_s)
{
    uint32_t first, last;
    find_shot(path, time_s, &first, &last);
    return first == 0 ? -INFINITY : path->keys[first].time_s;
}

/* Position, target and roll as one vector, so that one spline moves them all. */
enum { CHANNELS = 7 };

static double channel(const host_camera_key *key, int c)
{
    return c < 3 ? key->position_m[c] : c < 6 ? key->look_at_m[c - 3] : key->roll_deg;
}

static double slope(const host_camera_path *path, uint32_t i, int c)
{
    const host_camera_key *a = &path->keys[i], *b = &path->keys[i + 1];
    return (channel(b, c) - channel(a, c)) / (b->time_s - a->time_s);
}

/* Speed at key i: that of the parabola through it and its neighbours (Catmull and Rom 1974, for uneven knots). At the
 * ends of a shot the parabola of the neighbour continues. */
static double speed(const host_camera_path *path, uint32_t i, uint32_t first, uint32_t last, int c)
{
    if (i > first && i < last) {
        double before = path->keys[i].time_s - path->keys[i - 1].time_s;
        double after = path->keys[i + 1].time_s - path->keys[i].time_s;
        return (slope(path, i - 1, c) * after + slope(path, i, c) * before) / (before + after);
    }
    if (last - first == 1)
        return slope(path, first, c);
    if (i == first)
        return 1.5 * slope(path, i, c) - 0.5 * speed(path, i + 1, first, last, c);
    return 1.5 * slope(path, i - 1, c) - 0.5 * speed(path, i - 1, first, last, c);
}

static void evaluate(const host_camera_path *path, double time_s, double value[CHANNELS])
{
    uint32_t first, last;
    find_shot(path, time_s, &first, &last);
    const host_camera_key *keys = path->keys;
    uint32_t i = first;
    while (i + 1 < last && keys[i + 1].time_s <= time_s)
        i++;
    for (int c = 0; c < CHANNELS; c++) {
        if (time_s <= keys[first].time_s) {
            value[c] = channel(&keys[first], c);
        } else if (time_s >= keys[last].time_s) {
            value[c] = channel(&keys[last], c);
        } else {
            double h = keys[i + 1].time_s - keys[i].time_s;
            double u = (time_s - keys[i].time_s) / h, v = 1.0 - u;
            value[c] = channel(&keys[i], c) * (1.0 + 2.0 * u) * v * v +
                       channel(&keys[i + 1], c) * (3.0 - 2.0 * u) * u * u +
                       h * u * v * (v * speed(path, i, first, last, c) - u * speed(path, i + 1, first, last, c));
        }
    }
}

/* ---- matrices ----------------------------------------------------------------------------------------------- */

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static bool normalize(double v[3])
{
    double length = sqrt(dot(v, v));
    if (!(length > 1e-12))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

/* Right, up and back of a camera. If it looks straight up or down, right is any horizontal axis. */
static void basis(const double position[3], const double target[3], double roll_deg, double axes[3][3])
{
    double *right = axes[0], *up = axes[1], *back = axes[2];
    for (int i = 0; i < 3; i++)
        back[i] = position[i] - target[i];
    if (!normalize(back))
        back[0] = back[1] = 0.0, back[2] = 1.0;
    const double world_up[3] = {0.0, 1.0, 0.0};
    cross(world_up, back, right);
    if (!normalize(right))
        right[0] = 1.0, right[1] = right[2] = 0.0;
    cross(back, right, up);
    double c = cos(roll_deg * PI / 180.0), s = sin(roll_deg * PI / 180.0);
    for (int i = 0; i < 3; i++) {
        double r = right[i], u = up[i];
        right[i] = c * r - s * u;
        up[i] = s * r + c * u;
    }
}

host_camera_key host_camera_key_of_axes(double time_s, const double position_m[3], const double axes[3][3])
{
    host_camera_key key = {.time_s = time_s};
    double level[3][3];
    for (int i = 0; i < 3; i++) {
        key.position_m[i] = position_m[i];
        key.look_at_m[i] = position_m[i] - axes[2][i];
    }
    basis(key.position_m, key.look_at_m, 0, level);
    key.roll_deg = atan2(-dot(axes[0], level[1]), dot(axes[0], level[0])) * 180.0 / PI;
    return key;
}

void host_camera_unwrap_rolls(host_camera_key *keys, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++)
        keys[i].roll_deg += 360.0 * round((keys[i - 1].roll_deg - keys[i].roll_deg) / 360.0);
}

bool host_camera_same_aspect(const uint32_t size_px[2], uint32_t width, uint32_t height)
{
    const double apart = fabs((double)size_px[1] * width - (double)size_px[0] * height);
    return apart < fmax(size_px[0], size_px[1]);
}

void host_camera_intrinsics(const host_camera_path *path, uint32_t width, uint32_t height, double focal[2],
                            double center[2])
{
    const host_camera_calibration *c = &path->calibration;
    center[0] = center[1] = 0.5;
    if (!(c->focal_px[1] > 0)) {
        focal[1] = 0.5 / tan(path->fov_deg * PI / 360.0);
        focal[0] = focal[1] * height / width;
        return;
    }
    const bool same = host_camera_same_aspect(c->size_px, width, height);
    const double across_px = same ? c->size_px[0] : (double)c->size_px[1] * width / height;
    focal[0] = c->focal_px[0] / across_px;
    focal[1] = c->focal_px[1] / c->size_px[1];
    center[0] += (c->center_px[0] - 0.5 * c->size_px[0]) / across_px;
    center[1] = c->center_px[1] / c->size_px[1];
}

static void projection(const host_camera_path *path, uint32_t width, uint32_t height, const float jitter_px[2],
                       float m[16])
{
    double focal[2], center[2];
    host_camera_intrinsics(path, width, height, focal, center);
    double range = path->near_m - path->far_m;
    memset(m, 0, 16 * sizeof *m);
    m[0] = (float)(2.0 * focal[0]);
    m[5] = (float)(-2.0 * focal[1]);
    /* Times -w: shifts of the picture by jitter pixels, and of its middle to where the axis is. */
    m[8] = -2.0f * jitter_px[0] / (float)width - (float)(2.0 * center[0] - 1.0);
    m[9] = -2.0f * jitter_px[1] / (float)height - (float)(2.0 * center[1] - 1.0);
    m[10] = (float)(path->far_m / range);
    m[11] = -1.0f;
    m[14] = (float)(path->near_m * path->far_m / range);
}

void host_camera_at(const host_camera_path *path, double time_s, uint32_t width, uint32_t height,
                    const float jitter_px[2], host_camera *camera)
{
    static const float center[2] = {0.0f, 0.0f};
    double value[CHANNELS], axes[3][3];
    evaluate(path, time_s, value);
    basis(&value[0], &value[3], value[6], axes);

    memset(camera, 0, sizeof *camera);
    memcpy(camera->position_m, value, sizeof camera->position_m);
    memcpy(camera->jitter_px, jitter_px ? jitter_px : center, sizeof camera->jitter_px);
    camera->near_m = path->near_m;
    camera->far_m = path->far_m;
    camera->width = width;
    camera->height = height;
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            camera->view_from_world[column * 4 + row] = (float)axes[row][column];
        camera->view_from_world[12 + row] = (float)-dot(axes[row], value);
    }
    camera->view_from_world[15] = 1.0f;
    projection(path, width, height, camera->jitter_px, camera->clip_from_view);
    projection(path, width, height, center, camera->clip_from_view_plain);
}

void host_camera_zoom(host_camera *camera, double factor)
{
    for (int i = 0; i <= 5; i += 5) {
        camera->clip_from_view[i] = (float)((double)camera->clip_from_view[i] * factor);
        camera->clip_from_view_plain[i] = (float)((double)camera->clip_from_view_plain[i] * factor);
    }
}

/* A point at (x, y, -focus) is at (x - dx, y - dy) from the new eye. The columns of z get what keeps it in place:
 * m0 (x - dx) - m8 focus = m0 x. */
void host_camera_move_on_lens(host_camera *camera, const double lens_m[2], double focus_m)
{
    const double per_m = focus_m > 0 ? 1 / focus_m : 0;
    for (int axis = 0; axis < 2; axis++) {
        const double shift = -(double)camera->clip_from_view_plain[5 * axis] * lens_m[axis] * per_m;
        camera->clip_from_view[8 + axis] = (float)((double)camera->clip_from_view[8 + axis] + shift);
        camera->clip_from_view_plain[8 + axis] = (float)((double)camera->clip_from_view_plain[8 + axis] + shift);
        camera->view_from_world[12 + axis] = (float)((double)camera->view_from_world[12 + axis] - lens_m[axis]);
        for (int i = 0; i < 3; i++) /* rows of the matrix are the camera's axes */
            camera->position_m[i] += lens_m[axis] * (double)camera->view_from_world[4 * i + axis];
    }
}

void host_matrix_multiply(const float a[16], const float b[16], float out[16])
{
    float result[16];
    for (int column = 0; column < 4; column++) {
        for (int row = 0; row < 4; row++) {
            float sum = 0.0f;
            for (int k = 0; k < 4; k++)
                sum += a[k * 4 + row] * b[column * 4 + k];
            result[column * 4 + row] = sum;
        }
    }
    memcpy(out, result, sizeof result);
}

/* ---- what a frame needs ------------------------------------------------------------------------------------- */

/* The (0, 2)-sequence of Sobol 1967: the columns of the first axis are single bits, those of the second one Pascal's
 * triangle modulo 2. So each part of a power of two of points has one in each row and in each column of that many. */
static double sobol(uint32_t index, int axis)
{
    uint32_t bits = 0;
    for (uint32_t column = 1u << 31; index > 0; index >>= 1, column = axis == 0 ? column >> 1 : column ^ column >> 1)
        bits ^= index & 1 ? column : 0;
    return bits / 4294967296.0;
}

/* Less the mean of all, as a picture would lie beside itself by that: four of Halton's sequence by a tenth of a pixel,
 * which was a tenth of their error. Of Sobol's first four no two have that mean, of these the first and the last do. */
void host_camera_jitter(uint32_t index, uint32_t count, float jitter_px[2])
{
    static const float four[4][2] = {{-0.375f, 0.125f}, {0.125f, 0.375f}, {-0.125f, -0.375f}, {0.375f, -0.125f}};
    for (int axis = 0; axis < 2; axis++) {
        double mean = 0;
        for (uint32_t i = 0; i < count; i++)
            mean += sobol(i, axis) / count;
        jitter_px[axis] = count == 4 ? four[index % 4][axis] : count < 2 ? 0.0f : (float)(sobol(index, axis) - mean);
    }
}

uint32_t host_camera_jitter_turn(uint32_t group, uint32_t share)
{
    static const uint32_t of_four[4] = {0, 2, 3, 1};
    return share == 4 ? of_four[group % 4] : group % share;
}

uint32_t host_camera_jitter_index(uint32_t sample, uint32_t share)
{
    const uint32_t group = sample / share;
    return group * share + (sample + host_camera_jitter_turn(group, share)) % share;
}

double host_camera_distance(const host_camera *camera, float depth)
{
    if (!(depth < 1.0f))
        return INFINITY;
    return camera->near_m * camera->far_m / (camera->far_m - (double)depth * (camera->far_m - camera->near_m));
}

void host_camera_view(const host_camera *camera, const host_camera *open, double shutter_s, virga_view *view)
{
    memcpy(view->position_m, camera->position_m, sizeof view->position_m);
    memcpy(view->view_from_world, camera->view_from_world, sizeof view->view_from_world);
    memcpy(view->clip_from_view, camera->clip_from_view, sizeof view->clip_from_view);
    memcpy(view->open_position_m, open->position_m, sizeof view->open_position_m);
    memcpy(view->open_view_from_world, open->view_from_world, sizeof view->open_view_from_world);
    memcpy(view->open_clip_from_view, open->clip_from_view, sizeof view->open_clip_from_view);
    view->shutter_s = shutter_s;
    view->viewport[0] = view->viewport[1] = 0.0f;
    view->viewport[2] = (float)camera->width;
    view->viewport[3] = (float)camera->height;
    view->reversed_depth = false;
}
