/* renderer.c - what the plate is made of, and the recording of it: depth, colour, sky, glass. */
#include "renderer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "renderer_internal.h"

#define MIN_ROUGHNESS 0.04f /* below, a point light's glint falls between pixels */

/* ---- create and destroy ------------------------------------------------------------------------------------- */

static bool create_samplers(host_renderer *r, char *error, size_t error_size)
{
    return host_sampler_create(r->device, HOST_SAMPLE_TEXTURE, &r->mesh_sampler, error, error_size) &&
           host_sampler_create(r->device, HOST_SAMPLE_PANORAMA, &r->sky_sampler, error, error_size) &&
           host_sampler_create(r->device, HOST_SAMPLE_LINEAR, &r->volume_sampler, error, error_size) &&
           host_sampler_create(r->device, HOST_SAMPLE_NEAREST, &r->point_sampler, error, error_size);
}

static void write_image(const host_renderer *r, VkDescriptorSet set, uint32_t binding, VkSampler sampler,
                        const host_image *image)
{
    host_set_write_image(r->device, set, binding, sampler, image->view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

static bool create_frame_set(host_renderer *r, char *error, size_t error_size)
{
    if (!host_set_pool_create(r->device, &host_frame_shape, 1, &r->frame_pool, error, error_size) ||
        !host_sets_allocate(r->device, r->frame_pool, r->frame_layout, 1, &r->frame_set, error, error_size))
        return false;
    host_set_write_buffer(r->device, r->frame_set, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, r->frame_buffer.buffer);
    write_image(r, r->frame_set, 3, r->volume_sampler, &r->skylight.volume);
    write_image(r, r->frame_set, 4, r->point_sampler, &r->white);
    write_image(r, r->frame_set, 5, r->point_sampler, &r->blank_spots);
    write_image(r, r->frame_set, 6, r->volume_sampler, &r->white);
    write_image(r, r->frame_set, 7, r->volume_sampler, &r->white);
    write_image(r, r->frame_set, 8, r->point_sampler, &r->white);
    write_image(r, r->frame_set, 9, r->volume_sampler, &r->white);
    return true;
}

/* Bound where there is no ground. */
static bool create_blank_spots(host_renderer *r, char *error, size_t error_size)
{
    static const uint32_t none = 0;
    const host_image_def def = {.format = VK_FORMAT_R32_UINT, .extent = {1, 1, 1}, .name = "no spots"};
    return host_image_create_with(r->device, &def, &none, sizeof none, 4, &r->blank_spots, error, error_size);
}

static bool create_white(host_renderer *r, char *error, size_t error_size)
{
    static const uint8_t texel[4] = {255, 255, 255, 255};
    const host_image_def def = {.format = VK_FORMAT_R8G8B8A8_SRGB, .extent = {1, 1, 1}, .name = "white"};
    return host_image_create_with(r->device, &def, texel, sizeof texel, 4, &r->white, error, error_size);
}

bool host_renderer_create(host_device *device, const host_target *target, host_renderer **renderer, char *error,
                          size_t error_size)
{
    *renderer = NULL;
    host_renderer *r = calloc(1, sizeof *r);
    if (!r)
        return host_fail(error, error_size, "renderer: out of memory");
    r->device = device;
    r->next_id = 1;
    bool ok = create_samplers(r, error, error_size) &&
              host_buffer_create(device, sizeof(struct host_frame_gpu),
                                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                 HOST_BUFFER_DEVICE, "plate frame", &r->frame_buffer, error, error_size) &&
              create_white(r, error, error_size) && create_blank_spots(r, error, error_size) &&
              host_renderer_build_pipelines(r, target->plate_pass, error, error_size) &&
              host_skylight_create(device, r->material_layout, &r->skylight, error, error_size) &&
              create_frame_set(r, error, error_size);
    if (!ok)
        host_renderer_destroy(&r);
    *renderer = r;
    return ok;
}

void host_renderer_destroy(host_renderer **renderer)
{
    host_renderer *r = renderer ? *renderer : NULL;
    if (!r)
        return;
    VkDevice vk = r->device->device;
    for (uint32_t i = 0; i < r->entry_count; i++) {
        vkDestroyDescriptorPool(vk, r->entries[i].pool, NULL);
        free(r->entries[i].sets);
    }
    free(r->entries);
    for (int i = 0; i < HOST_PIPELINE_COUNT * 2; i++) {
        vkDestroyPipeline(vk, r->pipelines[i / 2][i % 2], NULL);
        vkDestroyPipeline(vk, r->mirror_pipelines[i / 2][i % 2], NULL);
    }
    vkDestroyDescriptorPool(vk, r->frame_pool, NULL);
    vkDestroyPipelineLayout(vk, r->layout, NULL);
    vkDestroyDescriptorSetLayout(vk, r->material_layout, NULL);
    vkDestroyDescriptorSetLayout(vk, r->frame_layout, NULL);
    vkDestroySampler(vk, r->volume_sampler, NULL);
    vkDestroySampler(vk, r->point_sampler, NULL);
    vkDestroySampler(vk, r->sky_sampler, NULL);
    vkDestroySampler(vk, r->mesh_sampler, NULL);
    host_skylight_destroy(r->device, &r->skylight);
    host_mirror_destroy(r->device, &r->mirror);
    host_image_destroy(r->device, &r->white);
    host_image_destroy(r->device, &r->blank_spots);
    host_buffer_destroy(r->device, &r->frame_buffer);
    free(r);
    *renderer = NULL;
}

/* ---- what is drawn ------------------------------------------------------------------------------------------ */

static const host_image *texture_or_white(const host_renderer *r, const host_mesh *mesh, int32_t texture)
{
    return texture >= 0 && mesh->textures[texture].image ? &mesh->textures[texture] : &r->white;
}

static bool create_material_sets(host_renderer *r, host_entry *entry, char *error, size_t error_size)
{
    const host_mesh *mesh = entry->mesh;
    if (!host_set_pool_create(r->device, &host_material_shape, mesh->material_count, &entry->pool, error, error_size) ||
        !host_sets_allocate(r->device, entry->pool, r->material_layout, mesh->material_count, entry->sets, error,
                            error_size))
        return false;
    for (uint32_t i = 0; i < mesh->material_count; i++) {
        const host_material *material = &mesh->materials[i];
        write_image(r, entry->sets[i], 0, r->mesh_sampler, texture_or_white(r, mesh, material->base_texture));
        write_image(r, entry->sets[i], 1, r->mesh_sampler, texture_or_white(r, mesh, material->emissive_texture));
    }
    return true;
}

bool host_renderer_add(host_renderer *r, const host_mesh *mesh, char *error, size_t error_size)
{
    host_entry *entries = realloc(r->entries, (r->entry_count + 1) * sizeof *entries);
    if (!entries)
        return host_fail(error, error_size, "renderer: out of memory");
    r->entries = entries;
    host_entry *entry = &entries[r->entry_count++]; /* from here on destroy frees what is in it */
    *entry = (host_entry){.mesh = mesh, .first_id = r->next_id};
    entry->sets = calloc(mesh->material_count, sizeof *entry->sets);
    if (!entry->sets)
        return host_fail(error, error_size, "renderer: out of memory");
    if (!create_material_sets(r, entry, error, error_size))
        return false;
    r->next_id += mesh->primitive_count;
    r->skylight.ready = false;
    return true;
}

bool host_renderer_set_environment(host_renderer *r, const host_environment *environment, char *error,
                                   size_t error_size)
{
    if (!environment->sky.image || !environment->reflection.image)
        return host_fail(error, error_size, "renderer: the environment was not created");
    r->environment = environment;
    write_image(r, r->frame_set, 1, r->sky_sampler, &environment->sky);
    write_image(r, r->frame_set, 2, r->sky_sampler, &environment->reflection);
    return true;
}

void host_renderer_set_ground(host_renderer *r, const virga_ground_maps *maps)
{
    const bool other = maps && maps->wetness != r->ground.wetness;
    r->ground = maps ? *maps : (virga_ground_maps){0};
    if (other) {
        const VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL;
        host_set_write_image(r->device, r->frame_set, 4, r->point_sampler, maps->wetness, general);
        host_set_write_image(r->device, r->frame_set, 5, r->point_sampler, maps->spots, general);
        host_set_write_image(r->device, r->frame_set, 6, r->volume_sampler, maps->ripples, general);
        if (maps->far_wetness)
            host_set_write_image(r->device, r->frame_set, 8, r->point_sampler, maps->far_wetness, general);
    }
}

bool host_renderer_set_mirror(host_renderer *r, const host_target *target, double height_m, char *error,
                              size_t error_size)
{
    r->mirror_m = height_m;
    if (r->mirror.width || !r->device->clip_distance)
        return true;
    const uint32_t width = (target->width + 1) / 2, height = (target->height + 1) / 2;
    if (!host_mirror_create(r->device, width, height, &r->mirror, error, error_size) ||
        !host_renderer_build_mirror(r, error, error_size))
        return false;
    write_image(r, r->frame_set, 7, r->volume_sampler, &r->mirror.color);
    write_image(r, r->frame_set, 9, r->volume_sampler, &r->mirror.near);
    return true;
}

void host_renderer_haze_mirror(host_renderer *r, host_draw_haze draw, void *user)
{
    r->draw_haze = draw;
    r->haze_user = user;
}

bool host_renderer_describe_mirror(const host_renderer *r, virga_target_def *def)
{
    def->kind = VIRGA_TARGET_RENDER_PASS;
    def->render_pass = r->mirror.haze_pass;
    def->subpass = 0;
    def->color_formats[0] = r->mirror.color.format;
    def->color_count = 1;
    def->samples = VK_SAMPLE_COUNT_1_BIT;
    def->depth_attached = false;
    def->reversed_depth = false;
    return r->mirror.width > 0;
}

void host_renderer_set_lights(host_renderer *r, const virga_light *lights, uint32_t count)
{
    r->light_count = count < HOST_MAX_LIGHTS ? count : HOST_MAX_LIGHTS;
    if (r->light_count > 0)
        memcpy(r->lights, lights, r->light_count * sizeof *lights);
}

const host_primitive *host_renderer_primitive(const host_renderer *r, uint32_t id)
{
    for (uint32_t i = 0; i < r->entry_count; i++) {
        const host_entry *entry = &r->entries[i];
        if (id >= entry->first_id && id - entry->first_id < entry->mesh->primitive_count)
            return &entry->mesh->primitives[id - entry->first_id];
    }
    return NULL;
}

/* ---- the frame's numbers ------------------------------------------------------------------------------------ */

/* Clip from a point relative to the camera: the rotation of the view and the projection. */
static void clip_from_relative(const host_camera *camera, const float clip_from_view[16], float out[16])
{
    float rotation[16];
    memcpy(rotation, camera->view_from_world, sizeof rotation);
    rotation[12] = rotation[13] = rotation[14] = 0.0f;
    host_matrix_multiply(clip_from_view, rotation, out);
}

/* Directions of pixels, from the rows of the view rotation and the projection's scale and jitter. */
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

/* Harmonics with the factors of the basis and of the cosine lobe over pi in them (Ramamoorthi and Hanrahan 2001). */
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

/* Worth drawing where there is a ground, and the picture's lower edge looks down at it. */
static void fill_mirror(const host_renderer *r, const host_camera *camera, struct host_frame_gpu *frame)
{
    const float lowest = frame->ray_z[1] - fabsf(frame->ray_x[1]) - fabsf(frame->ray_y[1]);
    frame->mirror[0] = (float)(r->mirror_m - camera->position_m[1]);
    frame->mirror[1] = 1.0f / HOST_MIRROR_MARGIN;
    frame->mirror[2] = r->mirror.width && r->ground.cells && frame->mirror[0] < 0.0f && lowest < 0.0f;
}

static void fill_frame(const host_renderer *r, const host_target *target, const host_camera *camera,
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
    frame->sampling[0] = 1.0f / (float)(camera->samples ? camera->samples : 1);
    fill_irradiance(r->environment->sh, frame->irradiance);
    fill_ground(&r->ground, camera, frame);
    fill_mirror(r, camera, frame);
    for (uint32_t i = 0; i < r->light_count; i++)
        fill_light(&r->lights[i], camera, &frame->lights[i]);
}

/* ---- recording ---------------------------------------------------------------------------------------------- */

/* Writes the frame's numbers in line with the commands, so that any number of plates may be in one command buffer. */
static void record_frame(const host_renderer *r, VkCommandBuffer cmd, const struct host_frame_gpu *frame)
{
    host_buffer_update(cmd, &r->frame_buffer, frame, sizeof *frame,
                       VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                       VK_ACCESS_UNIFORM_READ_BIT);
}

static void fill_surface(const host_primitive *primitive, const host_material *material, uint32_t id,
                         struct host_surface_gpu *out)
{
    float bits = 0.0f;
    bits += material->base_texture >= 0 ? HOST_HAS_BASE_TEXTURE : 0;
    bits += material->emissive_texture >= 0 ? HOST_HAS_EMISSIVE_TEXTURE : 0;
    bits += material->alpha == HOST_ALPHA_GLASS ? HOST_IS_GLASS : 0;
    bits += primitive->ground ? HOST_GROUND * (1 + primitive->surface) : 0;
    memcpy(out->base_color, material->base_color, sizeof out->base_color);
    memcpy(out->emissive, material->emissive, 3 * sizeof(float));
    out->emissive[3] = fmaxf(material->roughness, MIN_ROUGHNESS);
    out->traits[0] = material->metallic;
    out->traits[1] = material->cutoff;
    out->traits[2] = (float)id;
    out->traits[3] = bits;
}

/* Which of the pipelines a material goes through in the two rounds before and after the sky. */
static bool goes_through(const host_material *material, host_pipeline kind)
{
    switch (kind) {
    case HOST_PIPELINE_DEPTH: return material->alpha == HOST_ALPHA_OPAQUE;
    case HOST_PIPELINE_CUTOUT: return material->alpha == HOST_ALPHA_MASK;
    case HOST_PIPELINE_SHADE: return material->alpha != HOST_ALPHA_GLASS;
    case HOST_PIPELINE_GLASS: return material->alpha == HOST_ALPHA_GLASS;
    default: return false;
    }
}

typedef const VkPipeline (*pipelines)[2]; /* the plate's, or the mirror's */

static void draw_entry(const host_renderer *r, VkCommandBuffer cmd, const host_entry *entry, pipelines from,
                       host_pipeline kind)
{
    const host_mesh *mesh = entry->mesh;
    const VkDeviceSize offset = 0;
    vkCmdBindVertexBuffers(cmd, 0, 1, &mesh->vertices.buffer, &offset);
    vkCmdBindIndexBuffer(cmd, mesh->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    int bound = -1;
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const host_primitive *primitive = &mesh->primitives[i];
        const host_material *material = &mesh->materials[primitive->material];
        if (!goes_through(material, kind))
            continue;
        if (bound != material->two_sided) {
            bound = material->two_sided;
            vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, from[kind][bound]);
        }
        struct host_surface_gpu surface;
        fill_surface(primitive, material, entry->first_id + i, &surface);
        vkCmdPushConstants(cmd, r->layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof surface, &surface);
        vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r->layout, 1, 1,
                                &entry->sets[primitive->material], 0, NULL);
        vkCmdDrawIndexed(cmd, primitive->index_count, 1, primitive->first_index, 0, 0);
    }
}

static void draw_entries(const host_renderer *r, VkCommandBuffer cmd, pipelines from, host_pipeline kind)
{
    const bool mirrored = from == (pipelines)r->mirror_pipelines;
    for (uint32_t i = 0; i < r->entry_count; i++)
        if (!mirrored || !r->entries[i].mesh->apart)
            draw_entry(r, cmd, &r->entries[i], from, kind);
}

static void draw_scene(const host_renderer *r, VkCommandBuffer cmd, pipelines from)
{
    draw_entries(r, cmd, from, HOST_PIPELINE_DEPTH);
    draw_entries(r, cmd, from, HOST_PIPELINE_CUTOUT);
    draw_entries(r, cmd, from, HOST_PIPELINE_SHADE);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, from[HOST_PIPELINE_SKY][1]);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    draw_entries(r, cmd, from, HOST_PIPELINE_GLASS);
}

/* ---- skylight ----------------------------------------------------------------------------------------------- */

static void find_bounds(const host_renderer *r, float low[3], float high[3])
{
    for (int c = 0; c < 3; c++) {
        low[c] = r->entry_count ? r->entries[0].mesh->low[c] : -1.0f;
        high[c] = r->entry_count ? r->entries[0].mesh->high[c] : 1.0f;
        for (uint32_t i = 1; i < r->entry_count && !r->entries[i].mesh->apart; i++) {
            low[c] = fminf(low[c], r->entries[i].mesh->low[c]);
            high[c] = fmaxf(high[c], r->entries[i].mesh->high[c]);
        }
    }
}

/* Everything but glass, into the map of one direction of the sky. */
static void draw_map(const host_renderer *r, VkCommandBuffer cmd, uint32_t direction, bool cutouts)
{
    const host_skylight *s = &r->skylight;
    const VkDeviceSize offset = 0;
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, cutouts ? s->cutout : s->opaque);
    host_skylight_push(s, cmd, direction, 1.0f, 0.0f);
    for (uint32_t e = 0; e < r->entry_count; e++) {
        const host_entry *entry = &r->entries[e];
        const host_mesh *mesh = entry->mesh;
        if (mesh->apart)
            continue;
        vkCmdBindVertexBuffers(cmd, 0, 1, &mesh->vertices.buffer, &offset);
        vkCmdBindIndexBuffer(cmd, mesh->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
        for (uint32_t i = 0; i < mesh->primitive_count; i++) {
            const host_primitive *primitive = &mesh->primitives[i];
            const host_material *material = &mesh->materials[primitive->material];
            if (!goes_through(material, cutouts ? HOST_PIPELINE_CUTOUT : HOST_PIPELINE_DEPTH))
                continue;
            if (cutouts) {
                host_skylight_push(s, cmd, direction, material->base_color[3], material->cutoff);
                vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, s->draw_layout, 0, 1,
                                        &entry->sets[primitive->material], 0, NULL);
            }
            vkCmdDrawIndexed(cmd, primitive->index_count, 1, primitive->first_index, 0, 0);
        }
    }
}

static void update_skylight(host_renderer *r, VkCommandBuffer cmd, const host_camera *camera)
{
    float low[3], high[3];
    find_bounds(r, low, high);
    if (!host_skylight_place(&r->skylight, camera->position_m, low, high))
        return;
    host_label_begin(r->device, cmd, "skylight");
    host_skylight_begin(&r->skylight, cmd);
    for (uint32_t i = 0; i < HOST_SKYLIGHT_DIRECTIONS; i++) {
        host_skylight_begin_map(&r->skylight, cmd, i);
        draw_map(r, cmd, i, false);
        draw_map(r, cmd, i, true);
        host_skylight_end_map(&r->skylight, cmd);
    }
    host_skylight_gather(&r->skylight, cmd);
    host_label_end(r->device, cmd);
}

/* ---- the plate ---------------------------------------------------------------------------------------------- */

/* The world from under the plane, as shaders/scene.vert and mirror_jitter.glsl have it. */
static virga_view view_of_mirror(const host_renderer *r, const host_camera *camera)
{
    virga_view view = virga_default_view();
    const float sides[2] = {(float)r->mirror.width, (float)r->mirror.height};
    const float plate[2] = {(float)camera->width, (float)camera->height}, small = 1.0f / HOST_MIRROR_MARGIN;
    host_camera_view(camera, camera, 0, &view);
    view.position_m[1] = 2 * r->mirror_m - camera->position_m[1];
    view.open_position_m[1] = view.position_m[1];
    for (int row = 0; row < 3; row++)
        view.view_from_world[4 + row] = view.open_view_from_world[4 + row] = -camera->view_from_world[4 + row];
    for (int axis = 0; axis < 2; axis++) {
        const float jitter = camera->jitter_px[axis] * (2.0f / sides[axis] - 2.0f * small / plate[axis]);
        view.clip_from_view[axis * 5] *= small;
        view.clip_from_view[8 + axis] = view.clip_from_view[8 + axis] * small - jitter; /* times -w */
        view.viewport[2 + axis] = sides[axis];
    }
    memcpy(view.open_clip_from_view, view.clip_from_view, sizeof view.clip_from_view);
    view.depth = (virga_image){
        .image = r->mirror.depth.image,
        .view = r->mirror.depth.view,
        .format = r->mirror.depth.format,
        .extent = {r->mirror.width, r->mirror.height, 1},
        .before = {VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                   VK_ACCESS_SHADER_READ_BIT},
    };
    return view;
}

static void record_mirror_haze(const host_renderer *r, VkCommandBuffer cmd, const host_camera *camera)
{
    const double plane[4] = {0, 1, 0, r->mirror_m};
    const virga_view view = view_of_mirror(r, camera);
    host_mirror_begin_haze(&r->mirror, cmd);
    r->draw_haze(r->haze_user, cmd, &view, plane);
    vkCmdEndRenderPass(cmd);
}

/* Begun even where it is not worth drawing: what the plate's shaders may sample has to be in its layout. */
static void record_mirror(const host_renderer *r, VkCommandBuffer cmd, const struct host_frame_gpu *frame,
                          const host_camera *camera)
{
    if (!r->mirror.width)
        return;
    host_label_begin(r->device, cmd, "mirror");
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r->layout, 0, 1, &r->frame_set, 0, NULL);
    host_mirror_begin(&r->mirror, cmd);
    if (frame->mirror[2] > 0.0f)
        draw_scene(r, cmd, (pipelines)r->mirror_pipelines);
    vkCmdEndRenderPass(cmd);
    if (frame->mirror[2] > 0.0f && r->draw_haze)
        record_mirror_haze(r, cmd, camera);
    host_mirror_copy_down(&r->mirror, cmd);
    host_label_end(r->device, cmd);
}

void host_renderer_plate(host_renderer *r, VkCommandBuffer cmd, const host_target *target, const host_camera *camera,
                         const host_camera *previous)
{
    struct host_frame_gpu frame;
    update_skylight(r, cmd, camera);
    fill_frame(r, target, camera, previous, &frame);
    record_frame(r, cmd, &frame);
    record_mirror(r, cmd, &frame, camera);
    host_label_begin(r->device, cmd, "plate");
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r->layout, 0, 1, &r->frame_set, 0, NULL);
    host_target_begin_plate(target, cmd);
    draw_scene(r, cmd, (pipelines)r->pipelines);
    host_target_end_plate(target, cmd);
    host_label_end(r->device, cmd);
}
