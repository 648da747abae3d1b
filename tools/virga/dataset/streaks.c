/* streaks.c - projects drops as shaders/rain/draw/streak_write.comp does, with the same coverage. */
#include "dataset/streaks.h"

#include "effect.h"
#include "rain.h"
#include "rain/rain_drop.h"
#include "shot/distort.h"
#include "shot/focus.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NEAR_M       0.02
#define MAX_COVERAGE 0.25 /* of a streak that stands for many drops, as shaders/rain/draw/view.glsl has it */
#define MIN_COVERAGE (1.0 / 800)
#define WIDE_PX      3.0

/* What is the same for all streaks of a picture. */
typedef struct eye {
    const shot *s;
    const scene_rain *rain;
    host_camera close, open; /* where the shutter closes and opens */
    double shutter_s;
    double pixel_angle;
    double lens_px, inv_focus; /* of the blur, as shaders/rain/draw/view.glsl has them */
    double group_m, group_m_s;
    double min_coverage;
} eye;

static void open_eye(shot *s, uint32_t frame, double min_coverage, eye *e)
{
    const scene_camera *camera = &s->scene->camera;
    const double time_s = shot_time(s, frame), focus = shot_focus_inv_m(s, time_s);
    memset(e, 0, sizeof *e);
    e->s = s;
    e->rain = scene_rain_of(s->scene);
    e->shutter_s = s->scene->frames.shutter_deg / 360 / s->scene->frames.fps;
    shot_camera(s, time_s, focus, NULL, &e->close);
    shot_camera(s, time_s - e->shutter_s, focus, NULL, &e->open);
    e->pixel_angle = 2 / (fabs((double)e->close.clip_from_view_plain[5]) * e->close.height);
    const double aperture_m = camera->aperture_f > 0 ? scene_camera_aperture_m(s->scene) : 1e-3 * camera->aperture_mm;
    e->lens_px = (shot_looks_through_lens(s) ? 0 : fmin(aperture_m, 1)) / e->pixel_angle;
    e->inv_focus = focus;
    e->group_m = 1e-3 * e->rain->streak_group_mm;
    e->group_m_s = virga_drop_terminal_speed(e->group_m, e->rain->air_density);
    e->min_coverage = min_coverage;
}

/* ---- the path of a drop */

/* Place on the pinhole's picture, and the view depth. False: behind the camera, or too near. */
static bool project(const host_camera *camera, const double world[3], double at[2], double *depth)
{
    const float *m = camera->view_from_world, *p = camera->clip_from_view_plain;
    double v[3];
    for (int row = 0; row < 3; row++) {
        v[row] = 0;
        for (int column = 0; column < 3; column++)
            v[row] += (double)m[4 * column + row] * (world[column] - camera->position_m[column]);
    }
    *depth = -v[2];
    if (!(*depth > NEAR_M))
        return false;
    at[0] = ((double)p[0] * v[0] + (double)p[8] * v[2]) / *depth;
    at[1] = ((double)p[5] * v[1] + (double)p[9] * v[2]) / *depth;
    at[0] = (0.5 + 0.5 * at[0]) * camera->width;
    at[1] = (0.5 + 0.5 * at[1]) * camera->height;
    return true;
}

typedef struct path {
    double head[2], tail[2], depths[2]; /* of head and tail */
    double length_px, distance_m;       /* distance of its middle from the camera */
} path;

static bool find_path(const eye *e, const rain_drop *drop, path *p)
{
    double head[3], tail[3], square = 0;
    for (int i = 0; i < 3; i++) {
        head[i] = (double)drop->position[i];
        tail[i] = head[i] - (double)drop->velocity[i] * e->shutter_s;
        const double away = 0.5 * (head[i] + tail[i]) - e->close.position_m[i];
        square += away * away;
    }
    p->distance_m = sqrt(square);
    if (!project(&e->close, head, p->head, &p->depths[0]) || !project(&e->open, tail, p->tail, &p->depths[1]))
        return false;
    p->length_px = hypot(p->head[0] - p->tail[0], p->head[1] - p->tail[1]);
    return true;
}

/* ---- coverage: shaders/rain/draw/view.glsl, where the formulas are explained */

static double drawn_width(const eye *e, double width, double blur)
{
    return fmax(width, fmax(e->rain->min_width_px, blur));
}

static double coverage_of(const eye *e, double width, double body, double way, double blur)
{
    const double longer = fmax(way, body);
    const double share = width / drawn_width(e, width, blur) * longer / fmax(longer, blur);
    return fmin(e->rain->streak_gain * body / longer, 1) * share;
}

static double limited_coverage(const eye *e, const rain_drop *drop, double width, double body, double way, double blur)
{
    const float *v = drop->velocity;
    const double diameter = 2 * (double)drop->radius_m, large_px = width * e->group_m / diameter;
    const double speed = sqrt((double)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    const double faster = sqrt((double)(v[0] * v[0] + v[2] * v[2]) + e->group_m_s * e->group_m_s) / fmax(speed, 1e-3);
    const double one = coverage_of(e, width, body, way, blur);
    const double large = coverage_of(e, large_px, large_px, way * faster, blur);
    const double all = fmin(one * (double)drop->weight, fmax(one, fmin(large, MAX_COVERAGE)));
    const double least = MIN_COVERAGE * fmin(WIDE_PX / drawn_width(e, width, blur), 1);
    return all * fmin(fmax(all / least - 1, 0), 1);
}

/* ---- what of it is seen */

static void to_picture(const eye *e, const double pinhole[2], double at[2])
{
    if (e->s->distortion)
        distortion_map_apply(&e->s->distortion->map, pinhole, at, NULL);
    else
        memcpy(at, pinhole, 2 * sizeof *at);
}

static bool is_before_plate(const eye *e, const double pinhole[2], double depth_m)
{
    const host_drawn *drawn = &e->s->frame;
    double at[2];
    to_picture(e, pinhole, at);
    if (!(at[0] >= 0 && at[0] < drawn->width && at[1] >= 0 && at[1] < drawn->height))
        return false;
    const float depth = drawn->depth[(size_t)at[1] * drawn->width + (size_t)at[0]];
    return depth_m < host_camera_distance(&e->close, depth);
}

/* Shortens the path to what is inside the picture and before the plate: from the first to the last such point. */
static bool cut_path(const eye *e, path *p)
{
    enum { MOST = 256 };
    const int steps = (int)fmin(fmax(ceil(p->length_px), 1), MOST);
    double first = 2, last = -1;
    for (int i = 0; i <= steps; i++) {
        const double share = (double)i / steps;
        const double at[2] = {p->tail[0] + share * (p->head[0] - p->tail[0]),
                              p->tail[1] + share * (p->head[1] - p->tail[1])};
        if (!is_before_plate(e, at, p->depths[1] + share * (p->depths[0] - p->depths[1])))
            continue;
        first = fmin(first, share);
        last = share;
    }
    if (last < 0)
        return false;
    const path whole = *p;
    for (int axis = 0; axis < 2; axis++) {
        p->tail[axis] = whole.tail[axis] + first * (whole.head[axis] - whole.tail[axis]);
        p->head[axis] = whole.tail[axis] + last * (whole.head[axis] - whole.tail[axis]);
    }
    return true;
}

/* ---- the outline */

/* Keeps what is on one side of a line x = limit (axis 0) or y = limit: Sutherland and Hodgman 1974. */
static uint32_t clip(double (*corners)[2], uint32_t count, int axis, double limit, double sign)
{
    double kept[STREAK_MAX_CORNERS][2];
    uint32_t n = 0;
    for (uint32_t i = 0; i < count && n + 2 <= STREAK_MAX_CORNERS; i++) {
        const double *a = corners[i], *b = corners[(i + 1) % count];
        const double in_a = sign * (a[axis] - limit), in_b = sign * (b[axis] - limit);
        if (in_a >= 0)
            memcpy(kept[n++], a, sizeof kept[0]);
        if ((in_a >= 0) == (in_b >= 0))
            continue;
        const double share = in_a / (in_a - in_b);
        kept[n][0] = a[0] + share * (b[0] - a[0]);
        kept[n++][1] = a[1] + share * (b[1] - a[1]);
    }
    memcpy(corners, kept, n * sizeof kept[0]);
    return n;
}

/* A rectangle around the path, half a body longer at both ends, cut by the picture's sides. */
static void outline(const eye *e, const path *p, double width, double body, streak *to)
{
    const double dx = p->head[0] - p->tail[0], dy = p->head[1] - p->tail[1], length = hypot(dx, dy);
    const double along[2] = {length > 1e-3 ? dx / length : 0, length > 1e-3 ? dy / length : 1};
    const double half = 0.5 * width, more = 0.5 * body;
    const double size[2] = {e->s->frame.width, e->s->frame.height};
    for (int i = 0; i < 4; i++) {
        const double *end = i < 2 ? p->tail : p->head;
        const double further = i < 2 ? -more : more, side = i == 0 || i == 3 ? half : -half;
        const double corner[2] = {end[0] + further * along[0] - side * along[1],
                                  end[1] + further * along[1] + side * along[0]};
        to_picture(e, corner, to->corners[i]);
    }
    to->corner_count = 4;
    for (int axis = 0; axis < 2 && to->corner_count; axis++) {
        to->corner_count = clip(to->corners, to->corner_count, axis, 0, 1);
        if (to->corner_count)
            to->corner_count = clip(to->corners, to->corner_count, axis, size[axis], -1);
    }
}

static void measure(streak *to)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, twice = 0;
    for (uint32_t i = 0; i < to->corner_count; i++) {
        const double *a = to->corners[i], *b = to->corners[(i + 1) % to->corner_count];
        twice += a[0] * b[1] - b[0] * a[1];
        for (int axis = 0; axis < 2; axis++) {
            low[axis] = fmin(low[axis], a[axis]);
            high[axis] = fmax(high[axis], a[axis]);
        }
    }
    to->area = 0.5 * fabs(twice);
    for (int axis = 0; axis < 2; axis++) {
        to->box[axis] = low[axis];
        to->box[2 + axis] = high[axis] - low[axis];
    }
}

static bool find_streak(const eye *e, const rain_drop *drop, streak *to)
{
    path p;
    const double diameter = 2 * (double)drop->radius_m, near_m = e->rain->near_fade_m;
    if (diameter < 1e-3 * e->rain->streak_min_mm || !find_path(e, drop, &p))
        return false;
    const double depth = 0.5 * (p.depths[0] + p.depths[1]);
    const double blur = e->lens_px * fabs(e->inv_focus - 1 / depth);
    const double width = diameter / (depth * e->pixel_angle), body = width * virga_drop_axis_ratio(diameter);
    const double near = near_m > 0 ? fmin(fmax(p.distance_m / near_m - 1, 0), 1) : 1;
    const double coverage = near * limited_coverage(e, drop, width, body, p.length_px, blur);
    const double drawn = drawn_width(e, width, blur), whole_px = p.length_px + fmax(body, blur);
    if (coverage < e->min_coverage || !cut_path(e, &p))
        return false;
    *to = (streak){.id = drop->id,
                   .drops = (double)drop->weight,
                   .coverage = fmin(coverage, 1),
                   .diameter_mm = 1e3 * diameter,
                   .distance_m = p.distance_m,
                   .width_px = drawn,
                   .length_px = whole_px};
    outline(e, &p, drawn, fmax(body, blur), to);
    if (to->corner_count < 3)
        return false;
    measure(to);
    return to->area > 0.01;
}

bool streaks_find(shot *s, uint32_t frame, double min_coverage, streak **streaks, uint32_t *count, char *error,
                  size_t error_size)
{
    eye e;
    void *rows = NULL;
    uint32_t effect = 0, drops = 0;
    *streaks = NULL;
    *count = 0;
    while (tool_effects[effect] != &rain_effect)
        effect++;
    open_eye(s, frame, min_coverage, &e);
    if (!rain_effect.points->read(s, s->states[effect], &rows, &drops, error, error_size))
        return false;
    const rain_drop *all = rows;
    streak *found = malloc(((size_t)drops + 1) * sizeof *found);
    for (uint32_t i = 0; found && i < drops; i++)
        *count += find_streak(&e, &all[i], &found[*count]);
    free(rows);
    if (!found)
        return host_fail(error, error_size, "no memory for %u streaks", drops);
    streak *fitted = realloc(found, ((size_t)*count + 1) * sizeof *fitted);
    *streaks = fitted ? fitted : found;
    return true;
}
