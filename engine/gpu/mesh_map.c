/* gpu/mesh_map.c - renders the host's meshes from above along parallel lines: height, normal and material of the first
 * surface. Rain uses it for occlusion, ground for the surfaces that get wet. */
#include "gpu/mesh_map.h"
#include "core/log.h"

#include "core/settings.h"
#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/layouts.h"
#include "gpu/pipelines.h"
#include "gpu/record.h"
#include "gpu/retire.h"
#include "shaders/gpu_shaders.h"

#include <virga/shared/mesh_map.h>

#include <math.h>

static void mesh_map_destroy(virga_context *context, virga_resource *resource)
{
    virga_mesh_map *map = (virga_mesh_map *)resource;
    virga_layout_release(context, map->layout);
    virga_free(&context->heap, map);
}

void virga_mesh_map_retire(virga_context *context, virga_mesh_map **map)
{
    if (!*map)
        return;
    for (uint32_t i = 0; i < 2 * VIRGA_MAP_STRIDES; i++)
        VIRGA_RETIRE(context, (*map)->pipelines[i / VIRGA_MAP_STRIDES][i % VIRGA_MAP_STRIDES]);
    virga_offscreen_retire(context, &(*map)->images);
    VIRGA_RETIRE(context, *map);
}

static virga_result create_images(virga_context *context, virga_mesh_map *map)
{
    const VkImageUsageFlags copies = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    const VkPipelineStageFlags copy_stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const virga_offscreen_def def = {.name = map->name,
                                     .extent = {map->size, map->size},
                                     .layers = map->keeps ? 2 * map->layers : map->layers,
                                     .colors = {VK_FORMAT_R32_UINT},
                                     .depth = VK_FORMAT_D32_SFLOAT,
                                     .color_usage = map->keeps ? copies : 0,
                                     .depth_usage = map->keeps ? copies : 0,
                                     .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                     .readers = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | (map->keeps ? copy_stage : 0)};
    return virga_offscreen_create(context, &def, &map->images);
}

static virga_result create_pipelines(virga_context *context, virga_pipeline_group *group, virga_mesh_map *map)
{
    virga_result result = VIRGA_OK;
    TRY(virga_layout_hold(context, NULL, 0, sizeof(virga_map_push), &map->layout));
    virga_graphics_def def = {.vertex = VIRGA_SPIRV(gpu_mesh_map_vert),
                              .fragment = VIRGA_SPIRV(gpu_mesh_map_frag),
                              .layout = map->layout,
                              .render_pass = map->images->pass,
                              .pass_class = VIRGA_PASS_OF_MESH_MAPS,
                              .color_count = 1,
                              .depth_test = true,
                              .depth_write = true,
                              .group = group,
                              .name = map->name};
    for (def.constant = 0; def.constant < 2; def.constant++)
        for (uint32_t i = 0; i < VIRGA_MAP_STRIDES; i++) {
            def.vertex_stride = map->strides[i];
            if (map->strides[i])
                TRY(virga_graphics_pipeline_create(context, &def, &map->pipelines[def.constant][i]));
        }
error:
    return result;
}

VkDeviceSize virga_mesh_map_bytes(uint32_t size, uint32_t layers)
{
    const VkDeviceSize texels = size ? (VkDeviceSize)size * size * layers : 1;
    return texels * 8; /* depth and surface */
}

virga_result virga_mesh_map_check_strides(const virga_log *log, const char *name,
                                          const uint32_t strides[VIRGA_MAP_STRIDES])
{
    for (int i = 0; i < VIRGA_MAP_STRIDES; i++)
        if (strides[i] && (strides[i] < 12 || strides[i] % 4))
            return virga_wrong_argument(log, "%s: expected multiples of 4 from 12, got %u", name, strides[i]);
    return VIRGA_OK;
}

virga_result virga_mesh_map_create(virga_context *context, uint32_t size, uint32_t layers, bool keeps,
                                   const uint32_t strides[VIRGA_MAP_STRIDES], const char *name,
                                   virga_pipeline_group *group, virga_mesh_map **map)
{
    virga_result result = VIRGA_OK;
    const uint32_t max = context->properties.limits.maxVertexInputBindingStride;
    for (uint32_t i = 0; i < VIRGA_MAP_STRIDES; i++)
        if (strides[i] > max)
            return virga_wrong_argument(&context->log, "%s: occluder_strides: the device allows %u, got %u", name, max,
                                        strides[i]);
    virga_mesh_map *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, name);
    made->resource.destroy = mesh_map_destroy;
    made->size = size ? size : 1;
    made->layers = size ? layers : 1;
    made->keeps = size && keeps;
    made->name = name;
    for (uint32_t i = 0; i < VIRGA_MAP_STRIDES; i++)
        made->strides[i] = strides[i];
    TRY(create_images(context, made));
    if (size)
        TRY(create_pipelines(context, group, made));
    *map = made;
    return VIRGA_OK;
error:
    virga_mesh_map_retire(context, &made);
    return result;
}

void virga_mesh_map_first_layouts(virga_context *context, VkCommandBuffer cmd, const virga_mesh_map *map)
{
    const virga_image_state before = {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0};
    const virga_image_state after = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                     VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                     VK_ACCESS_SHADER_READ_BIT};
    virga_image_barrier(context, cmd, map->images->depth->image, VK_IMAGE_ASPECT_DEPTH_BIT, before, after);
    virga_image_barrier(context, cmd, map->images->colors[0]->image, VK_IMAGE_ASPECT_COLOR_BIT, before, after);
}

static virga_pipeline *pipeline_for(const virga_mesh_map *map, const virga_occluder *mesh)
{
    const bool holes = mesh->cover > 0 && mesh->cover < 1;
    for (uint32_t i = 0; i < VIRGA_MAP_STRIDES; i++)
        if (map->pipelines[holes][i] && map->strides[i] == mesh->vertex_stride)
            return map->pipelines[holes][i];
    return NULL;
}

static virga_result check_mesh(const virga_log *log, const virga_occluder *mesh, uint32_t i)
{
    if (!mesh->vertices || !mesh->indices)
        return virga_wrong_argument(log, "occluder %u: expected a vertex and an index buffer", i);
    if (mesh->index_type != VK_INDEX_TYPE_UINT16 && mesh->index_type != VK_INDEX_TYPE_UINT32)
        return virga_wrong_argument(log, "occluder %u: index_type: expected UINT16 or UINT32, got %d", i,
                                    (int)mesh->index_type);
    if (mesh->vertex_offset % 4 || mesh->index_offset % (mesh->index_type == VK_INDEX_TYPE_UINT16 ? 2 : 4))
        return virga_wrong_argument(log, "occluder %u: expected offsets in whole floats and whole indices", i);
    if (mesh->material > 255)
        return virga_wrong_argument(log, "occluder %u: material: expected 0 to 255, got %u", i, mesh->material);
    if (!(mesh->cover >= 0 && mesh->cover <= 1))
        return virga_wrong_argument(log, "occluder %u: cover: expected 0 to 1, got %g", i, (double)mesh->cover);
    bool none = true;
    for (int k = 0; k < 12; k++) {
        if (!(fabs((double)mesh->world_from_mesh[k]) <= VIRGA_MAX_COORDINATE_M))
            return virga_wrong_argument(log, "occluder %u: world_from_mesh[%d]: is %g, expected no more than %g", i, k,
                                        (double)mesh->world_from_mesh[k], VIRGA_MAX_COORDINATE_M);
        none = none && (k % 4 == 3 || mesh->world_from_mesh[k] == 0);
    }
    if (none && mesh->index_count)
        return virga_wrong_argument(log, "occluder %u: world_from_mesh: expected axes, all of them are 0", i);
    return VIRGA_OK;
}

virga_result virga_mesh_map_check(const virga_context *context, const virga_mesh_map *map,
                                  const virga_occluder *occluders, uint32_t count)
{
    const virga_log *log = &context->log;
    for (uint32_t i = 0; i < count; i++) {
        if (check_mesh(log, &occluders[i], i))
            return VIRGA_ERROR_INVALID;
        if (!pipeline_for(map, &occluders[i]))
            return virga_wrong_argument(log, "occluder %u: vertex_stride %u is not among def.occluder_strides", i,
                                        occluders[i].vertex_stride);
    }
    return VIRGA_OK;
}

/* Translations are large at a distance from the world's origin. So they are computed relative to the map's origin in
 * double precision. */
static virga_map_push describe_push(const virga_mesh_map *map, const virga_map_view *view, const virga_occluder *mesh)
{
    virga_map_push push = {.center = {(float)view->center[0], (float)view->center[1]},
                           .inv_half_m = (float)(1 / view->half_m),
                           .inv_height = (float)(1 / view->height_m),
                           .slant = {(float)view->slant[0], (float)view->slant[1]},
                           .top_m = (float)view->top_m,
                           .cover = mesh->cover > 0 ? mesh->cover : 1,
                           .material = mesh->material,
                           .texels = map->size};
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            const double value = (double)mesh->world_from_mesh[row * 4 + column];
            push.rel_from_mesh[row * 4 + column] = (float)(column == 3 ? value - view->origin_m[row] : value);
        }
    return push;
}

static void draw_mesh(virga_context *context, VkCommandBuffer cmd, const virga_mesh_map *map,
                      const virga_map_view *view, const virga_occluder *mesh, const virga_pipeline **bound)
{
    const virga_pipeline *pipeline = pipeline_for(map, mesh);
    if (pipeline != *bound && !virga_bind_pipeline(context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline))
        return;
    *bound = pipeline;
    const virga_map_push push = describe_push(map, view, mesh);
    context->vk.CmdPushConstants(cmd, map->layout->layout, VIRGA_ALL_STAGES, 0, sizeof push, &push);
    context->vk.CmdBindVertexBuffers(cmd, 0, 1, &mesh->vertices, &mesh->vertex_offset);
    context->vk.CmdBindIndexBuffer(cmd, mesh->indices, mesh->index_offset, mesh->index_type);
    context->vk.CmdDrawIndexed(cmd, mesh->index_count, 1, 0, mesh->vertex_base, 0);
}

/* Where layers are: of both images, as ends of a copy and as what passes read. */
static void move_layers(virga_context *context, VkCommandBuffer cmd, const virga_mesh_map *map, bool copied)
{
    const VkImageLayout read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const VkPipelineStageFlags passes = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, copies = VK_PIPELINE_STAGE_TRANSFER_BIT;
    VkImageMemoryBarrier barriers[4];
    for (uint32_t i = 0; i < 4; i++) {
        const bool depth = i < 2, behind = i % 2;
        const VkImageLayout during =
            behind ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        const VkAccessFlags access = behind ? VK_ACCESS_TRANSFER_READ_BIT : VK_ACCESS_TRANSFER_WRITE_BIT;
        const VkImageLayout before = behind ? read : VK_IMAGE_LAYOUT_UNDEFINED; /* what is copied over may go */
        barriers[i] =
            (VkImageMemoryBarrier){.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                   .srcAccessMask = copied && !behind ? access : 0,
                                   .dstAccessMask = copied ? VK_ACCESS_SHADER_READ_BIT : access,
                                   .oldLayout = copied ? during : before,
                                   .newLayout = copied ? read : during,
                                   .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                   .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                   .image = depth ? map->images->depth->image : map->images->colors[0]->image,
                                   .subresourceRange = {depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT,
                                                        0, 1, behind ? map->layers : 0, map->layers}};
    }
    context->vk.CmdPipelineBarrier(cmd, copied ? copies : passes | copies, copied ? passes | copies : copies, 0, 0,
                                   NULL, 0, NULL, 4, barriers);
}

void virga_mesh_map_restore(virga_context *context, VkCommandBuffer cmd, const virga_mesh_map *map)
{
    move_layers(context, cmd, map, false);
    for (int depth = 0; depth < 2; depth++) {
        const VkImageAspectFlags aspect = depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
        const VkImage image = depth ? map->images->depth->image : map->images->colors[0]->image;
        const VkImageCopy copy = {.srcSubresource = {aspect, 0, map->layers, map->layers},
                                  .dstSubresource = {aspect, 0, 0, map->layers},
                                  .extent = {map->size, map->size, 1}};
        context->vk.CmdCopyImage(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image,
                                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    }
    move_layers(context, cmd, map, true);
}

void virga_mesh_map_draw(virga_context *context, VkCommandBuffer cmd, const virga_mesh_map *map, uint32_t layer,
                         const virga_map_view *view, const virga_occluder *meshes, uint32_t count)
{
    const virga_pipeline *bound = NULL;
    if (view->moving_only)
        virga_offscreen_resume(context, cmd, map->images, layer);
    else
        virga_offscreen_begin(context, cmd, map->images, layer);
    for (uint32_t i = 0; i < count; i++)
        if (meshes[i].index_count && (!view->ground_only || meshes[i].ground) &&
            (!view->still_only || !meshes[i].is_dynamic) && (!view->moving_only || meshes[i].is_dynamic))
            draw_mesh(context, cmd, map, view, &meshes[i], &bound);
    virga_offscreen_end(context, cmd);
}
