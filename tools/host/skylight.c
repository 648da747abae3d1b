/* skylight.c - depth maps of the sky's directions and the volume that is gathered from them. */
#include "skylight.h"

#include <math.h>
#include <string.h>

#include "pipeline.h"

#include "skylight_comp.spv.h"
#include "skylight_frag.spv.h"
#include "skylight_vert.spv.h"

#define MAP_SIZE     512
#define WHOLE_M      160.0f /* scenes up to this width are in the volume as a whole */
#define BOX_M        128.0f /* for others, a box of this width moves with the camera */
#define BOX_HEIGHT_M 44.0f
#define BOX_STEP_M   16.0f  /* in steps, so that it is not filled in every frame */
#define REACH_M      600.0f /* farther occluders cast no shade */

/* ---- create ------------------------------------------------------------------------------------------------- */

static bool create_pass(host_device *device, host_skylight *s, char *error, size_t error_size)
{
    const VkAttachmentDescription attachment =
        host_attachment(VK_FORMAT_D32_SFLOAT, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    /* Fragments sample the map of shelter, which is drawn with the same pass. */
    const VkPipelineStageFlags gathers = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    const VkAccessFlags reads = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    const VkAccessFlags writes = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    const host_pass_def def = {
        .attachments = &attachment,
        .depth = true,
        .before = {gathers | HOST_DEPTH_STAGES, writes, HOST_DEPTH_STAGES, reads | writes},
        .after = {HOST_DEPTH_STAGES, writes, gathers, VK_ACCESS_SHADER_READ_BIT},
    };
    return host_pass_create(device, &def, &s->pass, error, error_size);
}

static bool create_images(host_device *device, host_skylight *s, char *error, size_t error_size)
{
    host_image_def maps = {
        .format = VK_FORMAT_D32_SFLOAT,
        .extent = {MAP_SIZE, MAP_SIZE, 1},
        .layers = HOST_SKYLIGHT_DIRECTIONS,
        .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
        .name = "skylight maps",
    };
    host_image_def volume = {
        .format = VK_FORMAT_R16G16B16A16_SFLOAT,
        .extent = {HOST_SKYLIGHT_SIDE, HOST_SKYLIGHT_HEIGHT, HOST_SKYLIGHT_SIDE},
        .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
        .name = "skylight volume",
    };
    if (!host_image_create(device, &maps, &s->maps, error, error_size) ||
        !host_image_create(device, &volume, &s->volume, error, error_size))
        return false;
    for (uint32_t i = 0; i < HOST_SKYLIGHT_DIRECTIONS; i++)
        if (!host_slice_create(device, s->pass, &s->maps, 0, i, &s->slices[i], error, error_size))
            return false;
    return true;
}

/* Bindings of the gather pass: uniforms, depth maps, volume. */
static const VkDescriptorType gather_kinds[3] = {
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};

static bool create_set(host_device *device, host_skylight *s, char *error, size_t error_size)
{
    const host_bindings_def def = {.shape = {gather_kinds, 3, VK_SHADER_STAGE_COMPUTE_BIT}, .set_count = 1};
    if (!host_bindings_create(device, &def, &s->bindings, error, error_size) ||
        !host_sampler_create(device, HOST_SAMPLE_NEAREST, &s->sampler, error,
                             error_size)) /* depth must not be filtered */
        return false;
    const VkDescriptorSet set = s->bindings.sets[0];
    host_set_write_buffer(device, set, 0, gather_kinds[0], s->uniforms.buffer);
    host_set_write_image(device, set, 1, s->sampler, s->maps.view, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    host_set_write_image(device, set, 2, VK_NULL_HANDLE, s->volume.view, VK_IMAGE_LAYOUT_GENERAL);
    return true;
}

/* ---- pipelines ---------------------------------------------------------------------------------------------- */

/* Draws depth from a direction. `fragment` discards texels of cut-outs; it may be empty. */
static bool create_draw(host_device *device, host_skylight *s, host_code fragment, VkPipeline *pipeline, char *error,
                        size_t error_size)
{
    const host_graphics_def def = {.vertex = HOST_CODE(skylight_vert),
                                   .fragment = fragment,
                                   .layout = s->draw_layout,
                                   .pass = s->pass,
                                   .attribute_count = 2,
                                   .depth_test = true,
                                   .depth_write = true,
                                   .compare = VK_COMPARE_OP_LESS};
    return host_graphics_create(device, &def, pipeline, error, error_size);
}

static bool create_pipelines(host_device *device, VkDescriptorSetLayout material_layout, host_skylight *s, char *error,
                             size_t error_size)
{
    const VkShaderStageFlags drawing = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    return host_pipeline_layout_create(device, &material_layout, 1, drawing, sizeof(struct host_skylight_draw_gpu),
                                       &s->draw_layout, error, error_size) &&
           create_draw(device, s, (host_code){0}, &s->opaque, error, error_size) &&
           create_draw(device, s, HOST_CODE(skylight_frag), &s->cutout, error, error_size) &&
           host_compute_create(device, HOST_CODE(skylight_comp), s->bindings.layout, &s->gather, error, error_size);
}

/* Directions of equal solid angle over the upper hemisphere, on a spiral of the golden angle. */
static void spread_directions(host_skylight *s)
{
    for (int i = 0; i < HOST_SKYLIGHT_DIRECTIONS; i++) {
        double y = (i + 0.5) / HOST_SKYLIGHT_DIRECTIONS, flat = sqrt(1.0 - y * y), angle = i * 2.39996322972865332;
        s->gpu.direction[i][0] = (float)(flat * cos(angle));
        s->gpu.direction[i][1] = (float)y;
        s->gpu.direction[i][2] = (float)(flat * sin(angle));
    }
}

bool host_skylight_create(host_device *device, VkDescriptorSetLayout material_layout, host_skylight *s, char *error,
                          size_t error_size)
{
    memset(s, 0, sizeof *s);
    spread_directions(s);
    bool ok =
        create_pass(device, s, error, error_size) && create_images(device, s, error, error_size) &&
        host_buffer_create(device, sizeof s->gpu, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           HOST_BUFFER_DEVICE, "skylight uniforms", &s->uniforms, error, error_size) &&
        create_set(device, s, error, error_size) && create_pipelines(device, material_layout, s, error, error_size);
    if (!ok)
        host_skylight_destroy(device, s);
    return ok;
}

void host_skylight_destroy(host_device *device, host_skylight *s)
{
    VkDevice vk = device->device;
    vkDestroyPipeline(vk, s->gather, NULL);
    vkDestroyPipeline(vk, s->cutout, NULL);
    vkDestroyPipeline(vk, s->opaque, NULL);
    vkDestroyPipelineLayout(vk, s->draw_layout, NULL);
    host_bindings_destroy(device, &s->bindings);
    vkDestroySampler(vk, s->sampler, NULL);
    for (int i = 0; i < HOST_SKYLIGHT_DIRECTIONS; i++)
        host_slice_destroy(device, &s->slices[i]);
    vkDestroyRenderPass(vk, s->pass, NULL);
    host_buffer_destroy(device, &s->uniforms);
    host_image_destroy(device, &s->maps);
    host_image_destroy(device, &s->volume);
    memset(s, 0, sizeof *s);
}

/* ---- where -------------------------------------------------------------------------------------------------- */

/* The orthographic view from a direction of the sky onto the sphere around the box. Depth is 0 at REACH_M above the
 * sphere and 1 at its far side. */
static void look(const float d[3], const float center[3], float radius, float m[16])
{
    float side[3] = {d[2], 0.0f, -d[0]}; /* never zero: no direction is straight up */
    float length = sqrtf(side[0] * side[0] + side[2] * side[2]);
    for (int i = 0; i < 3; i++)
        side[i] /= length;
    const float up[3] = {d[1] * side[2], d[2] * side[0] - d[0] * side[2], -d[1] * side[0]};
    float range = 2.0f * radius + REACH_M;
    memset(m, 0, 16 * sizeof *m);
    m[14] = (radius + REACH_M) / range;
    m[15] = 1.0f;
    for (int i = 0; i < 3; i++) {
        m[i * 4] = side[i] / radius;
        m[i * 4 + 1] = up[i] / radius;
        m[i * 4 + 2] = -d[i] / range;
        m[12] -= side[i] * center[i] / radius;
        m[13] -= up[i] * center[i] / radius;
        m[14] += d[i] * center[i] / range;
    }
}

bool host_skylight_place(host_skylight *s, const double camera_m[3], const float scene_low[3],
                         const float scene_high[3])
{
    float low[3], size[3];
    s->whole = scene_high[0] - scene_low[0] <= WHOLE_M && scene_high[2] - scene_low[2] <= WHOLE_M;
    for (int i = 0; i < 3; i++) {
        float min_size = i == 1 ? 4.0f : 8.0f, margin = 0.5f;
        size[i] = fmaxf(scene_high[i] - scene_low[i] + 2.0f * margin, min_size);
        low[i] = scene_low[i] - margin;
        if (!s->whole) {
            size[i] = i == 1 ? BOX_HEIGHT_M : BOX_M;
            float middle = (float)(floor(camera_m[i] / BOX_STEP_M + 0.5) * BOX_STEP_M);
            low[i] = middle - size[i] * (i == 1 ? 0.4f : 0.5f);
        } else if (i == 1 && size[i] > BOX_HEIGHT_M) {
            size[i] = BOX_HEIGHT_M;
        }
    }
    if (s->ready && memcmp(low, s->low, sizeof low) == 0 && memcmp(size, s->size, sizeof size) == 0)
        return false;
    memcpy(s->low, low, sizeof low);
    memcpy(s->size, size, sizeof size);

    float center[3], radius = 0.0f;
    const float voxels[3] = {HOST_SKYLIGHT_SIDE, HOST_SKYLIGHT_HEIGHT, HOST_SKYLIGHT_SIDE};
    for (int i = 0; i < 3; i++) {
        center[i] = low[i] + 0.5f * size[i];
        radius += 0.25f * size[i] * size[i];
        s->gpu.low[i] = low[i];
        s->gpu.voxel[i] = size[i] / voxels[i];
    }
    radius = sqrtf(radius);
    /* Half a voxel of bias, so that voxels close to a slope do not shade themselves. */
    s->gpu.low[3] = 0.5f * s->gpu.voxel[0] / (2.0f * radius + REACH_M);
    for (int i = 0; i < HOST_SKYLIGHT_DIRECTIONS; i++)
        look(s->gpu.direction[i], center, radius, s->gpu.map_from_world[i]);
    return true;
}

void host_skylight_frame(const host_skylight *s, const double camera_m[3], struct host_frame_gpu *frame)
{
    for (int i = 0; i < 3; i++) {
        frame->skylight_low[i] = (float)(s->low[i] - camera_m[i]);
        frame->skylight_scale[i] = 1.0f / s->size[i];
    }
    frame->skylight_low[3] = s->gpu.voxel[0];
    /* The fade ends where the box may end. The camera is up to half a step off its middle. */
    float end = 0.5f * BOX_M - 0.5f * BOX_STEP_M - 2.0f, begin = 0.6f * end;
    frame->skylight_fade[0] = begin;
    frame->skylight_scale[3] = s->whole ? 0.0f : 1.0f / (end - begin);
}

/* ---- recording ---------------------------------------------------------------------------------------------- */

void host_skylight_begin(host_skylight *s, VkCommandBuffer cmd)
{
    host_buffer_update(cmd, &s->uniforms, &s->gpu, sizeof s->gpu, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                       VK_ACCESS_UNIFORM_READ_BIT);
}

void host_skylight_begin_map(const host_skylight *s, VkCommandBuffer cmd, uint32_t direction)
{
    host_pass_begin(cmd, s->pass, s->slices[direction].framebuffer, MAP_SIZE, MAP_SIZE, 0);
}

void host_skylight_push(const host_skylight *s, VkCommandBuffer cmd, const float map_from_world[16], float alpha,
                        float cutoff)
{
    struct host_skylight_draw_gpu draw;
    memcpy(draw.map_from_world, map_from_world, sizeof draw.map_from_world);
    draw.cutout[0] = alpha;
    draw.cutout[1] = cutoff;
    draw.cutout[2] = draw.cutout[3] = 0.0f;
    vkCmdPushConstants(cmd, s->draw_layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof draw,
                       &draw);
}

void host_skylight_end_map(const host_skylight *s, VkCommandBuffer cmd)
{
    (void)s;
    vkCmdEndRenderPass(cmd);
}

void host_skylight_gather(host_skylight *s, VkCommandBuffer cmd)
{
    host_image_barrier(cmd, &s->volume, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL,
                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                       VK_ACCESS_SHADER_WRITE_BIT);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, s->gather);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, s->bindings.layout, 0, 1, s->bindings.sets, 0, NULL);
    vkCmdDispatch(cmd, HOST_SKYLIGHT_SIDE / 8, HOST_SKYLIGHT_HEIGHT / HOST_SKYLIGHT_RUN / 2, HOST_SKYLIGHT_SIDE / 4);
    host_image_barrier(cmd, &s->volume, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    s->ready = true;
}
