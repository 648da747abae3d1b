/* swept.c - see swept.h. */
#include "swept.h"

#include <math.h>
#include <string.h>

#define FLATTEST 0.05 /* cosine: a bar that is seen flatter than this is drawn as if from there */
#define NOT_SEEN 9.0f /* as texture coordinates: beside the bar all the time */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* How a cross-section is seen. */
typedef struct profile {
    double half_m;    /* half of its width on the plane through its middle, along `across` */
    double margin_m;  /* the view's, in that plane to whichever side */
    double normal[3]; /* mean of the sides that are seen, by their areas on the picture */
} profile;

/* A ray that leaves the plane by s along `across` for each metre along `normal` meets a rectangle of the half sides a
 * and b where it meets the plane within a + |s| b of the middle. */
static profile see(const host_swept_bar *bar, const host_swept_view *view, const host_swept_place *at)
{
    profile p;
    double to_eye[3], far = 0, length = 0;
    for (int i = 0; i < 3; i++)
        to_eye[i] = view->eye_m[i] - at->middle[i];
    far = fmax(sqrt(dot(to_eye, to_eye)), 1e-6);
    const double out = dot(to_eye, at->normal) / far, side = dot(to_eye, at->across) / far;
    const double flat = fmax(fabs(out), FLATTEST), slope = fabs(side) / flat;
    p.half_m = fmax(bar->half_width_m + slope * bar->half_height_m, 1e-6);
    p.margin_m = view->margin_rad * far / flat;
    for (int i = 0; i < 3; i++) {
        p.normal[i] = bar->half_width_m * out * at->normal[i] + bar->half_height_m * side * at->across[i];
        length += p.normal[i] * p.normal[i];
    }
    for (int i = 0; i < 3; i++)
        p.normal[i] = length > 0 ? p.normal[i] / sqrt(length) : at->normal[i];
    return p;
}

static double side_of(const host_swept_place *at, const double point[3])
{
    const double from[3] = {point[0] - at->middle[0], point[1] - at->middle[1], point[2] - at->middle[2]};
    return dot(from, at->across);
}

/* Which way it goes, along `across`: by its end that goes farther. */
static double way_of(const host_swept_bar *bar)
{
    double way = 0;
    for (uint32_t i = 0; i < bar->count; i += bar->count - 1) {
        const double end = side_of(&bar->before[i], bar->close[i].middle);
        way = fabs(end) > fabs(way) ? end : way;
    }
    return way < 0 ? -1 : 1;
}

static void put(const host_swept_place *from, double off_m, const profile *p, double point[3], host_vertex *to)
{
    for (int axis = 0; axis < 3; axis++) {
        point[axis] = from->middle[axis] + off_m * from->across[axis];
        to->position[axis] = (float)point[axis];
        to->normal[axis] = (float)p->normal[axis];
    }
    to->uv[0] = to->uv[1] = NOT_SEEN;
}

/* How far it is to the side is linear in the point, so it is right all over a triangle between vertices where it is. */
static void put_seen(const host_swept_bar *bar, uint32_t i, const host_swept_place *from, double off_m,
                     const profile *p, host_vertex *to)
{
    double point[3];
    put(from, off_m, p, point, to);
    to->uv[0] = (float)(side_of(&bar->open[i], point) / p->half_m);
    to->uv[1] = (float)(side_of(&bar->close[i], point) / p->half_m);
}

/* Before an end, which is that of the place i: from its two vertices on, away from the place before it. */
static void put_strip(const host_swept_bar *bar, uint32_t i, uint32_t inner, double margin_m, const host_vertex end[2],
                      host_vertex to[4])
{
    double out[3], length2 = 0;
    for (int axis = 0; axis < 3; axis++) {
        out[axis] = bar->close[i].middle[axis] - bar->close[inner].middle[axis];
        length2 += out[axis] * out[axis];
    }
    for (int v = 0; v < 4; v++) {
        to[v] = end[v % 2];
        for (int axis = 0; axis < 3 && v >= 2; axis++)
            to[v].position[axis] += (float)(margin_m * out[axis] / fmax(sqrt(length2), 1e-9));
    }
}

void host_swept_put(const host_swept_bar *bar, const host_swept_view *view, host_vertex *vertices)
{
    const double way = way_of(bar);
    const uint32_t last = bar->count - 1;
    host_vertex *trace = vertices + 2 * bar->count, *ends = trace + 2 * bar->count;
    double margins_m[2] = {0, 0}, ignored[3];
    for (uint32_t i = 0; i <= last; i++) {
        const profile p = see(bar, view, &bar->close[i]);
        const double off_m = way * (p.half_m + p.margin_m);
        put_seen(bar, i, &bar->open[i], -way * p.half_m, &p, &vertices[2 * i]);
        put_seen(bar, i, &bar->close[i], way * p.half_m, &p, &vertices[2 * i + 1]);
        put(&bar->before[i], -off_m, &p, ignored, &trace[2 * i]);
        put(&bar->close[i], off_m, &p, ignored, &trace[2 * i + 1]);
        margins_m[i > 0] = p.margin_m;
    }
    put_strip(bar, 0, 1, margins_m[0], &trace[0], &ends[0]);
    put_strip(bar, last, last - 1, margins_m[1], &trace[2 * last], &ends[4]);
}

static uint32_t put_quad(uint32_t a, uint32_t *indices)
{
    const uint32_t corners[6] = {a, a + 1, a + 2, a + 2, a + 1, a + 3};
    memcpy(indices, corners, sizeof corners);
    return 6;
}

uint32_t host_swept_indices(uint32_t first, uint32_t count, uint32_t *indices)
{
    uint32_t written = 0;
    for (uint32_t i = 0; i + 1 < 2 * count; i++)
        written += i + 1 == count ? 0 : put_quad(first + 2 * i, indices + written);
    for (uint32_t end = 0; end < 2; end++)
        written += put_quad(first + 4 * count + 4 * end, indices + written);
    return written;
}
