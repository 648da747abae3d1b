/* wipers.c - what is seen of a pane beside its drops: arms and blades of its wipers, and a dark frame around
 * it, as a mesh that is laid along the pane anew for each picture. */
#include "panes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SECTIONS      12 /* along an arm or a blade, so that it follows a bent pane */
#define BAR_POINTS    (SECTIONS * 8)
#define BAR_INDICES   ((SECTIONS - 1) * 24)
#define EDGE_STEPS    24 /* of the frame, along each side of the pane */
#define FRAME_POINTS  (8 * (EDGE_STEPS + 1))
#define ARM_M         0.014 /* width of an arm */
#define ARM_ABOVE_M   0.018 /* of its middle over the glass */
#define BLADE_ABOVE_M 0.009

/* ---- vertices */

typedef struct maker {
    const glass_pane *pane;
    virga_glass_pose pose;
    host_vertex *vertices;
    uint32_t count;
} maker;

static void put(maker *m, const double point[3], const double normal[3])
{
    host_vertex *to = &m->vertices[m->count++];
    const float *r = m->pose.world_from_pane;
    memset(to, 0, sizeof *to);
    for (int i = 0; i < 3; i++) {
        double at = m->pose.position_m[i], n = 0;
        for (int k = 0; k < 3; k++) {
            at += (double)r[3 * k + i] * point[k];
            n += (double)r[3 * k + i] * normal[k];
        }
        to->position[i] = (float)at;
        to->normal[i] = (float)n;
    }
}

/* A cross-section of a bar: a rectangle, each of whose sides has corners of its own, as they differ in their
 * normals. */
static void put_section(maker *m, const double uv[2], const double across_uv[2], double half_width, double above,
                        double half_height)
{
    double middle[3], side[3], normal[3], ignored[3], across[3];
    glass_point(m->pane, uv[0], uv[1], middle, normal);
    glass_point(m->pane, uv[0] + 1e-3 * across_uv[0], uv[1] + 1e-3 * across_uv[1], side, ignored);
    for (int i = 0; i < 3; i++)
        across[i] = (side[i] - middle[i]) / 1e-3;
    for (int face = 0; face < 4; face++) {
        const double sx[4][2] = {{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}, sy[4][2] = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}};
        double outward[3], corner[3];
        for (int i = 0; i < 3; i++)
            outward[i] = face == 0 ? normal[i] : face == 1 ? across[i] : face == 2 ? -normal[i] : -across[i];
        for (int end = 0; end < 2; end++) {
            for (int i = 0; i < 3; i++)
                corner[i] = middle[i] + sx[face][end] * half_width * across[i] +
                            (above + sy[face][end] * half_height) * normal[i];
            put(m, corner, outward);
        }
    }
}

static void put_bar(maker *m, const double from[2], const double to[2], double width, double above, double height)
{
    const double way[2] = {to[0] - from[0], to[1] - from[1]}, length = fmax(hypot(way[0], way[1]), 1e-6);
    const double across[2] = {-way[1] / length, way[0] / length};
    for (int i = 0; i < SECTIONS; i++) {
        const double t = i / (SECTIONS - 1.0), at[2] = {from[0] + t * way[0], from[1] + t * way[1]};
        put_section(m, at, across, 0.5 * width, above, 0.5 * height);
    }
}

/* Arm from its axis to the blade's middle, and the blade; where the library has them at that time. */
static void put_wiper(maker *m, const scene_wiper *from, const virga_glass_wiper *wiper, double preroll_s,
                      double time_s)
{
    const double arm_deg = from->drive == SCENE_WIPER_KEYS ? scene_wiper_angle_deg(from, time_s)
                                                           : virga_glass_wiper_deg(wiper, fmax(time_s + preroll_s, 0));
    const double arm = arm_deg * M_PI / 180, hub = from->reach_m - 0.5 * from->blade_m;
    const double blade =
        (arm_deg + from->blade_deg - from->blade_hold_direction * (arm_deg - from->low_deg)) * M_PI / 180;
    const double middle[2] = {from->pivot_m[0] + hub * cos(arm), from->pivot_m[1] + hub * sin(arm)};
    const double half[2] = {0.5 * from->blade_m * cos(blade), 0.5 * from->blade_m * sin(blade)};
    const double ends[2][2] = {{middle[0] - half[0], middle[1] - half[1]}, {middle[0] + half[0], middle[1] + half[1]}};
    put_bar(m, from->pivot_m, middle, ARM_M, ARM_ABOVE_M, 0.006);
    put_bar(m, ends[0], ends[1], fmax(from->width_m, 0.004), BLADE_ABOVE_M, 0.014);
}

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

static uint32_t drawn_wipers(const scene_pane *pane)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pane->wiper_count; i++)
        count += pane->wipers[i].drawn;
    return count;
}

static uint32_t point_count(const scene_pane *pane)
{
    return drawn_wipers(pane) * 2 * BAR_POINTS + (pane->frame_m > 0 ? FRAME_POINTS : 0);
}

static void put_all(const shot *s, const glass_pane *pane, double time_s, host_vertex *vertices)
{
    maker m = {.pane = pane, .vertices = vertices};
    glass_pose(s, pane->from, time_s, &m.pose);
    for (uint32_t i = 0; i < pane->from->wiper_count; i++)
        if (pane->from->wipers[i].drawn)
            put_wiper(&m, &pane->from->wipers[i], &pane->settings.wipers[i], shot_preroll_s(s), time_s);
    if (pane->from->frame_m > 0)
        put_frame(&m);
}

/* ---- triangles */

static uint32_t put_quad(uint32_t *indices, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    const uint32_t corners[6] = {a, b, c, c, b, d};
    memcpy(indices, corners, sizeof corners);
    return 6;
}

static uint32_t put_indices(const scene_pane *pane, uint32_t *indices)
{
    uint32_t count = 0, first = 0;
    for (uint32_t bar = 0; bar < 2 * drawn_wipers(pane); bar++, first += BAR_POINTS)
        for (uint32_t i = 0; i + 1 < SECTIONS; i++)
            for (uint32_t face = 0; face < 4; face++) {
                const uint32_t at = first + i * 8 + face * 2;
                count += put_quad(indices + count, at, at + 1, at + 8, at + 9);
            }
    for (uint32_t side = 0; pane->frame_m > 0 && side < 4; side++)
        for (uint32_t i = 0; i < EDGE_STEPS; i++) {
            const uint32_t at = first + 2 * (side * (EDGE_STEPS + 1) + i);
            count += put_quad(indices + count, at, at + 1, at + 2, at + 3);
        }
    return count;
}

bool glass_create_mesh(shot *s, glass_pane *pane, char *error, size_t error_size)
{
    const host_material rubber = {
        .name = "rubber", .base_color = {0.02f, 0.02f, 0.021f, 1}, .roughness = 0.7f, .two_sided = true};
    const uint32_t points = point_count(pane->from);
    if (!points || !s->renderer)
        return true;
    host_vertex *vertices = calloc(points, sizeof *vertices);
    uint32_t *indices = malloc((size_t)points * 6 * sizeof *indices); /* more than enough */
    bool made = vertices && indices;
    if (!made)
        host_fail(error, error_size, "no memory for wipers");
    if (made) {
        put_all(s, pane, 0, vertices);
        made = host_mesh_create(&s->device, vertices, points, indices, put_indices(pane->from, indices), &rubber,
                                &pane->mesh, error, error_size);
        pane->mesh.apart = true;
        made = made && host_renderer_add(s->renderer, &pane->mesh, error, error_size);
    }
    free(vertices);
    free(indices);
    return made;
}

bool glass_move_mesh(shot *s, const glass_pane *pane, VkCommandBuffer cmd, double time_s, char *error,
                     size_t error_size)
{
    if (!pane->mesh.vertex_count)
        return true;
    host_vertex *vertices = calloc(pane->mesh.vertex_count, sizeof *vertices);
    if (!vertices)
        return host_fail(error, error_size, "no memory for wipers");
    put_all(s, pane, time_s, vertices);
    host_mesh_move(cmd, &pane->mesh, vertices);
    free(vertices);
    return true;
}
