/* renderer_frame.c - the uniforms of a plate: camera, lights, sky, wet ground, mirror; and which lights a draw has. */
#include <math.h>
#include <string.h>

#include "renderer_internal.h"

/* Transforms a point relative to the camera into clip space: the rotation of the view, and the projection. */
static void clip_from_relative(const host_camera *camera, const float clip_from_view[16], float out[16])
{
    float rotation[16];
    memcpy(rotation, camera->view_from_world, sizeof rotation);
    rotation[12] = rotation[13] = rotation[14] = 0.0f;
    host_matrix_multiply(clip_from_view, rotation, out);
}

/* Directions of pixels, from the view rotation and the scale and jitter of the projection. */
static void fill_rays(const host_camera *camera, struct host_frame_gpu *frame)
{
    const float *view = camera->view_from_world, *p = camera->clip_from_view;
    for (int i = 0; i < 3; i++) {
        float right = view[i * 4], up = view[i * 4 + 1], back = view[i * 4 + 2];
        frame->ray_x[i] = right / p[0];
        frame->ray_y[i] = up / p[5];
        frame->ray_z[i] = right * p[8] / p[0] + up * p[9] / p[5] - back;
    }
}

static void fill_light(const virga_light *light, const host_camera *camera, struct host_light_gpu *out)
{
    memset(out, 0, sizeof *out);
    for (int i = 0; i < 3; i++) {
        out->position[i] = (float)(light->position_m[i] - camera->position_m[i]);
        out->intensity[i] = light->intensity[i];
    }
    out->position[3] = light->range_m > 0.0f ? 1.0f / light->range_m : 0.0f;
    out->cone[1] = 1.0f;
    const float *d = light->direction;
    float length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (!(length > 0.0f))
        return;
    for (int i = 0; i < 3; i++)
        out->direction[i] = d[i] / length;
    out->cone[0] = 1.0f / fmaxf(light->cos_inner - light->cos_outer, 1e-4f);
    out->cone[1] = -light->cos_outer * out->cone[0];
}

/* Harmonics times the factors of the basis and of the cosine lobe over pi (Ramamoorthi and Hanrahan 2001). */
static void fill_irradiance(const float sh[9][3], host_vec4 out[9])
{
    static const float factor[9] = {0.28209479f, 0.32573501f, 0.32573501f, 0.32573501f, 0.27313711f,
                                    0.27313711f, 0.07884789f, 0.27313711f, 0.13656855f};
    for (int k = 0; k < 9; k++)
        for (int c = 0; c < 3; c++)
            out[k][c] = factor[k] * sh[k][c];
}

static void fill_ground(const virga_ground_maps *maps, const host_camera *camera, struct host_frame_gpu *frame)
{
    if (!maps->cells)
        return;
    for (int axis = 0; axis < 2; axis++) {
        const double cell = floor(maps->low_m[axis] / (double)maps->cell_m + 0.5);
        frame->ground_low[axis * 2] = (float)(maps->low_m[axis] - camera->position_m[axis * 2]);
        frame->ground_wrap[axis] = (float)(cell - floor(cell / maps->cells) * maps->cells);
    }
    frame->ground_low[1] = (float)((double)maps->base_m - camera->position_m[1]);
    frame->ground_low[3] = 1.0f / maps->cell_m;
    frame->ground_wrap[2] = (float)maps->cells;
    frame->ground_wrap[3] = maps->reach_m / maps->cell_m;
    if (maps->far_wetness) {
        frame->ground_far[1] = 1.0f / maps->far_cell_m;
        frame->ground_far[3] = (float)maps->far_cells;
    }
    for (int axis = 0; axis < 2; axis++)
        frame->ground_far[axis * 2] = (float)(maps->far_low_m[axis] - camera->position_m[axis * 2]);
    const float side_m = (float)maps->ripple_texels * maps->ripple_texel_m;
    for (int axis = 0; axis < 2; axis++)
        frame->ripples[axis] = (float)(maps->ripple_low_m[axis] - camera->position_m[axis * 2]);
    frame->ripples[2] = 1.0f / side_m;
    frame->ripples[3] = side_m;
}

/* The mirror is drawn if there is a ground and the lower edge of the picture looks down at it. */
static void fill_mirror(const host_renderer *r, const host_camera *camera, struct host_frame_gpu *frame)
{
    const float lowest = frame->ray_z[1] - fabsf(frame->ray_x[1]) - fabsf(frame->ray_y[1]);
    frame->mirror[0] = (float)(r->mirror_m - camera->position_m[1]);
    frame->mirror[1] = 1.0f / HOST_MIRROR_MARGIN;
    frame->mirror[2] = r->mirror.width && r->ground.cells && frame->mirror[0] < 0.0f && lowest < 0.0f;
}

void host_renderer_place_mirror(host_renderer *r, const host_camera *camera, const struct host_frame_gpu *frame)
{
    const float sides[2] = {(float)r->mirror.width, (float)r->mirror.height};
    r->mirror_shows = frame->mirror[2];
    memcpy(r->mirror_eye_m, camera->position_m, sizeof r->mirror_eye_m);
    for (int column = 0; column < 4; column++) {
        const float *from = &frame->clip_from_relative[column * 4];
        float *to = &r->mirror_clip[column * 4];
        memcpy(to, from, 4 * sizeof *to);
        for (int axis = 0; axis < 2; axis++) { /* as mirror_jitter.glsl has it */
            const float jitter = 2.0f / sides[axis] - 2.0f * frame->mirror[1] / frame->screen[axis];
            to[axis] = from[axis] * frame->mirror[1] + from[3] * frame->screen[2 + axis] * jitter;
        }
    }
}

/* The mirror's picture may be another sub-frame's. */
void host_renderer_look_at_mirror(const host_renderer *r, const host_camera *camera, struct host_frame_gpu *frame)
{
    float *m = frame->mirror_from_relative;
    frame->mirror[2] *= r->mirror_shows;
    memcpy(m, r->mirror_clip, sizeof r->mirror_clip);
    for (int axis = 0; axis < 3; axis++)
        for (int row = 0; row < 4; row++)
            m[12 + row] += (float)(camera->position_m[axis] - r->mirror_eye_m[axis]) * m[axis * 4 + row];
}

/* Two or four sub-frames after each other share the looks at the mirror, so that together they take all. Where shading
 * is shared those that shade for others look twice as often, and each group begins with another look. */
static void fill_sampling(const host_camera *camera, struct host_frame_gpu *frame)
{
    const uint32_t samples = camera->samples ? camera->samples : 1;
    const bool shares = camera->shares > 1;
    const uint32_t all = samples % 4 == 0 ? 4 : samples % 2 == 0 ? 2 : 1;
    const uint32_t step = shares && !camera->follows && all > 1 ? all / 2 : all;
    const uint32_t group = shares ? camera->sample / camera->shares : 0;
    frame->sampling[0] = 1.0f / (float)samples;
    frame->sampling[1] = (float)((camera->sample + group) % step);
    frame->sampling[2] = (float)step;
}

void host_renderer_fill_frame(const host_renderer *r, const host_target *target, const host_camera *camera,
                              const host_camera *previous, struct host_frame_gpu *frame)
{
    memset(frame, 0, sizeof *frame);
    clip_from_relative(camera, camera->clip_from_view, frame->clip_from_relative);
    clip_from_relative(previous, previous->clip_from_view_plain, frame->previous_from_relative);
    for (int i = 0; i < 3; i++) {
        frame->camera[i] = (float)camera->position_m[i];
        frame->moved[i] = (float)(camera->position_m[i] - previous->position_m[i]);
    }
    frame->moved[3] = (float)r->light_count;
    frame->screen[0] = (float)target->width;
    frame->screen[1] = (float)target->height;
    frame->screen[2] = camera->jitter_px[0];
    frame->screen[3] = camera->jitter_px[1];
    fill_rays(camera, frame);
    frame->environment[0] = r->environment->rotation / 6.28318531f;
    host_skylight_frame(&r->skylight, camera->position_m, frame);
    fill_sampling(camera, frame);
    fill_irradiance(r->environment->sh, frame->irradiance);
    fill_ground(&r->ground, camera, frame);
    fill_mirror(r, camera, frame);
    if (r->has_walls && r->shelter.ready)
        host_shelter_frame(&r->shelter, &r->walls, camera->position_m, frame);
    if (r->ground.cells && r->has_contact && r->contact.ready)
        host_contact_frame(&r->contact, camera->position_m, frame);
    frame->sampling[3] = r->has_meniscus;
    for (uint32_t i = 0; i < r->light_count; i++)
        fill_light(&r->lights[i], camera, &frame->lights[i]);
}

/* Whether a light reaches into a box: its range does, and it does not turn its back on all of it. */
static bool reaches(const virga_light *light, const float low[3], const float high[3])
{
    const float *d = light->direction;
    const bool spot = d[0] != 0.0f || d[1] != 0.0f || d[2] != 0.0f;
    double apart2 = 0, most_ahead = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double to_low = (double)low[axis] - light->position_m[axis];
        const double to_high = (double)high[axis] - light->position_m[axis];
        const double apart = fmax(fmax(to_low, -to_high), 0);
        apart2 += apart * apart;
        most_ahead += fmax((double)d[axis] * to_low, (double)d[axis] * to_high);
    }
    const double range_m = 1.001 * (double)light->range_m + 0.001;
    return (light->range_m <= 0.0f || apart2 <= range_m * range_m) &&
           (!spot || light->cos_outer < 0.0f || light->cos_inner < 0.0f || most_ahead > -1e-3);
}

uint32_t host_renderer_lamps(const host_renderer *r, const host_mesh *mesh, const host_primitive *primitive)
{
    uint32_t bits = 0;
    const float *low, *high;
    const bool known = host_mesh_bounds(mesh, primitive, &low, &high);
    for (uint32_t i = 0; i < r->light_count; i++)
        bits |= !known || reaches(&r->lights[i], low, high) ? 1u << i : 0;
    return bits;
}
