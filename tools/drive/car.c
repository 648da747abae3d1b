/* car.c - the track, how the car drives on it, and where its parts are. */
#include "car.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WHEELBASE_M  2.6
#define FRONT_AXLE_M (-1.33)
#define REAR_AXLE_M  1.27
#define WHEEL_X_M    0.735
#define MAX_STEER    0.75 /* rad */
#define STEP_M       0.5  /* between points of the loaded track */
#define MAX_POINTS   65536

/* ---- the track */

/* Points at equal distances on a closed Catmull-Rom curve through the given points. */
static bool spread(const float (*given)[3], uint32_t count, track *t)
{
    const uint32_t fine = 64;
    double last[3] = {0}, way = 0, next = 0;
    t->points = malloc(MAX_POINTS * sizeof *t->points);
    for (uint32_t i = 0; t->points && i < count * fine; i++) {
        const double s = (double)(i % fine) / fine, s2 = s * s, s3 = s2 * s;
        const double weights[4] = {-0.5 * s3 + s2 - 0.5 * s, 1.5 * s3 - 2.5 * s2 + 1, -1.5 * s3 + 2 * s2 + 0.5 * s,
                                   0.5 * s3 - 0.5 * s2};
        double at[3] = {0};
        for (int k = 0; k < 4; k++)
            for (int axis = 0; axis < 3; axis++)
                at[axis] += weights[k] * (double)given[(i / fine + count + (uint32_t)k - 1) % count][axis];
        way += i ? hypot(at[0] - last[0], at[2] - last[2]) : 0;
        memcpy(last, at, sizeof last);
        if (way < next || t->count == MAX_POINTS)
            continue;
        for (int axis = 0; axis < 3; axis++)
            t->points[t->count][axis] = (float)at[axis];
        t->count++;
        next += STEP_M;
    }
    t->step_m = STEP_M;
    return t->points && t->count >= 8;
}

static bool read_line(char *line, track *t, float (*given)[3], uint32_t *count)
{
    float n[6];
    char *comment = strchr(line, '#');
    if (comment)
        *comment = 0;
    if (line[strspn(line, " \t\r\n")] == 0)
        return true;
    if (sscanf(line, "point %f %f %f", &n[0], &n[1], &n[2]) == 3 && *count < 1024)
        return memcpy(given[(*count)++], n, sizeof *given);
    if (sscanf(line, "width %f", &n[0]) == 1 && n[0] >= 1 && n[0] <= 100)
        return t->half_width_m = (double)n[0] / 2, true;
    if (sscanf(line, "speed %f", &n[0]) == 1 && n[0] >= 1 && n[0] <= 60)
        return t->speed_m_s = (double)n[0], true;
    const int read = sscanf(line, "lamp %f %f %f %f %f %f", &n[0], &n[1], &n[2], &n[3], &n[4], &n[5]);
    if (read == 6 && t->lamp_count < TRACK_LAMPS) {
        for (int i = 0; i < 3; i++) {
            t->lamps[t->lamp_count].position_m[i] = (double)n[i];
            t->lamps[t->lamp_count].intensity[i] = n[3 + i];
        }
        return t->lamp_count++, true;
    }
    if (sscanf(line, "box %f %f %f %f %f %f", &n[0], &n[1], &n[2], &n[3], &n[4], &n[5]) != 6 || t->box_count == 8)
        return false;
    memcpy(t->boxes[t->box_count].low, n, sizeof t->boxes[0].low);
    memcpy(t->boxes[t->box_count].high, n + 3, sizeof t->boxes[0].high);
    return t->box_count++, true;
}

bool track_load(const char *path, track *t, char *error, size_t error_size)
{
    char line[256];
    float given[1024][3];
    uint32_t count = 0, number = 0;
    FILE *file = fopen(path, "r");
    *t = (track){.half_width_m = 3, .speed_m_s = 12};
    if (!file)
        return host_fail(error, error_size, "%s: no such track; expected lines of `point X Y Z`", path);
    bool good = true;
    while (good && fgets(line, sizeof line, file)) {
        number++;
        good = read_line(line, t, given, &count);
    }
    fclose(file);
    if (!good)
        return host_fail(error, error_size, "%s:%u: expected width, speed, point, lamp or box and its numbers", path,
                         number);
    if (count < 4 || !spread(given, count, t)) {
        track_free(t);
        return host_fail(error, error_size, "%s: expected 4 points and more, not all in one place, got %u", path,
                         count);
    }
    return true;
}

void track_free(track *t)
{
    free(t->points);
    t->points = NULL;
    t->count = 0;
}

/* ---- driving */

static const float *ahead(const track *t, uint32_t from, double way_m)
{
    return t->points[(from + (uint32_t)(way_m / t->step_m)) % t->count];
}

static double distance2(const car *c, const float point[3])
{
    const double x = (double)point[0] - c->position_m[0], z = (double)point[2] - c->position_m[2];
    return x * x + z * z;
}

/* Finds the nearest point of the track, near the previous one: at a crossing the car stays on its part of the track. */
static void find_nearest(car *c, const track *t)
{
    uint32_t best = c->nearest;
    for (uint32_t i = 0; i < 40; i++) {
        const uint32_t tried = (c->nearest + t->count + i - 12) % t->count;
        if (distance2(c, t->points[tried]) < distance2(c, t->points[best]))
            best = tried;
    }
    c->nearest = best;
}

static double turned(double angle)
{
    return angle - 2 * M_PI * floor(angle / (2 * M_PI) + 0.5);
}

static double heading_to(const car *c, const float point[3])
{
    return atan2(c->position_m[0] - (double)point[0], c->position_m[2] - (double)point[2]);
}

/* Sets height, slope and axes from the two neighbours of the nearest point. */
static void stand(car *c, const track *t)
{
    const float *a = t->points[(c->nearest + t->count - 2) % t->count], *b = ahead(t, c->nearest, 2 * t->step_m);
    const double x = (double)b[0] - (double)a[0], z = (double)b[2] - (double)a[2], way2 = fmax(x * x + z * z, 1e-6);
    double along = ((c->position_m[0] - (double)a[0]) * x + (c->position_m[2] - (double)a[2]) * z) / way2;
    along = fmin(fmax(along, 0), 1);
    c->position_m[1] = (double)a[1] + along * ((double)b[1] - (double)a[1]);
    const double f[3] = {-sin(c->heading), 0, -cos(c->heading)};
    c->slope = ((double)b[1] - (double)a[1]) * (f[0] * x + f[2] * z) / way2;
    const double length = sqrt(1 + c->slope * c->slope);
    const double back[3] = {-f[0] / length, -c->slope / length, -f[2] / length};
    const double right[3] = {cos(c->heading), 0, -sin(c->heading)};
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        c->axes[i] = (float)right[i];
        c->axes[3 + i] = (float)(back[j] * right[k] - back[k] * right[j]);
        c->axes[6 + i] = (float)back[i];
    }
}

void car_place(car *c, const track *t, double way_m)
{
    *c = (car){.autopilot = true, .nearest = (uint32_t)(fmax(way_m, 0) / t->step_m) % t->count};
    for (int axis = 0; axis < 3; axis++)
        c->position_m[axis] = (double)t->points[c->nearest][axis];
    c->heading = heading_to(c, ahead(t, c->nearest, 4));
    stand(c, t);
}

/* Steers towards a point ahead, and slows down before bends to a lateral acceleration of about 2 m/s^2. */
static void steer_by_itself(const car *c, const track *t, double *gas, double *steer)
{
    const double look_m = 2 + 0.4 * c->speed_m_s;
    const double off = turned(heading_to(c, ahead(t, c->nearest, look_m)) - c->heading);
    double slowest = t->speed_m_s;
    for (double way = 0; way < 5 + c->speed_m_s * c->speed_m_s / 5; way += 2) {
        const float *a = ahead(t, c->nearest, way), *b = ahead(t, c->nearest, way + 3),
                    *d = ahead(t, c->nearest, way + 6);
        const double first = atan2((double)b[0] - (double)a[0], (double)b[2] - (double)a[2]);
        const double second = atan2((double)d[0] - (double)b[0], (double)d[2] - (double)b[2]);
        const double bend = fabs(turned(second - first)) / 3;
        const double there = sqrt(2.2 / fmax(bend, 1e-3)), now = sqrt(there * there + 2 * 2.5 * way);
        slowest = fmin(slowest, now);
    }
    *steer = atan(2 * WHEELBASE_M * sin(off) / look_m);
    *gas = fmin(fmax((slowest - c->speed_m_s) * 1.5, -5), 3);
}

static void steer_by_keys(const car *c, const car_keys *keys, double *gas, double *steer)
{
    const double limit = MAX_STEER / (1 + 0.12 * c->speed_m_s);
    *gas = keys->gas ? 4 : keys->brake ? -7 : -0.6;
    *steer = (keys->left ? limit : 0) - (keys->right ? limit : 0);
}

/* Moves a car that left the track back to its edge. */
static void keep_on(car *c, const track *t)
{
    const float *at = t->points[c->nearest];
    const double off = sqrt(distance2(c, at));
    if (off <= t->half_width_m)
        return;
    for (int axis = 0; axis < 3; axis += 2)
        c->position_m[axis] = (double)at[axis] + (c->position_m[axis] - (double)at[axis]) * t->half_width_m / off;
    c->speed_m_s *= 0.97;
}

void car_drive(car *c, const track *t, const car_keys *keys, double dt_s)
{
    double gas, steer;
    const double before = c->heading;
    float then[3];
    memcpy(then, c->velocity_m_s, sizeof then);
    if (keys->gas || keys->brake || keys->left || keys->right)
        c->autopilot = false;
    if (c->autopilot)
        steer_by_itself(c, t, &gas, &steer);
    else
        steer_by_keys(c, keys, &gas, &steer);
    c->steer += (fmin(fmax(steer, -MAX_STEER), MAX_STEER) - c->steer) * fmin(10 * dt_s, 1);
    c->speed_m_s = fmin(fmax(c->speed_m_s + gas * dt_s, 0), 60);
    c->rolled = turned(c->rolled + c->speed_m_s / (double)CAR_WHEEL_RADIUS_M * dt_s);
    c->heading = turned(c->heading + c->speed_m_s / WHEELBASE_M * tan(c->steer) * dt_s);
    c->position_m[0] -= sin(c->heading) * c->speed_m_s * dt_s;
    c->position_m[2] -= cos(c->heading) * c->speed_m_s * dt_s;
    find_nearest(c, t);
    keep_on(c, t);
    stand(c, t);
    for (int i = 0; i < 3; i++) {
        c->velocity_m_s[i] = (float)-c->speed_m_s * c->axes[6 + i];
        c->acceleration_m_s2[i] = dt_s > 0 ? (c->velocity_m_s[i] - then[i]) / (float)dt_s : 0;
    }
    c->angular_velocity_rad_s[1] = dt_s > 0 ? (float)(turned(c->heading - before) / dt_s) : 0;
}

void car_point(const car *c, const double local[3], double world[3])
{
    for (int i = 0; i < 3; i++)
        world[i] = c->position_m[i] + (double)c->axes[i] * local[0] + (double)c->axes[3 + i] * local[1] +
                   (double)c->axes[6 + i] * local[2];
}

/* ---- the body */

const double car_windshield_m[3] = {0, 0.86, -1.2};
const double car_eye_m[3] = {-0.36, 1.2, 0.08};
const double car_head_lamps_m[2][3] = {{-0.58, 0.61, -2.15}, {0.58, 0.61, -2.15}};
const double car_tail_lamps_m[2][3] = {{-0.58, 0.79, 2.0}, {0.58, 0.79, 2.0}};

car_part car_part_of(const char *material)
{
    static const struct {
        const char *begins;
        car_part part;
    } names[] = {{"cabin_", CAR_CABIN},
                 {"glass_side", CAR_WINDOWS},
                 {"wheel_", CAR_WHEEL},
                 {"rain_cover", CAR_COVER},
                 {"rain_screen", CAR_SCREEN}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strncmp(material, names[i].begins, strlen(names[i].begins)) == 0)
            return names[i].part;
    return CAR_BODY;
}

/* Transforms axes of the car's frame into the world. */
static void axes_to_world(const car *c, double local[9], float axes[9])
{
    for (int column = 0; column < 3; column++)
        for (int i = 0; i < 3; i++)
            axes[3 * column + i] =
                (float)(local[3 * column] * (double)c->axes[i] + local[3 * column + 1] * (double)c->axes[3 + i] +
                        local[3 * column + 2] * (double)c->axes[6 + i]);
}

void car_wheel(const car *c, int wheel, double position_m[3], float axes[9])
{
    const bool right = wheel % 2, front = wheel < 2;
    const double axle[3] = {right ? WHEEL_X_M : -WHEEL_X_M, (double)CAR_WHEEL_RADIUS_M,
                            front ? FRONT_AXLE_M : REAR_AXLE_M};
    /* It rolls about its axle; on the left it is mirrored by half a turn; then it is steered about the vertical axis.
     * */
    const double roll = right ? c->rolled : -c->rolled, turn = (front ? c->steer : 0) + (right ? 0 : M_PI);
    const double cr = cos(roll), sr = -sin(roll), ct = cos(turn), st = sin(turn);
    double local[9] = {ct, 0, -st, st * sr, cr, ct * sr, st * cr, -sr, ct * cr};
    car_point(c, axle, position_m);
    axes_to_world(c, local, axes);
}
