/* focus.c - what the camera of a shot focuses on, and the points of its lens. */
#include "shot/focus.h"

#include "effect.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <virga/lens.h>

/* ---- objects */

/* The middle of all parts of meshes whose name, or the name of whose material, contains `name`. */
static bool find_mesh(const shot *s, const char *name, double point_m[3])
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t m = 0; m < s->meshes_loaded; m++) {
        const host_mesh *mesh = &s->meshes[m];
        for (uint32_t i = 0; i < mesh->primitive_count; i++) {
            const host_primitive *part = &mesh->primitives[i];
            if (!strcasestr(part->name, name) && !strcasestr(mesh->materials[part->material].name, name))
                continue;
            for (int axis = 0; axis < 3; axis++) {
                low[axis] = fminf(low[axis], part->low[axis]);
                high[axis] = fmaxf(high[axis], part->high[axis]);
            }
        }
    }
    for (int axis = 0; axis < 3; axis++)
        point_m[axis] = 0.5 * ((double)low[axis] + (double)high[axis]);
    return high[0] >= low[0];
}

static bool find(shot *s, const char *name, double camera_s, double point_m[3], double normal[3])
{
    memset(normal, 0, 3 * sizeof *normal);
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->find && tool_effects[i]->find(s, s->states[i], name, camera_s, point_m, normal))
            return true;
    return find_mesh(s, name, point_m);
}

/* How far along the camera's axis a point is; for a surface, where the axis meets its plane, if it does so at less than
 * 75 degrees. */
static double depth_of(const host_camera *camera, const double point_m[3], const double normal[3])
{
    double depth = 0, across = 0, away = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double ahead = -(double)camera->view_from_world[4 * axis + 2];
        depth += ahead * (point_m[axis] - camera->position_m[axis]);
        across += ahead * normal[axis];
        away += normal[axis] * (point_m[axis] - camera->position_m[axis]);
    }
    return fabs(across) > 0.26 && away / across > 0 ? away / across : depth;
}

#define NEAREST_M 0.01 /* what is behind the camera, or in it, is focused as if it were here */

static double inv_m_at(shot *s, double camera_s, const char *name, double focus_m)
{
    double point_m[3], normal[3];
    host_camera camera;
    if (!name || !find(s, name, camera_s, point_m, normal))
        return focus_m > 0 ? 1 / focus_m : 0;
    const host_camera_path eye = shot_eye(s);
    host_camera_at(&eye, camera_s, s->options.width, s->options.height, NULL, &camera);
    return 1 / fmax(depth_of(&camera, point_m, normal), NEAREST_M);
}

double shot_focus_inv_m(shot *s, double camera_s)
{
    const scene_camera *camera = &s->scene->camera;
    const scene_focus_key *keys = camera->focus_keys;
    uint32_t next = 0;
    if (s->focus_picked)
        return s->picked_inv_m;
    if (!camera->focus_key_count)
        return inv_m_at(s, camera_s, camera->focus_on, camera->focus_m);
    while (next < camera->focus_key_count && keys[next].time_s <= camera_s)
        next++;
    const scene_focus_key *a = &keys[next > 0 ? next - 1 : 0];
    const scene_focus_key *b = &keys[next < camera->focus_key_count ? next : next - 1];
    const double span = b->time_s - a->time_s, u = span > 0 ? (camera_s - a->time_s) / span : 0;
    const double share = u * u * (3 - 2 * u);
    return (1 - share) * inv_m_at(s, camera_s, a->focus_on, a->focus_m) +
           share * inv_m_at(s, camera_s, b->focus_on, b->focus_m);
}

static bool check_name(shot *s, const char *name, const char *key, char *error, size_t error_size)
{
    double point_m[3], normal[3];
    if (!name || find(s, name, 0, point_m, normal))
        return true;
    scene_file_refuse(s->scene, key, error, error_size, SHOT_NO_SUCH_FOCUS, name);
    return shot_blame_input(s, false);
}

bool shot_check_focus(shot *s, char *error, size_t error_size)
{
    const scene_camera *camera = &s->scene->camera;
    bool good = check_name(s, camera->focus_on, "camera.focus_on", error, error_size);
    for (uint32_t i = 0; good && i < camera->focus_key_count; i++) {
        char key[64];
        snprintf(key, sizeof key, "camera.focus_keys.%u.focus_on", i);
        good = check_name(s, camera->focus_keys[i].focus_on, key, error, error_size);
    }
    return good;
}

/* ---- the lens */

void shot_camera(shot *s, double camera_s, double focus_inv_m, const float jitter_px[2], host_camera *camera)
{
    const scene_camera *from = &s->scene->camera;
    const host_camera_path eye = shot_eye(s);
    const double larger = virga_lens_breathing(scene_camera_focal_m(s->scene), focus_inv_m > 0 ? 1 / focus_inv_m : 0);
    host_camera_at(&eye, camera_s, s->options.width, s->options.height, jitter_px, camera);
    if (from->breathing > 0 && focus_inv_m > 0)
        host_camera_zoom(camera, 1 + from->breathing * (larger - 1));
}

bool shot_gathers(const shot *s)
{
    const scene_camera *camera = &s->scene->camera;
    return camera->aperture_f > 0 && (camera->blur == SCENE_BLUR_GATHER || s->options.live);
}

bool shot_looks_through_lens(const shot *s)
{
    return s->scene->camera.aperture_f > 0 && !shot_gathers(s);
}

/* How large the aperture would have to be for its edge to go through a point; see shaders/lens/aperture.comp. */
static double reach(const scene_camera *camera, const double point[2])
{
    const double distance = hypot(point[0], point[1]);
    if (camera->blades < 3)
        return distance;
    const double blade = 2 * M_PI / camera->blades;
    const double angle = atan2(point[1], point[0]) - camera->blade_rotation_deg * M_PI / 180;
    const double phi = angle - blade * floor(angle / blade + 0.5);
    const double straight = cos(0.5 * blade) / cos(phi);
    return distance / (straight + camera->blade_roundness * (1 - straight));
}

/* Points of a square that lie in the aperture. They come from the sequence of Roberts 2018, whose first points are even
 * for any number of them and go with no jitter of host_camera_jitter: 1/p and 1/p^2, p^3 = p + 1. */
void shot_lens_point(const scene_camera *camera, uint32_t index, uint32_t count, double point[2])
{
    const double p = 1.32471795724474602596;
    uint32_t found = 0;
    point[0] = point[1] = 0;
    if (index == count / 2)
        return;
    const uint32_t wanted = index < count / 2 ? index : index - 1;
    for (uint32_t i = 1;; i++) {
        double ignored;
        point[0] = 2 * modf(0.5 + i / p, &ignored) - 1;
        point[1] = 2 * modf(0.5 + i / (p * p), &ignored) - 1;
        if (reach(camera, point) <= 1 && found++ == wanted)
            return;
    }
}

/* As shaders/lens/aperture.glsl has it: a second aperture, shifted towards the picture's centre. A trace of the rest
 * stays, for pixels that no sub-frame would reach. */
void shot_lens_weights(const scene_camera *camera, const double point[2], uint32_t width, uint32_t height,
                       float *weights)
{
    const double middle[2] = {0.5 * width, 0.5 * height}, corner = hypot(middle[0], middle[1]);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const double right = point[0] - camera->cats_eye * (middle[0] - x - 0.5) / corner;
            const double down = point[1] - camera->cats_eye * (middle[1] - y - 0.5) / corner;
            weights[(size_t)y * width + x] = right * right + down * down <= 1 ? 1 : 1e-4f;
        }
}
