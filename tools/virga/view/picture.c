/* picture.c - one full-screen pass over the outputs of the shot, and quads of a view over it. */
#include "view/picture.h"

#include "views/view_gpu.h"

#include <math.h>
#include <string.h>

#include "view_view_frag.spv.h"
#include "view_view_vert.spv.h"

/* Uniforms of all shaders, and those of the shown view. */
typedef struct view_uniforms {
    struct view_gpu view;
    uint8_t own[TOOL_VIEW_BYTES];
} view_uniforms;

static const struct {
    uint32_t binding;
    host_output output;
} plate_bindings[] = {
    {VIEW_AT_COLOR, HOST_COLOR}, {VIEW_AT_NORMAL, HOST_NORMAL}, {VIEW_AT_VELOCITY, HOST_VELOCITY},
    {VIEW_AT_WATER, HOST_WATER}, {VIEW_AT_ID, HOST_ID},         {VIEW_AT_DEPTH, HOST_DEPTH},
};

/* ---- pipelines */

static bool create_sets(view_picture *p, char *error, size_t error_size)
{
    const VkShaderStageFlags seen = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    VkDescriptorType types[VIEW_BINDINGS];
    for (uint32_t i = 0; i < VIEW_BINDINGS; i++)
        types[i] = i == VIEW_AT_UNIFORMS ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                   : i < VIEW_AT_BUFFERS ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                         : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const host_bindings_def def = {.shape = {types, VIEW_BINDINGS, seen},
                                   .set_count = HOST_FRAMES,
                                   .push_stages = VK_SHADER_STAGE_VERTEX_BIT,
                                   .push_bytes = 2 * sizeof(float)};
    for (uint32_t i = 0; i < HOST_FRAMES; i++)
        if (!host_buffer_create(p->device, sizeof(view_uniforms), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                HOST_BUFFER_UPLOAD, "view", &p->uniforms[i], error, error_size))
            return false;
    return host_bindings_create(p->device, &def, &p->bindings, error, error_size);
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

/* Replace outputs that a scene does not have. */
static bool create_blanks(view_picture *p, char *error, size_t error_size)
{
    const uint8_t zero[64] = {0};
    const host_image_def def = {.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {1, 1, 1}, .name = "blank"};
    if (!host_image_create_with(p->device, &def, zero, 4, 4, &p->blank, error, error_size))
        return false;
    /* The definition of an image does not say that it is an array of one layer, so its view is created here. */
    const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = p->blank.image,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY,
                                        .format = def.format,
                                        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    HOST_TRY(vkCreateImageView(p->device->device, &view, NULL, &p->blank_array.view));
    return host_buffer_create_with(p->device, zero, sizeof zero, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "blank",
                                   &p->blank_buffer, error, error_size);
}

/* Modes with shaders of their own. */
static bool build_views(view_picture *p, VkRenderPass pass, char *error, size_t error_size)
{
    for (uint32_t i = 0; view_mode(i); i++) {
        const tool_view *view = view_mode(i)->view;
        if (view && !host_fullscreen_create(p->device, HOST_CODE(view_view_vert), view->fragment, p->bindings.layout,
                                            pass, &p->views[i], error, error_size))
            return false;
        if (view && view->quad_count &&
            !host_fullscreen_create(p->device, view->quad_vertex, view->quad_fragment, p->bindings.layout, pass,
                                    &p->quads[i], error, error_size))
            return false;
    }
    return true;
}

bool view_picture_create(host_device *device, const view_window *window, view_picture *p, char *error,
                         size_t error_size)
{
    memset(p, 0, sizeof *p);
    p->device = device;
    return create_samplers(p, error, error_size) && create_blanks(p, error, error_size) &&
           create_sets(p, error, error_size) &&
           host_fullscreen_create(device, HOST_CODE(view_view_vert), HOST_CODE(view_view_frag), p->bindings.layout,
                                  window->pass, &p->picture, error, error_size) &&
           build_views(p, window->pass, error, error_size);
}

void view_picture_destroy(view_picture *p)
{
    if (!p->device)
        return;
    const VkDevice device = p->device->device;
    for (uint32_t i = 0; i < VIEW_MAX_MODES; i++) {
        vkDestroyPipeline(device, p->quads[i], NULL);
        vkDestroyPipeline(device, p->views[i], NULL);
    }
    vkDestroyPipeline(device, p->picture, NULL);
    host_bindings_destroy(p->device, &p->bindings);
    vkDestroySampler(device, p->nearest, NULL);
    vkDestroySampler(device, p->linear, NULL);
    vkDestroyImageView(device, p->blank_array.view, NULL);
    host_image_destroy(p->device, &p->blank);
    host_buffer_destroy(p->device, &p->blank_buffer);
    for (uint32_t i = 0; i < HOST_FRAMES; i++)
        host_buffer_destroy(p->device, &p->uniforms[i]);
    memset(p, 0, sizeof *p);
}

/* ---- uniforms */

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

/* The layer of a mode, from HOST_LAYER on. */
static uint32_t layer_of(const shot *s, const tool_layer *layer)
{
    for (uint32_t i = 0; i < s->layer_count; i++)
        if (s->layers[i].layer == layer)
            return s->layers[i].output - HOST_LAYER;
    return 0;
}

static void fill_layers(const shot *s, struct view_gpu *out)
{
    for (uint32_t i = 0; i < s->layer_count; i++) {
        const uint32_t at = out->mode[2];
        if (s->layers[i].layer->is_data)
            continue;
        out->over[at / 4][at % 4] = s->layers[i].output - HOST_LAYER;
        out->mode[2]++;
    }
}

static void fill(const shot *s, const host_camera *camera, const view_shown *shown, struct view_gpu *out)
{
    const view_mode_row *mode = view_mode(shown->mode);
    memcpy(out->area, shown->area, sizeof out->area);
    out->picture[0] = (float)s->target.width;
    out->picture[1] = (float)s->target.height;
    out->picture[2] = exp2f(shown->exposure_ev);
    out->picture[3] = 20; /* pixels per frame at full brightness */
    out->mode[0] = mode->view ? mode->view->mode : mode->shader;
    out->mode[1] = mode->layer ? layer_of(s, mode->layer) : shown->item;
    out->mode[3] = shown->curve;
    fill_camera(camera, out);
    fill_layers(s, out);
}

/* ---- descriptors */

/* A storage buffer, or what replaces it. */
static void write_buffer(const view_picture *p, VkDescriptorSet set, uint32_t binding, VkBuffer buffer)
{
    host_set_write_buffer(p->device, set, binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                          buffer ? buffer : p->blank_buffer.buffer);
}

static void write_outputs(const view_picture *p, const shot *s, VkDescriptorSet set)
{
    const VkImageLayout read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    for (size_t i = 0; i < sizeof plate_bindings / sizeof plate_bindings[0]; i++) {
        const host_output output = plate_bindings[i].output;
        host_set_write_image(p->device, set, plate_bindings[i].binding, output == HOST_COLOR ? p->linear : p->nearest,
                             host_target_shown(&s->target, output)->view,
                             output == HOST_DEPTH ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL : read);
    }
    for (uint32_t i = 0; i < VIEW_LAYERS; i++) {
        const host_image *image = host_target_shown(&s->target, (host_output)(HOST_LAYER + i));
        host_set_write_image(p->device, set, VIEW_AT_LAYERS + i, p->linear, image->image ? image->view : p->blank.view,
                             read);
    }
}

static void write_set(const view_picture *p, const shot *s, const tool_view_data *data, VkDescriptorSet set,
                      const host_buffer *uniforms)
{
    const VkImageLayout read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    host_set_write_buffer(p->device, set, VIEW_AT_UNIFORMS, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, uniforms->buffer);
    write_outputs(p, s, set);
    host_set_write_image(p->device, set, VIEW_AT_ARRAY, p->nearest, data->array ? data->array : p->blank_array.view,
                         data->array ? data->array_layout : read);
    host_set_write_image(p->device, set, VIEW_AT_IMAGE, p->nearest, data->image ? data->image : p->blank.view,
                         data->image ? data->image_layout : read);
    for (uint32_t i = 0; i < 2; i++)
        write_buffer(p, set, VIEW_AT_BUFFERS + i, data->buffers[i]);
}

/* ---- recording */

/* Transitions outputs that are in the layout for copies. */
static void make_readable(VkCommandBuffer cmd, const shot *s)
{
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++) {
        const host_image *shown = host_target_shown(&s->target, (host_output)i);
        const bool readable = shown == &s->target.images[i] && (i == HOST_COLOR || i == HOST_DEPTH);
        if (shown->image && !readable)
            host_image_barrier(cmd, shown, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, drawing, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                               VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    }
}

void view_picture_begin(VkCommandBuffer cmd)
{
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                         VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                             VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                             VK_PIPELINE_STAGE_TRANSFER_BIT,
                         0, 0, NULL, 0, NULL, 0, NULL);
}

void view_picture_prepare(view_picture *p, VkCommandBuffer cmd, shot *s, const host_camera *camera,
                          const view_shown *shown)
{
    const uint32_t slot = (uint32_t)(p->device->frame % HOST_FRAMES);
    const view_mode_row *mode = view_mode(shown->mode);
    view_uniforms *uniforms = p->uniforms[slot].mapped;
    tool_view_data data = {.camera = camera, .item = shown->item, .own = uniforms->own};
    memset(uniforms, 0, sizeof *uniforms);
    fill(s, camera, shown, &uniforms->view);
    if (mode->view && mode->view->fill)
        mode->view->fill(s, s->states[mode->effect_index], &data);
    write_set(p, s, &data, p->bindings.sets[slot], &p->uniforms[slot]);
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
    const view_mode_row *mode = view_mode(shown->mode);
    const float size[2] = {(float)window->width, (float)window->height};
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, p->bindings.layout, 0, 1, &p->bindings.sets[slot], 0,
                            NULL);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, mode->view ? p->views[shown->mode] : p->picture);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    if (!mode->view || !mode->view->quad_count)
        return;
    const uint32_t quads = mode->view->quad_count(s->states[mode->effect_index], shown->item);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, p->quads[shown->mode]);
    vkCmdPushConstants(cmd, p->bindings.layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof size, size);
    vkCmdDraw(cmd, 6 * quads, 1, 0, 0);
}
