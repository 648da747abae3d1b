/* picture.c - one full-screen pass over the outputs of the shot, and drops on the flat map of a pane. */
#include "view/picture.h"

#include <math.h>
#include <string.h>

#include "view_pane_drops_frag.spv.h"
#include "view_pane_drops_vert.spv.h"
#include "view_view_frag.spv.h"
#include "view_view_vert.spv.h"

/* In the order of view_common.glsl. */
enum {
    AT_VIEW,
    AT_COLOR,
    AT_SPLASH,
    AT_RAIN,
    AT_GLASS,
    AT_REFRACTION,
    AT_NORMAL,
    AT_VELOCITY,
    AT_WATER,
    AT_ID,
    AT_DEPTH,
    AT_OCCLUSION,
    AT_HEIGHTS,
    AT_FLOORS,
    AT_CELLS,
    AT_SURFACE,
    AT_DROPS,
    BINDINGS,
};

static const host_output output_at[] = {
    [AT_COLOR] = HOST_COLOR,       [AT_SPLASH] = HOST_SPLASH,         [AT_RAIN] = HOST_LAYER,
    [AT_GLASS] = HOST_GLASS,       [AT_REFRACTION] = HOST_REFRACTION, [AT_NORMAL] = HOST_NORMAL,
    [AT_VELOCITY] = HOST_VELOCITY, [AT_WATER] = HOST_WATER,           [AT_ID] = HOST_ID,
    [AT_DEPTH] = HOST_DEPTH};

/* ---- pipelines */

static bool create_sets(view_picture *p, char *error, size_t error_size)
{
    const VkShaderStageFlags seen = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    VkDescriptorType types[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; i++)
        types[i] = i == AT_VIEW      ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                   : i <= AT_HEIGHTS ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                     : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const host_set_shape shape = {types, BINDINGS, seen};
    for (uint32_t i = 0; i < HOST_FRAMES; i++)
        if (!host_buffer_create(p->device, sizeof(struct view_gpu), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                HOST_BUFFER_UPLOAD, "view", &p->uniforms[i], error, error_size))
            return false;
    return host_set_layout_create(p->device, &shape, &p->set_layout, error, error_size) &&
           host_set_pool_create(p->device, &shape, HOST_FRAMES, &p->pool, error, error_size) &&
           host_sets_allocate(p->device, p->pool, p->set_layout, HOST_FRAMES, p->sets, error, error_size) &&
           host_pipeline_layout_create(p->device, &p->set_layout, 1, VK_SHADER_STAGE_VERTEX_BIT, 8, &p->layout, error,
                                       error_size);
}

static bool create_samplers(view_picture *p, char *error, size_t error_size)
{
    VkFormatProperties about;
    vkGetPhysicalDeviceFormatProperties(p->device->physical, VK_FORMAT_R32G32B32A32_SFLOAT, &about);
    const bool filtered = about.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    return host_sampler_create(p->device, HOST_SAMPLE_NEAREST, &p->nearest, error, error_size) &&
           host_sampler_create(p->device, filtered ? HOST_SAMPLE_LINEAR : HOST_SAMPLE_NEAREST, &p->linear, error,
                               error_size);
}

/* What stands for outputs that a scene has not. */
static bool create_blanks(view_picture *p, char *error, size_t error_size)
{
    const uint8_t zero[64] = {0};
    const host_image_def def = {.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {1, 1, 1}, .name = "blank"};
    if (!host_image_create_with(p->device, &def, zero, 4, 4, &p->blank, error, error_size))
        return false;
    /* An array of one layer cannot be told from a plain image by its definition; its view is made here. */
    const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = p->blank.image,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY,
                                        .format = def.format,
                                        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    HOST_TRY(vkCreateImageView(p->device->device, &view, NULL, &p->blank_array.view));
    return host_buffer_create_with(p->device, zero, sizeof zero, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "blank",
                                   &p->blank_buffer, error, error_size);
}

/* Triangles without vertex buffers, into one color, as they are. */
static bool build(const view_picture *p, VkRenderPass pass, host_code vertex, host_code fragment, VkPipeline *pipeline,
                  char *error, size_t error_size)
{
    const host_graphics_def def = {.vertex = vertex,
                                   .fragment = fragment,
                                   .layout = p->layout,
                                   .pass = pass,
                                   .colors = &host_blend_replace,
                                   .color_count = 1};
    return host_graphics_create(p->device, &def, pipeline, error, error_size);
}

bool view_picture_create(host_device *device, const view_window *window, view_picture *p, char *error,
                         size_t error_size)
{
    memset(p, 0, sizeof *p);
    p->device = device;
    return create_samplers(p, error, error_size) && create_blanks(p, error, error_size) &&
           create_sets(p, error, error_size) &&
           build(p, window->pass, HOST_CODE(view_view_vert), HOST_CODE(view_view_frag), &p->picture, error,
                 error_size) &&
           build(p, window->pass, HOST_CODE(view_pane_drops_vert), HOST_CODE(view_pane_drops_frag), &p->drops, error,
                 error_size);
}

void view_picture_destroy(view_picture *p)
{
    if (!p->device)
        return;
    const VkDevice device = p->device->device;
    vkDestroyPipeline(device, p->drops, NULL);
    vkDestroyPipeline(device, p->picture, NULL);
    vkDestroyPipelineLayout(device, p->layout, NULL);
    vkDestroyDescriptorPool(device, p->pool, NULL);
    vkDestroyDescriptorSetLayout(device, p->set_layout, NULL);
    vkDestroySampler(device, p->nearest, NULL);
    vkDestroySampler(device, p->linear, NULL);
    vkDestroyImageView(device, p->blank_array.view, NULL);
    host_image_destroy(p->device, &p->blank);
    host_buffer_destroy(p->device, &p->blank_buffer);
    for (uint32_t i = 0; i < HOST_FRAMES; i++)
        host_buffer_destroy(p->device, &p->uniforms[i]);
    memset(p, 0, sizeof *p);
}

/* ---- what the shaders are told */

static const shot_pane *pane_of(const shot *s, const view_shown *shown)
{
    const bool flat = shown->mode == VIEW_PANE || shown->mode == VIEW_PANE_HEIGHT;
    if (!scene_glass_of(s->scene)->pane_count)
        return NULL;
    return &s->panes[flat && shown->layer < scene_glass_of(s->scene)->pane_count ? shown->layer : 0];
}

static void fill_camera(const host_camera *camera, struct view_gpu *out)
{
    const float *p = camera->clip_from_view, *v = camera->view_from_world;
    out->projection[0] = p[0];
    out->projection[1] = p[5];
    out->projection[2] = p[10];
    out->projection[3] = p[14];
    out->jitter[0] = p[8];
    out->jitter[1] = p[9];
    for (int axis = 0; axis < 3; axis++) {
        out->right[axis] = v[4 * axis];
        out->up[axis] = v[4 * axis + 1];
        out->back[axis] = v[4 * axis + 2];
    }
}

static void fill_ground(const shot *s, const host_camera *camera, uint32_t mode, struct view_gpu *out)
{
    virga_ground_cells cells;
    virga_ground_maps maps;
    virga_ground_cells_get(s->ground, &cells);
    virga_ground_maps_get(s->ground, &maps);
    for (uint32_t i = 0; i < VIEW_PALETTE; i++)
        view_mode_legend(mode, i, out->palette[i]);
    if (!s->ground)
        return;
    const virga_ground_settings settings = virga_default_ground_settings(); /* as the shot has them */
    const double area = (double)maps.cell_m * (double)maps.cell_m;
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++)
        out->capacity[i / 4][i % 4] = (uint32_t)floor((double)settings.materials[i].capacity_mm * area * 1e9 + 0.5);
    out->ground[0] = (float)(maps.low_m[0] - camera->position_m[0]);
    out->ground[1] = (float)(maps.low_m[1] - camera->position_m[2]);
    out->ground[2] = 1 / maps.cell_m;
    out->ground[3] = (float)maps.cells;
    out->jitter[2] = (float)(camera->position_m[1] - (double)cells.base_m);
    out->cells[0] = cells.low_tile[0];
    out->cells[1] = cells.low_tile[1];
    out->cells[2] = (int32_t)cells.tiles;
    out->cells[3] = (int32_t)cells.nl_per_um;
}

/* Both ends of a blade at a time, as the library places it. */
static void place_blade(const scene_wiper *from, const virga_glass_wiper *wiper, double time_s, float ends[4])
{
    const double arm_deg = from->drive == SCENE_WIPER_KEYS ? scene_wiper_angle_deg(from, time_s)
                                                           : virga_glass_wiper_deg(wiper, fmax(time_s, 0));
    const double arm = arm_deg * M_PI / 180, hub = from->reach_m - 0.5 * from->blade_m;
    const double blade = (arm_deg + from->blade_deg - from->blade_turn * (arm_deg - from->low_deg)) * M_PI / 180;
    for (int end = 0; end < 2; end++) {
        const double way = (end - 0.5) * from->blade_m;
        ends[2 * end] = (float)(from->pivot_m[0] + hub * cos(arm) + way * cos(blade));
        ends[2 * end + 1] = (float)(from->pivot_m[1] + hub * sin(arm) + way * sin(blade));
    }
}

static void fill_pane(const shot *s, const shot_pane *pane, struct view_gpu *out)
{
    const scene_pane *from = pane->from;
    const virga_glass_settings *now = &pane->settings;
    const double angle = 0.5 * ((double)now->advancing_deg + (double)now->receding_deg) * M_PI / 180, c = cos(angle);
    virga_glass_map heights;
    virga_glass_surface(pane->glass, NULL, &out->pane_cells[0], &out->pane_cells[1]);
    virga_glass_map_get(pane->glass, &heights);
    out->pane[0] = (float)from->width_m;
    out->pane[1] = (float)from->height_m;
    out->pane[2] = (float)from->width_m / (float)out->pane_cells[0];
    out->pane[3] = (float)(from->band * 2 * from->particle_mm * 1e-3);
    /* Water of a cap on a base with a radius of 1 m, by its contact angle. */
    out->pane_drop[0] = (float)(1e12 * M_PI * (2 - 3 * c + c * c * c) / (3 * pow(sin(angle), 3)));
    out->pane_drop[1] = (float)(from->particle_mm * 1e-3);
    out->pane_cells[2] = from->wiper_count;
    for (uint32_t i = 0; i < from->wiper_count && i < VIEW_BLADES; i++)
        place_blade(&from->wipers[i], &now->wipers[i], s->camera_time_s, out->blades[i]);
    out->height_map[0] = (float)heights.columns;
    out->height_map[1] = (float)heights.rows;
    out->height_map[2] = now->threshold;
}

static void fill(const shot *s, const host_camera *camera, const view_shown *shown, struct view_gpu *out)
{
    virga_rain_occlusion_map map;
    virga_glass_map heights = {0};
    const shot_pane *pane = pane_of(s, shown);
    memset(out, 0, sizeof *out);
    virga_rain_occlusion_map_get(s->rain, &map);
    memcpy(out->area, shown->area, sizeof out->area);
    out->picture[0] = (float)s->target.width;
    out->picture[1] = (float)s->target.height;
    out->picture[2] = exp2f(shown->exposure_ev);
    out->picture[3] = 20; /* pixels a frame that show in full */
    out->heights[0] = (float)map.top_m;
    out->heights[1] = map.height_m;
    out->heights[2] = (float)camera->position_m[1] - 4;
    fill_camera(camera, out);
    fill_ground(s, camera, shown->mode, out);
    if (pane) {
        fill_pane(s, pane, out);
        virga_glass_map_get(pane->glass, &heights);
    }
    out->mode[0] = shown->mode;
    out->mode[1] = shown->layer;
    out->mode[2] = (s->splash ? 1u : 0u) | (pane ? 2u : 0u) | (s->ground ? 4u : 0u) | (map.depth ? 8u : 0u) |
                   (heights.view ? 16u : 0u);
}

/* ---- descriptors */

/* A storage buffer, or what stands for it. */
static void write_buffer(const view_picture *p, VkDescriptorSet set, uint32_t binding, VkBuffer buffer)
{
    host_set_write_buffer(p->device, set, binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                          buffer ? buffer : p->blank_buffer.buffer);
}

static void write_outputs(const view_picture *p, const shot *s, VkDescriptorSet set)
{
    for (uint32_t i = AT_COLOR; i <= AT_DEPTH; i++) {
        const host_image *image = &s->target.images[output_at[i]];
        const bool smooth = i <= AT_GLASS;
        host_set_write_image(
            p->device, set, i, smooth ? p->linear : p->nearest, image->image ? image->view : p->blank.view,
            i == AT_DEPTH ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
}

static void write_set(const view_picture *p, const shot *s, const view_shown *shown, VkDescriptorSet set,
                      const host_buffer *uniforms)
{
    const VkImageLayout read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const shot_pane *pane = pane_of(s, shown);
    virga_rain_occlusion_map map;
    virga_ground_cells cells;
    virga_glass_map heights = {0};
    virga_glass_buffer surface = {0}, drops = {0};
    virga_rain_occlusion_map_get(s->rain, &map);
    virga_ground_cells_get(s->ground, &cells);
    if (pane) {
        virga_glass_map_get(pane->glass, &heights);
        virga_glass_surface(pane->glass, &surface, NULL, NULL);
        virga_glass_drops(pane->glass, &drops, NULL);
    }
    host_set_write_buffer(p->device, set, AT_VIEW, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, uniforms->buffer);
    write_outputs(p, s, set);
    host_set_write_image(p->device, set, AT_OCCLUSION, p->nearest, map.depth ? map.depth : p->blank_array.view,
                         map.depth ? map.layout : read);
    host_set_write_image(p->device, set, AT_HEIGHTS, p->nearest, heights.view ? heights.view : p->blank.view,
                         heights.view ? VK_IMAGE_LAYOUT_GENERAL : read);
    write_buffer(p, set, AT_FLOORS, cells.floors);
    write_buffer(p, set, AT_CELLS, cells.cells);
    write_buffer(p, set, AT_SURFACE, surface.buffer);
    write_buffer(p, set, AT_DROPS, drops.buffer);
}

/* ---- recording */

/* Outputs that the plate and layer passes left to be copied. */
static void make_readable(VkCommandBuffer cmd, const shot *s)
{
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++)
        if (i != HOST_COLOR && i != HOST_DEPTH && s->target.images[i].image)
            host_image_barrier(cmd, &s->target.images[i], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, drawing, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                               VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
}

void view_picture_begin(VkCommandBuffer cmd)
{
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                         VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                             VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                             VK_PIPELINE_STAGE_TRANSFER_BIT,
                         0, 0, NULL, 0, NULL, 0, NULL);
}

void view_picture_prepare(view_picture *p, VkCommandBuffer cmd, const shot *s, const host_camera *camera,
                          const view_shown *shown)
{
    const uint32_t slot = (uint32_t)(p->device->frame % HOST_FRAMES);
    fill(s, camera, shown, p->uniforms[slot].mapped);
    write_set(p, s, shown, p->sets[slot], &p->uniforms[slot]);
    make_readable(cmd, s);
    host_memory_barrier(
        cmd,
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT |
            VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
        VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
        VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
}

void view_picture_draw(const view_picture *p, VkCommandBuffer cmd, const shot *s, const view_window *window,
                       const view_shown *shown)
{
    const uint32_t slot = (uint32_t)(p->device->frame % HOST_FRAMES);
    const shot_pane *pane = pane_of(s, shown);
    const float size[2] = {(float)window->width, (float)window->height};
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, p->layout, 0, 1, &p->sets[slot], 0, NULL);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, p->picture);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    if (shown->mode != VIEW_PANE || !pane)
        return;
    uint32_t places;
    virga_glass_drops(pane->glass, NULL, &places);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, p->drops);
    vkCmdPushConstants(cmd, p->layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof size, size);
    vkCmdDraw(cmd, 6 * places, 1, 0, 0);
}
