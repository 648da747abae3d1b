/* shelter.c - the map of what driving rain meets first. */
#include "shelter.h"

#include <math.h>
#include <string.h>

#define SIDE_M  32.0
#define AHEAD_M 9.0   /* its middle is so far before the camera */
#define STEP_M  4.0   /* in steps, so that it is not drawn in every frame */
#define SLANTS  256.0 /* steps of the slant, 1 / this wide: as narrow as a pixel below an awning */
#define REACH_M 64.0  /* what is higher above the camera shelters nothing */

int32_t host_wall_material(const host_primitive *primitive, const host_material *material)
{
    const uint32_t surface = primitive->surface;
    if (material->alpha == HOST_ALPHA_GLASS || surface == VIRGA_MATERIAL_GLASS || surface >= HOST_WALL_MATERIALS)
        return -1;
    if (surface == VIRGA_MATERIAL_DEFAULT && material->metallic > 0.5f)
        return VIRGA_MATERIAL_STEEL;
    return surface == VIRGA_MATERIAL_DEFAULT && material->roughness < 0.5f ? VIRGA_MATERIAL_PLASTIC : (int32_t)surface;
}

bool host_shelter_create(host_device *device, VkRenderPass pass, uint32_t size, host_shelter *s, char *error,
                         size_t error_size)
{
    const host_image_def def = {
        .format = VK_FORMAT_D32_SFLOAT,
        .extent = {size, size, 1},
        .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
        .name = "shelter map",
    };
    s->size = size;
    return host_image_create(device, &def, &s->map, error, error_size) &&
           host_slice_create(device, pass, &s->map, 0, 0, &s->slice, error, error_size);
}

void host_shelter_destroy(host_device *device, host_shelter *s)
{
    host_slice_destroy(device, &s->slice);
    host_image_destroy(device, &s->map);
    memset(s, 0, sizeof *s);
}

/* Sheared, as the rain's own maps of occlusion are: (x, z) + slant y is the same all along a line of fall. */
static void look(host_shelter *s)
{
    const float scale = (float)(2 / SIDE_M), down = (float)(1 / s->height_m);
    float *m = s->map_from_world;
    memset(m, 0, sizeof s->map_from_world);
    m[0] = m[9] = scale;
    m[4] = scale * (float)s->slant[0];
    m[5] = scale * (float)s->slant[1];
    m[6] = -down;
    m[12] = -scale * (float)(s->low_m[0] + 0.5 * SIDE_M);
    m[13] = -scale * (float)(s->low_m[1] + 0.5 * SIDE_M);
    m[14] = down * (float)s->top_m;
    m[15] = 1;
}

bool host_shelter_place(host_shelter *s, const virga_walls *walls, const host_camera *camera, double low_m,
                        double high_m)
{
    const host_shelter before = *s;
    const float *m = camera->view_from_world; /* its third row points back */
    const double length = hypot((double)m[2], (double)m[10]);
    for (int axis = 0; axis < 2; axis++) {
        const double ahead = length > 1e-3 ? -AHEAD_M * (double)m[2 + 8 * axis] / length : 0;
        s->slant[axis] = floor((double)walls->slant[axis] * SLANTS + 0.5) / SLANTS;
        /* Walls that are seen are as high as the camera and some metres more. */
        const double middle = camera->position_m[2 * axis] + ahead + s->slant[axis] * (camera->position_m[1] + 3);
        s->low_m[axis] = floor((middle - 0.5 * SIDE_M) / STEP_M + 0.5) * STEP_M;
    }
    const double above = floor(camera->position_m[1] / STEP_M + 1) * STEP_M + REACH_M;
    s->top_m = fmin(high_m + 0.1, above);
    s->height_m = fmax(s->top_m - low_m + 0.1, 1);
    look(s);
    return !s->ready || memcmp(before.map_from_world, s->map_from_world, sizeof s->map_from_world) != 0;
}

void host_shelter_begin(const host_shelter *s, VkCommandBuffer cmd, VkRenderPass pass)
{
    host_pass_begin(cmd, pass, s->slice.framebuffer, s->size, s->size, 0);
}

void host_shelter_end(host_shelter *s, VkCommandBuffer cmd)
{
    vkCmdEndRenderPass(cmd);
    s->ready = true;
}

void host_shelter_coordinates(const host_shelter *s, const virga_walls *walls, const double camera_m[3], float low[4],
                              float slant[4])
{
    for (int axis = 0; axis < 2; axis++) {
        low[2 * axis] = (float)(camera_m[2 * axis] + s->slant[axis] * camera_m[1] - s->low_m[axis]);
        slant[axis] = (float)s->slant[axis];
    }
    low[1] = (float)(s->top_m - camera_m[1]);
    low[3] = (float)s->height_m;
    slant[2] = walls->spread;
    slant[3] = (float)(1 / SIDE_M);
}

void host_shelter_frame(const host_shelter *s, const virga_walls *walls, const double camera_m[3],
                        struct host_frame_gpu *frame)
{
    host_shelter_coordinates(s, walls, camera_m, frame->shelter_low, frame->shelter_slant);
    for (uint32_t row = 0; row < VIRGA_WALL_ROWS; row++)
        for (uint32_t i = 0; i < HOST_WALL_MATERIALS; i++) {
            const virga_wall_gpu *from = &walls->rows[row][i];
            const float to[4] = {from->wet, from->film_mm, from->run_mm_h, from->fall_mm_h};
            memcpy(frame->walls[row * HOST_WALL_MATERIALS + i], to, sizeof to);
        }
}
