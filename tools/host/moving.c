/* moving.c - see moving.h. */
#include "moving.h"

#include <math.h>

#define AROUND_PX 3.0 /* jitter, and what filters of the mirror take from beside it */
#define SMEARED   0.5 /* rough water draws out what it mirrors, by so much of its height */

/* Grows the rectangle by a point; false: the point is behind the camera. */
static bool grow(const host_camera *camera, const double world_m[3], double low[2], double high[2])
{
    double view[3], clip[4];
    for (int row = 0; row < 3; row++) {
        view[row] = 0;
        for (int axis = 0; axis < 3; axis++)
            view[row] += (double)camera->view_from_world[4 * axis + row] * (world_m[axis] - camera->position_m[axis]);
    }
    for (int row = 0; row < 4; row++) {
        clip[row] = (double)camera->clip_from_view_plain[12 + row];
        for (int axis = 0; axis < 3; axis++)
            clip[row] += (double)camera->clip_from_view_plain[4 * axis + row] * view[axis];
    }
    if (clip[3] < camera->near_m)
        return false;
    const double sides[2] = {camera->width, camera->height};
    for (int axis = 0; axis < 2; axis++) {
        const double px = (0.5 + 0.5 * clip[axis] / clip[3]) * sides[axis];
        low[axis] = fmin(low[axis], px);
        high[axis] = fmax(high[axis], px);
    }
    return true;
}

static bool overlap(const host_moving *m, uint32_t a, uint32_t b)
{
    bool both = true;
    for (int axis = 0; axis < 2; axis++)
        both =
            both && m->rects[a].low[axis] <= m->rects[b].high[axis] && m->rects[b].low[axis] <= m->rects[a].high[axis];
    return both;
}

/* The last one goes into the first that it overlaps, or into any if there is no room. */
static void merge_last(host_moving *m)
{
    const uint32_t last = m->count - 1;
    uint32_t into = 0;
    while (into < last && !overlap(m, into, last))
        into++;
    if (into == last && m->count < HOST_REUSE_RECTS) /* the last place is kept free for the next one */
        return;
    into = into < last ? into : 0;
    for (int axis = 0; axis < 2; axis++) {
        const int32_t low = m->rects[last].low[axis], high = m->rects[last].high[axis];
        m->rects[into].low[axis] = low < m->rects[into].low[axis] ? low : m->rects[into].low[axis];
        m->rects[into].high[axis] = high > m->rects[into].high[axis] ? high : m->rects[into].high[axis];
    }
    m->count--;
}

/* The rectangle around eight corners, whose heights are turned over at a mirror's or not. */
static void add_corners(host_moving *m, const host_mesh *mesh, const host_camera *camera, const double *mirror_m)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    const double sides[2] = {camera->width, camera->height}, tall = (double)mesh->high[1] - (double)mesh->low[1];
    bool seen = true;
    for (int i = 0; i < 8; i++) {
        double at[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = (double)(i >> axis & 1 ? mesh->high[axis] : mesh->low[axis]);
        if (mirror_m)
            at[1] = 2 * *mirror_m - at[1] - (i & 2 ? SMEARED * tall : 0);
        seen = grow(camera, at, low, high) && seen;
    }
    if (m->count == HOST_REUSE_RECTS)
        return;
    for (int axis = 0; axis < 2; axis++) { /* without all of its corners: everywhere */
        m->rects[m->count].low[axis] = seen ? (int32_t)fmin(fmax(low[axis] - AROUND_PX, 0), sides[axis]) : 0;
        m->rects[m->count].high[axis] =
            (int32_t)(seen ? fmin(fmax(ceil(high[axis] + AROUND_PX), 0), sides[axis]) : sides[axis]);
    }
    const bool inside = m->rects[m->count].low[0] < m->rects[m->count].high[0] &&
                        m->rects[m->count].low[1] < m->rects[m->count].high[1];
    if (!inside)
        return;
    m->count++;
    merge_last(m);
}

void host_moving_add(host_moving *m, const host_mesh *mesh, const host_camera *camera)
{
    add_corners(m, mesh, camera, NULL);
}

void host_moving_add_mirrored(host_moving *m, const host_mesh *mesh, const host_camera *camera, double mirror_m)
{
    add_corners(m, mesh, camera, &mirror_m);
}

bool host_moving_shows_behind(const host_mesh *mesh)
{
    bool shows = false;
    for (uint32_t i = 0; i < mesh->material_count; i++)
        shows = shows || mesh->materials[i].alpha == HOST_ALPHA_GLASS;
    return shows;
}

/* As if it went across the line of sight, where it is nearest to the camera. */
double host_moving_travel_px(const host_mesh *mesh, const host_camera *camera)
{
    const double focal_px = 0.5 * camera->height * fabs((double)camera->clip_from_view_plain[5]);
    double apart2 = camera->near_m * camera->near_m;
    for (int axis = 0; axis < 3; axis++) {
        const double below = (double)mesh->low[axis] - camera->position_m[axis];
        const double above = camera->position_m[axis] - (double)mesh->high[axis];
        const double apart = fmax(fmax(below, above), 0);
        apart2 += apart * apart;
    }
    return mesh->moves ? focal_px * (double)mesh->travel_m / sqrt(apart2) : 0;
}

void host_moving_push(const host_moving *m, struct host_reuse_gpu *push)
{
    push->rect_count = m->count;
    for (uint32_t i = 0; i < m->count; i++) {
        push->rects[2 * i] = (uint32_t)m->rects[i].low[0] | (uint32_t)m->rects[i].low[1] << 16;
        push->rects[2 * i + 1] = (uint32_t)m->rects[i].high[0] | (uint32_t)m->rects[i].high[1] << 16;
    }
}
