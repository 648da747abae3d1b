/* wipers.c - what is seen of a pane beside its drops: arms and blades of its wipers, and a dark frame around it, as
 * meshes that are laid along the pane anew for each picture. Wipers are blurred by their way, see swept.h. */
#include "panes.h"

#include "reuse.h"
#include "swept.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SECTIONS      12 /* along an arm or a blade, so that it follows a bent pane */
#define BAR_POINTS    HOST_SWEPT_VERTICES(SECTIONS)
#define EDGE_STEPS    24 /* of the frame, along each side of the pane */
#define FRAME_POINTS  (8 * (EDGE_STEPS + 1))
#define ARM_M         0.014 /* width of an arm */
#define ARM_ABOVE_M   0.018 /* of its middle over the glass */
#define ARM_HIGH_M    0.006
#define BLADE_ABOVE_M 0.009
#define BLADE_HIGH_M  0.014
#define MARGIN_PX     1.5 /* sub-frames see a point up to a pixel apart */

/* ---- vertices */

static void to_world(const virga_glass_pose *pose, const double vector[3], const double origin[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = origin ? origin[i] : 0;
        for (int k = 0; k < 3; k++)
            out[i] += (double)pose->world_from_pane[3 * k + i] * vector[k];
    }
}

typedef struct maker {
    const glass_pane *pane;
    virga_glass_pose pose;
    host_vertex *vertices;
    uint32_t count;
} maker;

static void put(maker *m, const double point[3], const double normal[3])
{
    host_vertex *to = &m->vertices[m->count++];
    double at[3], n[3];
    to_world(&m->pose, point, m->pose.position_m, at);
    to_world(&m->pose, normal, NULL, n);
    memset(to, 0, sizeof *to);
    for (int i = 0; i < 3; i++) {
        to->position[i] = (float)at[i];
        to->normal[i] = (float)n[i];
    }
}

/* ---- arms and blades */

/* Both ends of a bar on the pane. */
typedef struct bar_ends {
    double from[2], to[2];
} bar_ends;

/* Where the library has the arm at a time of the path. Its time begins with the pre-roll, when it may be on its way: it
 * was a whole turn before, too. */
static double find_arm_deg(const scene_wiper *from, const virga_glass_wiper *wiper, double time_s, double preroll_s)
{
    const double pause_s = from->drive == SCENE_WIPER_INTERMITTENT ? from->pause_s : 0;
    const double cycle_s = 2 * from->sweep_s + pause_s, into_s = time_s + preroll_s;
    return from->drive == SCENE_WIPER_KEYS
               ? scene_wiper_angle_deg(from, time_s)
               : virga_glass_wiper_deg(wiper, into_s < 0 ? into_s - cycle_s * floor(into_s / cycle_s) : into_s);
}

/* Arm from its axis to the blade's middle, and the blade. */
static void find_bars(const scene_wiper *from, double arm_deg, bar_ends *arm_ends, bar_ends *blade_ends)
{
    const double arm = arm_deg * M_PI / 180, hub = from->reach_m - 0.5 * from->blade_m;
    const double blade =
        (arm_deg + from->blade_deg - from->blade_hold_direction * (arm_deg - from->low_deg)) * M_PI / 180;
    const double along[2] = {cos(arm), sin(arm)}, half[2] = {cos(blade), sin(blade)};
    for (int i = 0; i < 2; i++) {
        arm_ends->from[i] = from->pivot_m[i];
        arm_ends->to[i] = from->pivot_m[i] + hub * along[i];
        blade_ends->from[i] = arm_ends->to[i] - 0.5 * from->blade_m * half[i];
        blade_ends->to[i] = arm_ends->to[i] + 0.5 * from->blade_m * half[i];
    }
}

/* Where it is along a bar, `above` the glass. */
static void place_bar(const glass_pane *pane, const virga_glass_pose *pose, const bar_ends *ends, double above,
                      host_swept_place places[SECTIONS])
{
    const double way[2] = {ends->to[0] - ends->from[0], ends->to[1] - ends->from[1]};
    const double length = fmax(hypot(way[0], way[1]), 1e-6), step = 1e-3;
    for (int i = 0; i < SECTIONS; i++) {
        const double t = i / (SECTIONS - 1.0), at[2] = {ends->from[0] + t * way[0], ends->from[1] + t * way[1]};
        double point[3], beside[3], across[3], normal[3], ignored[3], size = 0;
        glass_point(pane, at[0], at[1], point, normal);
        glass_point(pane, at[0] - step * way[1] / length, at[1] + step * way[0] / length, beside, ignored);
        for (int k = 0; k < 3; k++) {
            across[k] = beside[k] - point[k];
            size += across[k] * across[k];
            point[k] += above * normal[k];
        }
        for (int k = 0; k < 3; k++)
            across[k] /= fmax(sqrt(size), 1e-12);
        to_world(pose, point, pose->position_m, places[i].middle);
        to_world(pose, across, NULL, places[i].across);
        to_world(pose, normal, NULL, places[i].normal);
    }
}

/* When it is seen: times of the path, see host_swept_bar. */
typedef struct moments {
    double before_s, open_s, close_s, preroll_s;
    host_swept_view view;
    virga_glass_pose pose; /* now: the pane stands still meanwhile, as everything does that is not its wiper */
} moments;

static void put_wiper(const glass_pane *pane, const scene_wiper *from, const virga_glass_wiper *wiper,
                      const moments *at, host_vertex *vertices)
{
    const double times_s[3] = {at->before_s, at->open_s, at->close_s};
    host_swept_place places[2][3][SECTIONS];
    for (int i = 0; i < 3; i++) {
        bar_ends arm, blade;
        find_bars(from, find_arm_deg(from, wiper, times_s[i], at->preroll_s), &arm, &blade);
        place_bar(pane, &at->pose, &arm, ARM_ABOVE_M, places[0][i]);
        place_bar(pane, &at->pose, &blade, BLADE_ABOVE_M, places[1][i]);
    }
    for (int i = 0; i < 2; i++) {
        const host_swept_bar bar = {.before = places[i][0],
                                    .open = places[i][1],
                                    .close = places[i][2],
                                    .count = SECTIONS,
                                    .half_width_m = 0.5 * (i == 0 ? ARM_M : fmax(from->width_m, 0.004)),
                                    .half_height_m = 0.5 * (i == 0 ? ARM_HIGH_M : BLADE_HIGH_M)};
        host_swept_put(&bar, &at->view, vertices + i * BAR_POINTS);
    }
}

/* A sub-frame's share of the time that the shutter is open, and the sub-frames before it that share its shading. */
static void find_moments(const shot *s, const glass_pane *pane, double time_s, moments *at)
{
    const double part_s = s->scene->frames.shutter_deg / 360 / s->scene->frames.fps / s->options.samples;
    const uint32_t share = host_reuse_share(s->options.samples);
    host_camera camera;
    *at = (moments){.open_s = time_s - part_s, .close_s = time_s, .preroll_s = shot_preroll_s(s)};
    at->before_s = time_s - share * part_s;
    if (!s->device.independent_blend)
        at->before_s = at->open_s = time_s;
    glass_pose(s, pane->from, time_s, &at->pose);
    host_camera_at(&s->path, time_s, s->options.width, s->options.height, NULL, &camera);
    memcpy(at->view.eye_m, camera.position_m, sizeof at->view.eye_m);
    if (share > 1)
        at->view.margin_rad = 2 * MARGIN_PX / (camera.height * fabs((double)camera.clip_from_view_plain[5]));
}

static void put_wipers(const shot *s, const glass_pane *pane, double time_s, host_vertex *vertices)
{
    moments at;
    find_moments(s, pane, time_s, &at);
    for (uint32_t i = 0; i < pane->from->wiper_count; i++)
        if (pane->from->wipers[i].drawn) {
            put_wiper(pane, &pane->from->wipers[i], &pane->settings.wipers[i], &at, vertices);
            vertices += 2 * BAR_POINTS;
        }
}

/* ---- frame */

/* Along the four sides, from the edge outwards. */
static void put_frame(maker *m)
{
    const scene_pane *pane = m->pane->from;
    const double w = pane->width_m, h = pane->height_m, f = pane->frame_m;
    const double corners[5][2] = {{0, 0}, {w, 0}, {w, h}, {0, h}, {0, 0}};
    const double beyond[5][2] = {{-f, -f}, {w + f, -f}, {w + f, h + f}, {-f, h + f}, {-f, -f}};
    for (int side = 0; side < 4; side++)
        for (int step = 0; step <= EDGE_STEPS; step++) {
            const double t = (double)step / EDGE_STEPS;
            for (int out = 0; out < 2; out++) {
                const double(*c)[2] = out ? beyond : corners;
                double point[3], normal[3], inward[3];
                glass_point(m->pane, c[side][0] + t * (c[side + 1][0] - c[side][0]),
                            c[side][1] + t * (c[side + 1][1] - c[side][1]), point, normal);
                for (int i = 0; i < 3; i++)
                    inward[i] = -normal[i];
                put(m, point, inward);
            }
        }
}

static void put_whole_frame(const shot *s, const glass_pane *pane, double time_s, host_vertex *vertices)
{
    maker m = {.pane = pane, .vertices = vertices};
    glass_pose(s, pane->from, time_s, &m.pose);
    put_frame(&m);
}

static uint32_t frame_indices(uint32_t *indices)
{
    uint32_t count = 0;
    for (uint32_t side = 0; side < 4; side++)
        for (uint32_t i = 0; i < EDGE_STEPS; i++) {
            const uint32_t at = 2 * (side * (EDGE_STEPS + 1) + i),
                           corners[6] = {at, at + 1, at + 2, at + 2, at + 1, at + 3};
            memcpy(indices + count, corners, sizeof corners);
            count += 6;
        }
    return count;
}

/* ---- meshes */

static uint32_t drawn_wipers(const scene_pane *pane)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pane->wiper_count; i++)
        count += pane->wipers[i].drawn;
    return count;
}

static uint32_t wiper_indices(uint32_t wipers, uint32_t *indices)
{
    uint32_t count = 0;
    for (uint32_t bar = 0; bar < 2 * wipers; bar++)
        count += host_swept_indices(bar * BAR_POINTS, SECTIONS, indices + count);
    return count;
}

/* Room for its vertices, and for more indices than it has. */
typedef struct room {
    host_vertex *vertices;
    uint32_t *indices;
} room;

static bool make_mesh(shot *s, const room *r, uint32_t points, uint32_t index_count, host_alpha alpha, host_mesh *mesh,
                      char *error, size_t error_size)
{
    const host_material rubber = {.name = "rubber",
                                  .base_color = {0.02f, 0.02f, 0.021f, 1},
                                  .roughness = 0.7f,
                                  .alpha = alpha,
                                  .two_sided = true};
    if (!host_mesh_create(&s->device, r->vertices, points, r->indices, index_count, &rubber, mesh, error, error_size))
        return false;
    mesh->apart = true;
    return host_renderer_add(s->renderer, mesh, error, error_size);
}

static bool make_meshes(shot *s, glass_pane *pane, const room *r, char *error, size_t error_size)
{
    const uint32_t wipers = drawn_wipers(pane->from);
    const host_alpha alpha = s->device.independent_blend ? HOST_ALPHA_SWEPT : HOST_ALPHA_OPAQUE;
    if (wipers) {
        put_wipers(s, pane, 0, r->vertices);
        if (!make_mesh(s, r, wipers * 2 * BAR_POINTS, wiper_indices(wipers, r->indices), alpha, &pane->wipers, error,
                       error_size))
            return false;
    }
    if (pane->from->frame_m <= 0)
        return true;
    put_whole_frame(s, pane, 0, r->vertices);
    return make_mesh(s, r, FRAME_POINTS, frame_indices(r->indices), HOST_ALPHA_OPAQUE, &pane->frame, error, error_size);
}

static room make_room(const glass_pane *pane)
{
    const size_t points = drawn_wipers(pane->from) * 2 * BAR_POINTS + FRAME_POINTS;
    return (room){.vertices = calloc(points, sizeof(host_vertex)), .indices = malloc(points * 3 * sizeof(uint32_t))};
}

static bool end_room(room *r, bool good, char *error, size_t error_size)
{
    const bool whole = r->vertices && r->indices;
    free(r->vertices);
    free(r->indices);
    return whole ? good : host_fail(error, error_size, "no memory for wipers");
}

bool glass_create_mesh(shot *s, glass_pane *pane, char *error, size_t error_size)
{
    if (!s->renderer || (!drawn_wipers(pane->from) && pane->from->frame_m <= 0))
        return true;
    room r = make_room(pane);
    const bool good = r.vertices && r.indices && make_meshes(s, pane, &r, error, error_size);
    return end_room(&r, good, error, error_size);
}

bool glass_move_mesh(shot *s, const glass_pane *pane, VkCommandBuffer cmd, double time_s, char *error,
                     size_t error_size)
{
    if (!pane->wipers.vertex_count && !pane->frame.vertex_count)
        return true;
    room r = make_room(pane);
    if (r.vertices && pane->wipers.vertex_count) {
        put_wipers(s, pane, time_s, r.vertices);
        host_mesh_move(cmd, &pane->wipers, r.vertices);
    }
    if (r.vertices && pane->frame.vertex_count) {
        put_whole_frame(s, pane, time_s, r.vertices);
        host_mesh_move(cmd, &pane->frame, r.vertices);
    }
    return end_room(&r, true, error, error_size);
}
