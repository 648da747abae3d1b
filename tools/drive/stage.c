/* stage.c - frames, draws and descriptors of the sample's renderer. Passes and pipelines: stage_passes.c; the window's
 * images: stage_images.c. */
#include "stage_internal.h"

#include "camera.h"

#include <math.h>
#include <string.h>

#define NEAR_M 0.05
#define FAR_M  900.0

/* ---- cameras */

void stage_camera_set(const stage *s, stage_camera *camera)
{
    const double *f = camera->forward, *u = camera->up;
    const double right[3] = {f[1] * u[2] - f[2] * u[1], f[2] * u[0] - f[0] * u[2], f[0] * u[1] - f[1] * u[0]};
    memset(camera->view_from_world, 0, sizeof camera->view_from_world);
    memset(camera->clip_from_view, 0, sizeof camera->clip_from_view);
    for (int i = 0; i < 3; i++) { /* column i: the world's axis i in view space */
        camera->view_from_world[4 * i] = (float)right[i];
        camera->view_from_world[4 * i + 1] = (float)u[i];
        camera->view_from_world[4 * i + 2] = (float)-f[i];
    }
    camera->view_from_world[15] = 1;
    const double scale = 1 / tan(camera->fov_deg * M_PI / 360), aspect = s->height ? (double)s->width / s->height : 1;
    camera->clip_from_view[0] = (float)(scale / aspect);
    camera->clip_from_view[5] = (float)-scale; /* Vulkan's y points down */
    camera->clip_from_view[10] = (float)(FAR_M / (NEAR_M - FAR_M));
    camera->clip_from_view[11] = -1;
    camera->clip_from_view[14] = (float)(NEAR_M * FAR_M / (NEAR_M - FAR_M));
}

/* ---- uniforms */

static void fill_camera(const stage *s, const stage_camera *camera, struct drive_frame_gpu *to)
{
    const stage_camera *last = s->has_last ? &s->last : camera;
    host_matrix_multiply(camera->clip_from_view, camera->view_from_world, to->clip_from_relative);
    float rotated[16], moved[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (int i = 0; i < 3; i++)
        moved[12 + i] = to->moved[i] = (float)(camera->position_m[i] - last->position_m[i]);
    host_matrix_multiply(last->clip_from_view, last->view_from_world, rotated);
    host_matrix_multiply(rotated, moved, to->last_from_relative);
    for (int i = 0; i < 3; i++) {
        to->ray_x[i] = camera->view_from_world[4 * i] / camera->clip_from_view[0];
        to->ray_y[i] = camera->view_from_world[4 * i + 1] / camera->clip_from_view[5];
        to->ray_z[i] = -camera->view_from_world[4 * i + 2];
    }
}

static void fill_ground(const stage_camera *camera, const virga_ground_maps *maps, struct drive_frame_gpu *to)
{
    for (int axis = 0; axis < 2; axis++) {
        const double cell = floor(maps->low_m[axis] / (double)maps->cell_m + 0.5),
                     position = camera->position_m[2 * axis];
        to->ground_low[2 * axis] = (float)(maps->low_m[axis] - position);
        to->ground_wrap[axis] = (float)(cell - floor(cell / maps->cells) * maps->cells);
        to->ground_far[2 * axis] = (float)(maps->far_low_m[axis] - position);
        to->ripples[axis] = (float)(maps->ripple_low_m[axis] - position);
    }
    to->ground_wrap[3] = maps->reach_m / maps->cell_m;
    to->ground_far[1] = 1 / maps->far_cell_m;
    to->ground_far[3] = (float)maps->far_cells;
    to->ground_low[1] = (float)((double)maps->base_m - camera->position_m[1]);
    to->ground_low[3] = 1 / maps->cell_m;
    to->ground_wrap[2] = (float)maps->cells;
    to->ripples[2] = 1 / ((float)maps->ripple_texels * maps->ripple_texel_m);
}

static void fill_lights(const stage_camera *camera, const virga_lighting *lighting, struct drive_frame_gpu *to)
{
    to->moved[3] = (float)lighting->light_count;
    for (uint32_t i = 0; i < lighting->light_count && i < DRIVE_LIGHTS; i++) {
        const virga_light *light = &lighting->lights[i];
        struct drive_light_gpu *l = &to->lights[i];
        const float length =
            sqrtf(light->direction[0] * light->direction[0] + light->direction[1] * light->direction[1] +
                  light->direction[2] * light->direction[2]);
        for (int c = 0; c < 3; c++) {
            l->position[c] = (float)(light->position_m[c] - camera->position_m[c]);
            l->intensity[c] = light->intensity[c];
            l->direction[c] = length > 0 ? light->direction[c] / length : 0;
        }
        l->position[3] = light->range_m > 0 ? 1 / light->range_m : 0;
        l->cone[0] = length > 0 ? 1 / fmaxf(light->cos_inner - light->cos_outer, 1e-4f) : 0;
        l->cone[1] = length > 0 ? -light->cos_outer * l->cone[0] : 1;
    }
}

/* Irradiance over pi from the harmonics of radiance: the bands times 1, 2/3 and 1/4 (Ramamoorthi and Hanrahan 2001),
 * times the factors of the basis. */
static void fill_sky(const float sh[9][3], struct drive_frame_gpu *to)
{
    static const float factors[9] = {0.282095f,         0.488603f * 2 / 3, 0.488603f * 2 / 3,
                                     0.488603f * 2 / 3, 1.092548f / 4,     1.092548f / 4,
                                     0.315392f / 4,     1.092548f / 4,     0.546274f / 4};
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            to->irradiance[i][c] = sh[i][c] * factors[i];
}

/* Rows of the transform into the shade's frame: 1 at its ends, and metres above the ground. */
static void fill_shade(const stage_camera *camera, const stage_shade *shade, struct drive_frame_gpu *to)
{
    const float scales[3] = {shade->half_m[0], 1, shade->half_m[1]};
    for (int row = 0; row < 3; row++) {
        double at = 0;
        for (int i = 0; i < 3 && scales[row] > 0; i++) {
            to->shade[row][i] = shade->axes[3 * row + i] / scales[row];
            at += (double)to->shade[row][i] * (camera->position_m[i] - shade->position_m[i]);
        }
        to->shade[row][3] = scales[row] > 0 ? (float)at : 1e3f;
    }
}

/* ---- walls */

static void fill_walls(const stage *s, const stage_camera *camera, const virga_walls *walls, struct drive_frame_gpu *to)
{
    host_shelter_coordinates(&s->shelter, walls, camera->position_m, to->shelter_low, to->shelter_slant);
    for (uint32_t row = 0; row < DRIVE_WALL_ROWS; row++)
        for (uint32_t i = 0; i < DRIVE_WALL_MATERIALS; i++)
            memcpy(to->walls[row * DRIVE_WALL_MATERIALS + i], &walls->rows[row][i], sizeof(virga_wall_gpu));
}

/* Leaves let rain through, soon as drips. */
void stage_shelter(stage *s, VkCommandBuffer cmd, const stage_camera *camera, const virga_walls *walls,
                   const host_mesh *mesh)
{
    host_camera at = {.position_m = {camera->position_m[0], camera->position_m[1], camera->position_m[2]}};
    struct drive_surface_gpu surface = {.base_color = {0}};
    const VkDeviceSize zero = 0;
    memcpy(at.view_from_world, camera->view_from_world, sizeof at.view_from_world);
    if (!host_shelter_place(&s->shelter, walls, &at, (double)mesh->low[1], (double)mesh->high[1]))
        return;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++)
            surface.from_mesh[row][column] = s->shelter.map_from_world[4 * column + row];
    host_shelter_begin(&s->shelter, cmd, s->shelter_pass);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, s->shelter_pipeline);
    vkCmdBindVertexBuffers(cmd, 0, 1, &mesh->vertices.buffer, &zero);
    vkCmdBindIndexBuffer(cmd, mesh->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    vkCmdPushConstants(cmd, s->world.layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof surface, &surface);
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const host_primitive *primitive = &mesh->primitives[i];
        if (mesh->materials[primitive->material].alpha != HOST_ALPHA_MASK)
            vkCmdDrawIndexed(cmd, primitive->index_count, 1, primitive->first_index, 0, 0);
    }
    host_shelter_end(&s->shelter, cmd);
}

/* ---- a frame */

static uint32_t slot(const stage *s)
{
    return (uint32_t)(s->device->frame % HOST_FRAMES);
}

static void begin_pass(VkCommandBuffer cmd, VkRenderPass pass, VkFramebuffer framebuffer, const stage *s)
{
    host_pass_begin(cmd, pass, framebuffer, s->width, s->height, 1);
}

bool stage_begin(stage *s, VkCommandBuffer *cmd, bool *resized, char *error, size_t error_size)
{
    *cmd = NULL;
    *resized = false;
    if (!stage_images_fit(s, resized, error, error_size))
        return false;
    if (*resized || !s->width)
        return true;
    /* Waits until the slot of the ring is free, so that its semaphore can be used again. */
    if (!host_begin_frame(s->device, cmd, error, error_size))
        return false;
    if (!s->window)
        return true;
    const VkResult got = vkAcquireNextImageKHR(s->device->device, s->swapchain, UINT64_MAX, s->acquired[slot(s)],
                                               VK_NULL_HANDLE, &s->image);
    if (got == VK_SUCCESS || got == VK_SUBOPTIMAL_KHR)
        return true;
    *cmd = NULL;
    if (got != VK_ERROR_OUT_OF_DATE_KHR)
        return host_fail(error, error_size, "vkAcquireNextImageKHR gave %s", host_result_name(got));
    return host_submit(s->device, error, error_size) && stage_images_again(s, resized, error, error_size);
}

/* At the start and after a cut there are no reflections: 1 / distance is 0. */
static void clear_behind(const stage *s, VkCommandBuffer cmd)
{
    const VkPipelineStageFlags readers = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    const VkClearColorValue nothing = {.float32 = {0, 0, 0, 0}};
    const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    host_image_barrier(cmd, &s->behind, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, readers, 0,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdClearColorImage(cmd, s->behind.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &nothing, 1, &all);
    host_image_barrier(cmd, &s->behind, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, readers,
                       VK_ACCESS_SHADER_READ_BIT);
}

void stage_world_begin(stage *s, VkCommandBuffer cmd, const stage_camera *camera, const virga_ground_maps *maps,
                       const virga_walls *walls, const virga_lighting *lighting)
{
    struct drive_frame_gpu *to = s->uniforms[slot(s)].mapped;
    memset(to, 0, sizeof *to);
    fill_camera(s, camera, to);
    fill_ground(camera, maps, to);
    fill_lights(camera, lighting, to);
    fill_walls(s, camera, walls, to);
    fill_sky(lighting->environment_sh, to);
    fill_shade(camera, &s->shade, to);
    if (!s->has_last)
        clear_behind(s, cmd);
    begin_pass(cmd, s->world_pass, s->world_framebuffer, s);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, s->world.layout, 0, 1, &s->world.sets[slot(s)], 0,
                            NULL);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, s->sky_pipeline);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, s->world_pipeline);
}

static void fill_transform(const stage_camera *camera, const stage_draw *draw, struct drive_surface_gpu *surface)
{
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            surface->from_mesh[row][column] = draw->axes[3 * column + row];
        surface->from_mesh[row][3] = (float)(draw->position_m[row] - camera->position_m[row]);
    }
}

static void fill_material(const host_material *material, float sky, struct drive_surface_gpu *surface)
{
    memcpy(surface->base_color, material->base_color, sizeof surface->base_color);
    memcpy(surface->emissive, material->emissive, sizeof material->emissive);
    surface->emissive[3] = material->roughness;
    surface->traits[0] = material->metallic;
    surface->traits[1] = material->alpha == HOST_ALPHA_MASK ? material->cutoff : -1;
    surface->traits[2] = sky;
}

/* Draws either the primitives of glass or all others. */
static void draw_primitives(const stage *s, VkCommandBuffer cmd, const stage_draw *draw, const VkDescriptorSet *sets,
                            bool glass, struct drive_surface_gpu *surface)
{
    for (uint32_t i = 0; i < draw->mesh->primitive_count; i++) {
        const host_primitive *primitive = &draw->mesh->primitives[i];
        const host_material *material = &draw->mesh->materials[primitive->material];
        const float sky = draw->skies ? draw->skies[i] : draw->sky, through = 1 - material->base_color[3];
        if (sky < 0 || (material->alpha == HOST_ALPHA_GLASS) != glass)
            continue;
        fill_material(material, sky, surface);
        surface->traits[3] =
            primitive->ground ? (float)(1 + primitive->surface) : (float)(-1 - host_wall_material(primitive, material));
        if (glass)
            vkCmdSetBlendConstants(cmd, (const float[4]){through, through, through, 0});
        vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, s->world.layout, 1, 1, &sets[primitive->material],
                                0, NULL);
        vkCmdPushConstants(cmd, s->world.layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                           sizeof *surface, surface);
        vkCmdDrawIndexed(cmd, primitive->index_count, 1, primitive->first_index, 0, 0);
    }
}

void stage_draw_mesh(stage *s, VkCommandBuffer cmd, const stage_camera *camera, const stage_draw *draw)
{
    const host_mesh *mesh = draw->mesh;
    const VkDescriptorSet *sets = NULL;
    const VkDeviceSize zero = 0;
    for (uint32_t i = 0; i < s->mesh_count; i++)
        sets = s->meshes[i].mesh == mesh ? s->meshes[i].sets : sets;
    if (!sets)
        return;
    struct drive_surface_gpu surface;
    fill_transform(camera, draw, &surface);
    vkCmdBindVertexBuffers(cmd, 0, 1, &mesh->vertices.buffer, &zero);
    vkCmdBindIndexBuffer(cmd, mesh->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    draw_primitives(s, cmd, draw, sets, false, &surface);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, s->glass_pipeline);
    draw_primitives(s, cmd, draw, sets, true, &surface);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, s->world_pipeline);
}

/* Copies `color`, which is in the layout for copies. */
static void copy_color(stage *s, VkCommandBuffer cmd, const host_image *to)
{
    const VkPipelineStageFlags readers = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    host_image_barrier(cmd, to, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, readers, 0,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    VkImageCopy whole = {
        .srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .extent = {s->width, s->height, 1},
    };
    vkCmdCopyImage(cmd, s->color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to->image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole);
    host_image_barrier(cmd, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, readers,
                       VK_ACCESS_SHADER_READ_BIT);
}

/* The pass leaves `color` in the layout for copies. */
void stage_world_end(stage *s, VkCommandBuffer cmd)
{
    vkCmdEndRenderPass(cmd);
    copy_color(s, cmd, &s->behind);
}

void stage_sampled(stage *s, VkCommandBuffer cmd)
{
    const VkPipelineStageFlags readers = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    host_image_barrier(cmd, &s->color, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       readers, 0, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
}

void stage_through(stage *s, VkCommandBuffer cmd)
{
    host_image_barrier(cmd, &s->color, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    copy_color(s, cmd, &s->through);
}

void stage_over_begin(stage *s, VkCommandBuffer cmd)
{
    begin_pass(cmd, s->over_pass, s->over_framebuffer, s);
}

void stage_over_end(stage *s, VkCommandBuffer cmd)
{
    (void)s;
    vkCmdEndRenderPass(cmd);
}

static void show(stage *s, VkCommandBuffer cmd, bool keep)
{
    begin_pass(cmd, s->show_pass, s->slices[s->image].framebuffer, s);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, s->show_pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, s->show.layout, 0, 1, s->show.sets, 0, NULL);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
    if (s->window || !keep)
        return;
    VkBufferImageCopy whole = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                               .imageExtent = {s->width, s->height, 1}};
    vkCmdCopyImageToBuffer(cmd, s->picture.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, s->copy.buffer, 1, &whole);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
}

bool stage_end(stage *s, VkCommandBuffer cmd, const stage_camera *camera, bool keep, char *error, size_t error_size)
{
    show(s, cmd, keep);
    s->last = *camera;
    s->has_last = true;
    if (!s->window)
        return host_submit(s->device, error, error_size);
    if (!host_submit_for_window(s->device, s->acquired[slot(s)], s->finished[s->image], error, error_size))
        return false;
    VkPresentInfoKHR present = {
        .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
        .waitSemaphoreCount = 1,
        .pWaitSemaphores = &s->finished[s->image],
        .swapchainCount = 1,
        .pSwapchains = &s->swapchain,
        .pImageIndices = &s->image,
    };
    const VkResult shown = vkQueuePresentKHR(s->device->queue, &present);
    if (shown == VK_SUCCESS || shown == VK_SUBOPTIMAL_KHR || shown == VK_ERROR_OUT_OF_DATE_KHR)
        return true; /* the next stage_begin creates a new swapchain */
    return host_fail(error, error_size, "vkQueuePresentKHR gave %s", host_result_name(shown));
}

const uint8_t *stage_picture(stage *s)
{
    host_buffer_invalidate(s->device, &s->copy);
    return s->copy.mapped;
}

/* ---- descriptors */

void stage_bind(stage *s, const virga_ground_maps *maps, const host_environment *environment)
{
    const VkImageLayout read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, general = VK_IMAGE_LAYOUT_GENERAL;
    const VkSampler nearest = s->samplers[HOST_SAMPLE_NEAREST], linear = s->samplers[HOST_SAMPLE_LINEAR];
    const VkSampler repeat = s->samplers[HOST_SAMPLE_TEXTURE];
    for (uint32_t i = 0; i < HOST_FRAMES; i++) {
        const VkDescriptorSet set = s->world.sets[i];
        host_set_write_buffer(s->device, set, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, s->uniforms[i].buffer);
        host_set_write_image(s->device, set, 1, repeat, environment->sky.view, read);
        host_set_write_image(s->device, set, 2, linear, environment->reflection.view, read);
        host_set_write_image(s->device, set, 3, nearest, maps->wetness, general);
        host_set_write_image(s->device, set, 4, nearest, maps->spots, general);
        host_set_write_image(s->device, set, 5, linear, maps->ripples, general);
        host_set_write_image(s->device, set, 6, linear, s->behind.view, read);
        host_set_write_image(s->device, set, 7, nearest, maps->far_wetness, general);
        host_set_write_image(s->device, set, 8, nearest, s->shelter.map.view,
                             VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    }
    host_set_write_image(s->device, s->show.sets[0], 0, nearest, s->color.view, read);
}

bool stage_add(stage *s, const host_mesh *mesh, char *error, size_t error_size)
{
    if (s->mesh_count == STAGE_MESHES || mesh->material_count > 64)
        return host_fail(error, error_size, "more than %d meshes, or 64 materials in one", STAGE_MESHES);
    VkDescriptorSet *sets = s->meshes[s->mesh_count].sets;
    if (!host_sets_allocate(s->device, s->material_pool, s->material_layout, mesh->material_count, sets, error,
                            error_size))
        return false;
    for (uint32_t i = 0; i < mesh->material_count; i++) {
        const host_material *material = &mesh->materials[i];
        const int32_t textures[2] = {material->base_texture, material->emissive_texture};
        for (uint32_t k = 0; k < 2; k++) {
            const VkImageView view = textures[k] >= 0 ? mesh->textures[textures[k]].view : s->white.view;
            host_set_write_image(s->device, sets[i], k, s->samplers[HOST_SAMPLE_TEXTURE], view,
                                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        }
    }
    s->meshes[s->mesh_count++].mesh = mesh;
    return true;
}
