/* rain/rain_occlusion.c - maps of what the falling drops meet first.
 *
 * Rain falls along parallel lines, so a depth image taken along them tells for each line where it first meets
 * something: above that there is rain, below there is none, however many roofs lie under one another. Lines lean with
 * the wind, small drops' more; a few slants cover the sizes. A map is sheared, not turned: its coordinates are
 * (x + s.x y, z + s.y y), so a texel is a line of fall and depth is height. Cascades of maps lie around the camera,
 * each four times as wide as the one inside it. */
#include "rain/rain_internal.h"

#include "shaders/rain_map_frag.spv.h"
#include "shaders/rain_map_vert.spv.h"

#include <math.h>
#include <string.h>

#define CASCADE_FACTOR 4.0
#define MAP_MARGIN     1.3   /* of the range that drops have, so that leaning lines stay inside */
#define MAP_TOP_M      256.0 /* above the camera: what is higher shelters nothing */
#define MAP_HEIGHT_M   512.0
#define SLANT_TIME_S   0.5 /* a drop has come along its line for about this long when it passes cover */
#define MOST_SLANT     8.0 /* horizontal metres a metre of fall: nearly flat, in a storm */

/* Diameters that part the slants, and one that stands for each. */
static const double slant_bounds[VIRGA_RAIN_MAX_SLANTS][VIRGA_RAIN_MAX_SLANTS - 1] = {
    {1, 1, 1}, {1.5e-3, 1, 1}, {1.0e-3, 2.0e-3, 1}, {0.8e-3, 1.4e-3, 2.4e-3}};
static const double slant_middles[VIRGA_RAIN_MAX_SLANTS][VIRGA_RAIN_MAX_SLANTS] = {
    {1.6e-3}, {1.1e-3, 2.2e-3}, {0.8e-3, 1.5e-3, 2.6e-3}, {0.6e-3, 1.1e-3, 1.9e-3, 3.0e-3}};

uint32_t rain_class_slant(const virga_rain *rain, double diameter_m)
{
    const uint32_t slants = rain->def.occlusion_slants;
    uint32_t slant = 0;
    while (slant + 1 < slants && diameter_m >= slant_bounds[slants - 1][slant])
        slant++;
    return slant;
}

/* The slant of the drops that stand for a group, at this instant. */
static void slant_now(const virga_rain *rain, uint32_t slant, double out[2])
{
    const double diameter = slant_middles[rain->def.occlusion_slants - 1][slant];
    uint32_t k = 0;
    while (k + 1 < VIRGA_RAIN_CLASSES && rain->classes->classes[k].diameter_m < diameter)
        k++;
    const rain_class *c = &rain->classes->classes[k];
    const double down = c->velocity[1] < -0.05 ? -c->velocity[1] : 0.05;
    for (int i = 0; i < 2; i++) {
        const double s = c->velocity[i * 2] / down;
        out[i] = s < -MOST_SLANT ? -MOST_SLANT : s > MOST_SLANT ? MOST_SLANT : s;
    }
}

void rain_occlusion_tick(virga_rain *rain)
{
    const double share = rain->ticks ? rain->def.tick_s / (SLANT_TIME_S + rain->def.tick_s) : 1;
    for (uint32_t i = 0; i < rain->def.occlusion_slants; i++) {
        double now[2];
        slant_now(rain, i, now);
        for (int axis = 0; axis < 2; axis++)
            rain->slant_smooth[i][axis] += share * (now[axis] - rain->slant_smooth[i][axis]);
    }
}

/* Places the maps around a camera, on multiples of their texels so that they stay still while it moves a little. */
static void plan_maps(virga_rain *rain, const double camera_m[3])
{
    if (!rain->ticks)
        rain_occlusion_tick(rain);
    for (uint32_t cascade = 0; cascade < rain->def.occlusion_cascades; cascade++)
        for (uint32_t slant = 0; slant < rain->def.occlusion_slants; slant++) {
            rain_map *map = &rain->maps[cascade * rain->def.occlusion_slants + slant];
            const uint32_t inwards = rain->def.occlusion_cascades - 1 - cascade;
            map->half_m = 0.5 * rain->classes->side_m * MAP_MARGIN / pow(CASCADE_FACTOR, inwards);
            const double texel = 2 * map->half_m / rain->def.occlusion_size;
            for (int axis = 0; axis < 2; axis++) {
                map->slant[axis] = rain->slant_smooth[slant][axis];
                const double centre = camera_m[axis * 2] + map->slant[axis] * camera_m[1];
                map->centre[axis] = floor(centre / texel) * texel;
            }
            map->top_m = floor(camera_m[1]) + MAP_TOP_M;
            map->height_m = MAP_HEIGHT_M;
        }
}

/* A map's numbers seen from an origin near the camera, in double until they are small. */
static void centre_from(const rain_map *map, const double origin[3], double centre[2])
{
    for (int axis = 0; axis < 2; axis++)
        centre[axis] = map->centre[axis] - origin[axis * 2] - map->slant[axis] * origin[1];
}

void rain_fill_maps(const virga_rain *rain, virga_map_gpu maps[VIRGA_RAIN_MAX_MAPS])
{
    memset(maps, 0, VIRGA_RAIN_MAX_MAPS * sizeof maps[0]);
    const uint32_t size = rain->host_maps ? rain->host_map_image.extent.width : rain->def.occlusion_size;
    for (uint32_t i = 0; i < rain->map_count; i++) {
        double centre[2];
        centre_from(&rain->maps[i], rain->origin, centre);
        maps[i] = (virga_map_gpu){.centre = {(float)centre[0], (float)centre[1]},
                                  .inv_half_m = (float)(1 / rain->maps[i].half_m),
                                  .texels = (float)size,
                                  .slant = {(float)rain->maps[i].slant[0], (float)rain->maps[i].slant[1]},
                                  .top_m = (float)(rain->maps[i].top_m - rain->origin[1]),
                                  .height_m = (float)rain->maps[i].height_m};
    }
}

/* ---- drawing them */

static virga_result create_pass(virga_rain *rain)
{
    virga_result result = VIRGA_OK;
    virga_context *context = rain->context;
    const VkImageLayout read_only = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const VkAttachmentDescription attachments[2] = {{.format = VK_FORMAT_R32_UINT,
                                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                     .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                     .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                                     .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                                     .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                                     .finalLayout = read_only},
                                                    {.format = VK_FORMAT_D32_SFLOAT,
                                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                     .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                     .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                                     .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                                     .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                                     .finalLayout = read_only}};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = 1,
                                          .pColorAttachments = &color,
                                          .pDepthStencilAttachment = &depth};
    /* What read the maps before is done before they are cleared, and what reads them after waits for them. */
    const VkPipelineStageFlags draws = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                       VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                       VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    const VkAccessFlags writes = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                                 VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    const VkSubpassDependency dependencies[2] = {
        {VK_SUBPASS_EXTERNAL, 0, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | draws, draws,
         VK_ACCESS_SHADER_READ_BIT | writes, writes, 0},
        {0, VK_SUBPASS_EXTERNAL, draws, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, writes, VK_ACCESS_SHADER_READ_BIT, 0}};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 2,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 2,
                                         .pDependencies = dependencies};
    VK_TRY(context, CreateRenderPass(context->device, &info, NULL, &rain->map_pass));
    context->objects++;
error:
    return result;
}

static virga_result create_framebuffers(virga_rain *rain, uint32_t size, uint32_t count)
{
    virga_result result = VIRGA_OK;
    virga_context *context = rain->context;
    for (uint32_t i = 0; i < count; i++) {
        const VkImageView views[2] = {rain->map_surface->layer_views[i], rain->map_depth->layer_views[i]};
        const VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                              .renderPass = rain->map_pass,
                                              .attachmentCount = 2,
                                              .pAttachments = views,
                                              .width = size,
                                              .height = size,
                                              .layers = 1};
        VK_TRY(context, CreateFramebuffer(context->device, &info, NULL, &rain->map_framebuffers[i]));
        context->objects++;
    }
error:
    return result;
}

static virga_result create_pipeline(virga_rain *rain, uint32_t stride, virga_pipeline **pipeline)
{
    const virga_graphics_def def = {.vertex = VIRGA_SPIRV(rain_map_vert),
                                    .fragment = VIRGA_SPIRV(rain_map_frag),
                                    .layout = rain->map_layout,
                                    .render_pass = rain->map_pass,
                                    .vertex_stride = stride,
                                    .color_count = 1,
                                    .depth_test = true,
                                    .depth_write = true,
                                    .name = "rain.map"};
    return virga_graphics_pipeline_create(rain->context, &def, pipeline);
}

virga_result rain_occlusion_create(virga_rain *rain)
{
    virga_result result = VIRGA_OK;
    virga_context *context = rain->context;
    const bool on = rain->def.occlusion_size > 0;
    const uint32_t size = on ? rain->def.occlusion_size : 1;
    const uint32_t count = on ? rain->def.occlusion_cascades * rain->def.occlusion_slants : 1;
    TRY(virga_image_create(context, VK_FORMAT_D32_SFLOAT, (VkExtent2D){size, size}, count,
                           VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                           VK_IMAGE_ASPECT_DEPTH_BIT, "rain.map_depth", &rain->map_depth));
    TRY(virga_image_create(context, VK_FORMAT_R32_UINT, (VkExtent2D){size, size}, count,
                           VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_IMAGE_ASPECT_COLOR_BIT,
                           "rain.map_surface", &rain->map_surface));
    if (!on)
        return VIRGA_OK;
    TRY(create_pass(rain));
    TRY(create_framebuffers(rain, size, count));
    const VkPushConstantRange range = {VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                       sizeof(virga_map_push)};
    const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                             .pushConstantRangeCount = 1,
                                             .pPushConstantRanges = &range};
    VK_TRY(context, CreatePipelineLayout(context->device, &info, NULL, &rain->map_layout));
    context->objects++;
    for (uint32_t i = 0; i < 4; i++)
        if (rain->def.occluder_strides[i])
            TRY(create_pipeline(rain, rain->def.occluder_strides[i], &rain->map_pipelines[i]));
error:
    return result;
}

void rain_occlusion_destroy(virga_rain *rain)
{
    virga_context *context = rain->context;
    for (uint32_t i = 0; i < 4; i++)
        VIRGA_RETIRE(context, rain->map_pipelines[i]);
    VIRGA_RETIRE(context, rain->map_depth);
    VIRGA_RETIRE(context, rain->map_surface);
    for (uint32_t i = 0; i < VIRGA_RAIN_MAX_MAPS; i++)
        if (rain->map_framebuffers[i]) {
            context->vk.DestroyFramebuffer(context->device, rain->map_framebuffers[i], NULL);
            context->objects--;
        }
    if (rain->map_layout) {
        context->vk.DestroyPipelineLayout(context->device, rain->map_layout, NULL);
        context->objects--;
    }
    if (rain->map_pass) {
        context->vk.DestroyRenderPass(context->device, rain->map_pass, NULL);
        context->objects--;
    }
}

static virga_pipeline *pipeline_for(const virga_rain *rain, uint32_t stride)
{
    for (uint32_t i = 0; i < 4; i++)
        if (rain->map_pipelines[i] && rain->def.occluder_strides[i] == stride)
            return rain->map_pipelines[i];
    return NULL;
}

static virga_result check_occluders(const virga_rain *rain, const virga_occluder *occluders, uint32_t count)
{
    const virga_log *log = &rain->context->log;
    for (uint32_t i = 0; i < count; i++) {
        if (!occluders[i].vertices || !occluders[i].indices)
            return virga_wrong_argument(log, "occluder %u: expected a vertex and an index buffer", i);
        if (!pipeline_for(rain, occluders[i].vertex_stride))
            return virga_wrong_argument(log, "occluder %u: vertex_stride %u is not among def.occluder_strides", i,
                                        occluders[i].vertex_stride);
        if (occluders[i].material > 255)
            return virga_wrong_argument(log, "occluder %u: material: expected 0 to 255, got %u", i,
                                        occluders[i].material);
    }
    return VIRGA_OK;
}

/* The push constants of one mesh in one map. Translations are large far from the world's origin, so they are made
 * relative to the camera in double. */
static virga_map_push describe_push(const virga_rain *rain, const rain_map *map, const double camera_m[3],
                                    const virga_occluder *occluder)
{
    double centre[2];
    centre_from(map, camera_m, centre);
    virga_map_push push = {.centre = {(float)centre[0], (float)centre[1]},
                           .inv_half_m = (float)(1 / map->half_m),
                           .inv_height = (float)(1 / map->height_m),
                           .slant = {(float)map->slant[0], (float)map->slant[1]},
                           .top_m = (float)(map->top_m - camera_m[1]),
                           .cover = occluder->cover > 0 ? occluder->cover : 1,
                           .material = occluder->material,
                           .texels = rain->def.occlusion_size};
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            const double value = (double)occluder->world_from_mesh[row * 4 + column];
            push.rel_from_mesh[row * 4 + column] = (float)(column == 3 ? value - camera_m[row] : value);
        }
    return push;
}

static void draw_occluder(virga_rain *rain, VkCommandBuffer cmd, const rain_map *map, const double camera_m[3],
                          const virga_occluder *occluder, const virga_pipeline **bound)
{
    virga_context *context = rain->context;
    const virga_pipeline *pipeline = pipeline_for(rain, occluder->vertex_stride);
    if (pipeline != *bound)
        context->vk.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->pipeline);
    *bound = pipeline;
    const virga_map_push push = describe_push(rain, map, camera_m, occluder);
    context->vk.CmdPushConstants(cmd, rain->map_layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                 sizeof push, &push);
    context->vk.CmdBindVertexBuffers(cmd, 0, 1, &occluder->vertices, &occluder->vertex_offset);
    context->vk.CmdBindIndexBuffer(cmd, occluder->indices, occluder->index_offset, occluder->index_type);
    context->vk.CmdDrawIndexed(cmd, occluder->index_count, 1, 0, occluder->vertex_base, 0);
}

static void draw_map(virga_rain *rain, VkCommandBuffer cmd, uint32_t index, const double camera_m[3],
                     const virga_occluder *occluders, uint32_t count)
{
    virga_context *context = rain->context;
    const uint32_t size = rain->def.occlusion_size;
    const VkClearValue clears[2] = {{.color = {.uint32 = {0}}}, {.depthStencil = {1, 0}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = rain->map_pass,
                                         .framebuffer = rain->map_framebuffers[index],
                                         .renderArea = {{0, 0}, {size, size}},
                                         .clearValueCount = 2,
                                         .pClearValues = clears};
    const VkViewport viewport = {0, 0, (float)size, (float)size, 0, 1};
    const VkRect2D scissor = {{0, 0}, {size, size}};
    const virga_pipeline *bound = NULL;
    context->vk.CmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    context->vk.CmdSetViewport(cmd, 0, 1, &viewport);
    context->vk.CmdSetScissor(cmd, 0, 1, &scissor);
    for (uint32_t i = 0; i < count; i++)
        if (occluders[i].index_count)
            draw_occluder(rain, cmd, &rain->maps[index], camera_m, &occluders[i], &bound);
    context->vk.CmdEndRenderPass(cmd);
}

static virga_result check_call(const virga_rain *rain, const double camera_m[3])
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    if (rain->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!rain->def.occlusion_size)
        return VIRGA_NOT_READY;
    return camera_m ? virga_settings_finite_double(&rain->context->log, "camera_m", camera_m, 3) : VIRGA_OK;
}

virga_result virga_rain_occlusion(virga_rain *rain, VkCommandBuffer cmd, const double camera_m[3],
                                  const virga_occluder *occluders, uint32_t count)
{
    virga_result result = check_call(rain, camera_m);
    if (result)
        return result;
    if (!cmd || !camera_m || (count && !occluders))
        return virga_wrong_argument(&rain->context->log, "virga_rain_occlusion: NULL argument");
    result = check_occluders(rain, occluders, count);
    if (result)
        return result;
    rain_begin_frame(rain, cmd);
    plan_maps(rain, camera_m);
    rain->map_count = rain->def.occlusion_cascades * rain->def.occlusion_slants;
    rain->host_maps = false;
    const virga_pass_scope scope = virga_pass_begin(rain->context, cmd, "rain.occlusion");
    for (uint32_t i = 0; i < rain->map_count; i++)
        draw_map(rain, cmd, i, camera_m, occluders, count);
    virga_pass_end(rain->context, cmd, scope);
    return VIRGA_OK;
}

/* ---- maps that the host draws */

uint32_t virga_rain_occlusion_views(virga_rain *rain, const double camera_m[3], virga_occlusion_view *views)
{
    if (!camera_m || !views || check_call(rain, camera_m))
        return 0;
    plan_maps(rain, camera_m);
    const uint32_t count = rain->def.occlusion_cascades * rain->def.occlusion_slants;
    for (uint32_t i = 0; i < count; i++) {
        const rain_map *map = &rain->maps[i];
        double centre[2];
        centre_from(map, camera_m, centre);
        const float scale = (float)(1 / map->half_m), down = (float)(1 / map->height_m);
        /* Columns are the images of x, y, z and 1: x and z scaled, y sheared into both and turned into depth. */
        const float matrix[16] = {scale,
                                  0,
                                  0,
                                  0,
                                  scale * (float)map->slant[0],
                                  scale * (float)map->slant[1],
                                  -down,
                                  0,
                                  0,
                                  scale,
                                  0,
                                  0,
                                  -scale * (float)centre[0],
                                  -scale * (float)centre[1],
                                  (float)(map->top_m - camera_m[1]) * down,
                                  1};
        memcpy(views[i].clip_from_world, matrix, sizeof matrix);
        memcpy(views[i].origin_m, camera_m, sizeof views[i].origin_m);
        views[i].layer = i;
    }
    return count;
}

virga_result virga_rain_occlusion_import(virga_rain *rain, VkCommandBuffer cmd, const virga_image *depth)
{
    const virga_result result = check_call(rain, NULL);
    if (result)
        return result;
    const uint32_t count = rain->def.occlusion_cascades * rain->def.occlusion_slants;
    if (!cmd || !depth || !depth->view || depth->extent.width != depth->extent.height || depth->layers < count)
        return virga_wrong_argument(&rain->context->log,
                                    "virga_rain_occlusion_import: expected a square image with %u layers", count);
    rain_begin_frame(rain, cmd);
    rain->map_count = count;
    rain->host_maps = true;
    rain->host_map_image = *depth;
    return VIRGA_OK;
}
