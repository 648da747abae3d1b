/* renderer.c - what a renderer draws: meshes, environment, lights, ground and mirror, and their descriptors. */
#include "renderer.h"

#include <stdlib.h>
#include <string.h>

#include "renderer_internal.h"

#define SHELTER_TEXELS 2048

/* ---- descriptors -------------------------------------------------------------------------------------------- */

/* An image that is only sampled, or the maps of the ground, which the simulation writes. */
static void write_view(const host_renderer *r, uint32_t binding, host_sampling sampling, VkImageView view,
                       VkImageLayout layout)
{
    host_set_write_image(r->device, r->bindings.sets[0], binding, r->samplers[sampling], view, layout);
}

static void write_image(const host_renderer *r, uint32_t binding, host_sampling sampling, const host_image *image)
{
    write_view(r, binding, sampling, image->view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

/* What the renderer has from the start. Without a ground or a mirror the shaders read white images. */
static void write_frame(const host_renderer *r)
{
    host_set_write_buffer(r->device, r->bindings.sets[0], FRAME_AT_UNIFORMS, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                          r->frame_buffer.buffer);
    write_image(r, FRAME_AT_SKYLIGHT, HOST_SAMPLE_LINEAR, &r->skylight.volume);
    write_image(r, FRAME_AT_WETNESS, HOST_SAMPLE_NEAREST, &r->white);
    write_image(r, FRAME_AT_SPOTS, HOST_SAMPLE_NEAREST, &r->blank_spots);
    write_image(r, FRAME_AT_RIPPLES, HOST_SAMPLE_LINEAR, &r->white);
    write_image(r, FRAME_AT_MIRROR, HOST_SAMPLE_LINEAR, &r->white);
    write_image(r, FRAME_AT_FAR_WETNESS, HOST_SAMPLE_NEAREST, &r->white);
    write_image(r, FRAME_AT_MIRROR_NEAR, HOST_SAMPLE_LINEAR, &r->white);
    write_image(r, FRAME_AT_SHELTER, HOST_SAMPLE_NEAREST, &r->white);
    write_image(r, FRAME_AT_CONTACT, HOST_SAMPLE_NEAREST, &r->white);
}

/* ---- create and destroy ------------------------------------------------------------------------------------- */

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

bool host_renderer_create(host_device *device, host_renderer **renderer, char *error, size_t error_size)
{
    *renderer = NULL;
    host_renderer *r = calloc(1, sizeof *r);
    if (!r)
        return host_fail(error, error_size, "renderer: out of memory");
    r->device = device;
    r->next_id = 1;
    bool ok = host_samplers_create(device, r->samplers, error, error_size) &&
              host_buffer_create(device, sizeof(struct host_frame_gpu),
                                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                 HOST_BUFFER_DEVICE, "plate frame", &r->frame_buffer, error, error_size) &&
              create_white(r, error, error_size) && create_blank_spots(r, error, error_size) &&
              host_renderer_create_bindings(r, error, error_size) &&
              host_skylight_create(device, r->material_layout, &r->skylight, error, error_size) &&
              host_contact_create(device, r->skylight.pass, &r->contact, error, error_size);
    if (ok)
        write_frame(r);
    else
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
    vkDestroyDescriptorPool(vk, r->footage_pool, NULL);
    for (int i = 0; i < HOST_PIPELINE_COUNT * 2; i++) {
        vkDestroyPipeline(vk, r->pipelines[i / 2][i % 2], NULL);
        vkDestroyPipeline(vk, r->mirror_pipelines[i / 2][i % 2], NULL);
    }
    host_bindings_destroy(r->device, &r->bindings);
    vkDestroyDescriptorSetLayout(vk, r->material_layout, NULL);
    host_samplers_destroy(r->device, r->samplers);
    host_skylight_destroy(r->device, &r->skylight);
    host_shelter_destroy(r->device, &r->shelter);
    host_contact_destroy(r->device, &r->contact);
    host_mirror_destroy(r->device, &r->mirror);
    host_reuse_destroy(r->device, &r->reuse);
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
        const int32_t textures[2] = {mesh->materials[i].base_texture, mesh->materials[i].emissive_texture};
        for (uint32_t k = 0; k < 2; k++)
            host_set_write_image(r->device, entry->sets[i], k, r->samplers[HOST_SAMPLE_TEXTURE],
                                 texture_or_white(r, mesh, textures[k])->view,
                                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
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
    write_image(r, FRAME_AT_SKY, HOST_SAMPLE_PANORAMA, &environment->sky);
    write_image(r, FRAME_AT_REFLECTION, HOST_SAMPLE_PANORAMA, &environment->reflection);
    return true;
}

void host_renderer_set_parts(host_renderer *r, host_plate_parts parts)
{
    r->parts = parts;
}

void host_renderer_set_contact(host_renderer *r, bool on)
{
    r->has_contact = on;
}

void host_renderer_set_meniscus(host_renderer *r, bool on)
{
    r->has_meniscus = on;
}

void host_renderer_set_ground(host_renderer *r, const virga_ground_maps *maps)
{
    const bool other = maps && maps->wetness != r->ground.wetness;
    r->ground = maps ? *maps : (virga_ground_maps){0};
    if (other) {
        write_image(r, FRAME_AT_CONTACT, HOST_SAMPLE_LINEAR, &r->contact.shade);
        write_view(r, FRAME_AT_WETNESS, HOST_SAMPLE_NEAREST, maps->wetness, VK_IMAGE_LAYOUT_GENERAL);
        write_view(r, FRAME_AT_SPOTS, HOST_SAMPLE_NEAREST, maps->spots, VK_IMAGE_LAYOUT_GENERAL);
        write_view(r, FRAME_AT_RIPPLES, HOST_SAMPLE_LINEAR, maps->ripples, VK_IMAGE_LAYOUT_GENERAL);
        if (maps->far_wetness)
            write_view(r, FRAME_AT_FAR_WETNESS, HOST_SAMPLE_NEAREST, maps->far_wetness, VK_IMAGE_LAYOUT_GENERAL);
    }
}

bool host_renderer_set_walls(host_renderer *r, const virga_walls *walls, char *error, size_t error_size)
{
    r->has_walls = walls;
    if (!walls)
        return true;
    r->walls = *walls;
    if (r->shelter.slice.framebuffer)
        return true;
    if (!host_shelter_create(r->device, r->skylight.pass, SHELTER_TEXELS, &r->shelter, error, error_size))
        return false;
    write_view(r, FRAME_AT_SHELTER, HOST_SAMPLE_NEAREST, r->shelter.map.view,
               VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    return true;
}

bool host_renderer_set_mirror(host_renderer *r, const host_target *target, double height_m, char *error,
                              size_t error_size)
{
    r->mirror_m = height_m;
    if (r->mirror.width || !r->device->clip_distance)
        return true;
    const uint32_t width = (target->width + 1) / 2, height = (target->height + 1) / 2;
    if (!host_mirror_create(r->device, width, height, &r->mirror, error, error_size))
        return false;
    write_image(r, FRAME_AT_MIRROR, HOST_SAMPLE_LINEAR, &r->mirror.color);
    write_image(r, FRAME_AT_MIRROR_NEAR, HOST_SAMPLE_LINEAR, &r->mirror.near);
    return true;
}

bool host_renderer_set_reuse(host_renderer *r, const host_target *target, char *error, size_t error_size)
{
    return host_reuse_create(r->device, target, &r->reuse, error, error_size);
}

bool host_renderer_set_footage(host_renderer *r, const host_target *target, const host_mesh *ground, char *error,
                               size_t error_size)
{
    r->footage = ground;
    if (!r->device->independent_blend)
        return host_fail(error, error_size, "this device cannot draw wet ground over footage (independentBlend)");
    if (!r->footage_pool &&
        (!host_set_pool_create(r->device, &host_material_shape, 1, &r->footage_pool, error, error_size) ||
         !host_sets_allocate(r->device, r->footage_pool, r->material_layout, 1, &r->footage_set, error, error_size)))
        return false;
    host_set_write_image(r->device, r->footage_set, 0, r->samplers[HOST_SAMPLE_LINEAR], target->images[HOST_COLOR].view,
                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    host_set_write_image(r->device, r->footage_set, 1, r->samplers[HOST_SAMPLE_NEAREST],
                         target->images[HOST_DEPTH].view, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
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
