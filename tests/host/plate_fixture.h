/* plate_fixture.h - a device with validation, for tests that draw. Tests are skipped on a machine without a device. */
#ifndef VIRGA_TESTS_PLATE_FIXTURE_H
#define VIRGA_TESTS_PLATE_FIXTURE_H

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host.h"
#include "stuck.h"

typedef struct fixture {
    host_instance instance;
    host_device device;
    char error[1024];
    char warning[1024]; /* the last warning */
} fixture;

static inline void fixture_warn(void *user, const char *text)
{
    fixture *f = user;
    snprintf(f->warning, sizeof f->warning, "%s", text);
}

/* The software driver and the layer stay loaded: a leak checker cannot name functions of unloaded libraries and would
 * report false leaks. */
static inline void fixture_keep_loaded(void)
{
    dlopen("libvulkan_lvp.so", RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
    dlopen("libVkLayer_khronos_validation.so", RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
}

/* Validation is on if the layer is installed. With VIRGA_VALIDATE=1 it is required. */
static inline bool fixture_begin(fixture *f)
{
    host_device_info infos[HOST_MAX_DEVICES];
    uint32_t index = 0;
    memset(f, 0, sizeof *f);
    stuck_watch();
    if (!host_instance_create(&f->instance, true, f->error, sizeof f->error) &&
        !host_instance_create(&f->instance, false, f->error, sizeof f->error))
        return false;
    uint32_t count = host_devices_list(&f->instance, infos, HOST_MAX_DEVICES);
    if (!host_device_pick(infos, count, NULL, &index, f->error, sizeof f->error) ||
        !host_device_create(&f->device, &f->instance, &infos[index], f->error, sizeof f->error)) {
        host_instance_destroy(&f->instance);
        return false;
    }
    fixture_keep_loaded();
    f->device.warn = fixture_warn;
    f->device.warn_user = f;
    return true;
}

/* Live objects plus validation messages of all destroyed devices: 0 if all is correct. */
static uint32_t fixture_wrong;

/* Returns the number for this device. */
static inline uint32_t fixture_end(fixture *f)
{
    const uint32_t live = host_device_destroy(&f->device);
    host_instance_destroy(&f->instance);
    fixture_wrong += live + f->instance.messages;
    return live + f->instance.messages;
}

/* What cmocka calls before and after a group of tests: a scene of `size` bytes that begins with a fixture, all zero,
 * which `build` fills. Without a device the tests are skipped. */
static inline int fixture_set_up(void **state, size_t size, bool (*build)(void *scene))
{
    fixture *f = calloc(1, size);
    *state = f;
    if (!f || !fixture_begin(f)) {
        fprintf(stderr, "no device to draw with: %s\n", f ? f->error : "no memory");
        exit(77);
    }
    if (build(f))
        return 0;
    fprintf(stderr, "%s\n", f->error);
    return -1;
}

/* After all that the scene holds is destroyed; frees the scene. */
static inline int fixture_tear_down(fixture *f)
{
    const uint32_t wrong = fixture_end(f);
    if (wrong)
        fprintf(stderr, "live objects and validation messages: %u\n", wrong);
    free(f);
    return wrong ? -1 : 0;
}

/* A picture of the plate alone, in one sub-frame. */
static inline bool fixture_plate(fixture *f, host_renderer *renderer, host_target *target, host_accumulator *sums,
                                 const host_camera *camera, host_drawn *picture)
{
    host_device *device = &f->device;
    VkCommandBuffer cmd;
    const size_t size = sizeof f->error;
    host_accumulator_reset(sums);
    if (!host_begin_frame(device, &cmd, f->error, size) ||
        !host_renderer_plate(renderer, cmd, target, camera, camera, f->error, size))
        return false;
    host_target_begin_layer(target, cmd);
    host_target_end_layer(target, cmd);
    if (!host_accumulator_add(sums, cmd, target, false, f->error, size))
        return false;
    host_accumulator_copy_out(sums, cmd, target);
    if (!host_submit(device, f->error, size) || !host_wait(device, f->error, size))
        return false;
    host_accumulator_finish(sums, target, picture);
    return true;
}

/* A map of the ground's water as virga_ground_maps has it, in the layout that its reader expects. `texels` are of
 * `texel` bytes. */
static inline bool fixture_map(fixture *f, VkFormat format, uint32_t width, uint32_t height, const void *texels,
                               uint32_t texel, host_image *image)
{
    const host_image_def def = {
        .format = format,
        .extent = {width, height, 1},
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
        .name = "map of water",
    };
    const size_t size = sizeof f->error;
    VkCommandBuffer cmd;
    if (!host_image_create(&f->device, &def, image, f->error, size) ||
        !host_image_upload(&f->device, image, texels, (VkDeviceSize)width * height * texel, texel, f->error, size) ||
        !host_begin_frame(&f->device, &cmd, f->error, size))
        return false;
    host_image_barrier(cmd, image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    return host_submit(&f->device, f->error, size) && host_wait(&f->device, f->error, size);
}

/* The exit code of main, from the number of failed cases: cmocka does not count the teardown of a group. */
static inline int fixture_result(int failed)
{
    return failed + (int)fixture_wrong;
}

/* What tests of the plate have in common. First in a test's own scene, for fixture_set_up. */
typedef struct plate_scene {
    fixture base;
    host_target target;
    host_renderer *renderer;
    host_environment environment;
    host_accumulator sums;
    host_drawn picture;
} plate_scene;

/* Without meshes. False: base.error says why. */
static inline bool plate_open(plate_scene *p, uint32_t width, uint32_t height, const host_environment_def *sky)
{
    host_device *device = &p->base.device;
    char *error = p->base.error;
    const size_t size = sizeof p->base.error;
    return host_target_create(device, width, height, &p->target, error, size) &&
           host_renderer_create(device, &p->renderer, error, size) &&
           host_environment_create(device, sky, &p->environment, error, size) &&
           host_renderer_set_environment(p->renderer, &p->environment, error, size) &&
           host_accumulator_create(device, width, height, &p->sums, error, size) &&
           host_drawn_create(width, height, &p->picture, error, size);
}

/* Adds a flat mesh of two triangles, with one normal. */
static inline bool plate_add_quad(plate_scene *p, const float corners[4][3], const float normal[3],
                                  const host_material *material, host_mesh *mesh)
{
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    host_vertex v[4] = {{.uv = {0}}};
    for (int i = 0; i < 4; i++) {
        memcpy(v[i].position, corners[i], sizeof v[i].position);
        memcpy(v[i].normal, normal, sizeof v[i].normal);
    }
    return host_mesh_create(&p->base.device, v, 4, indices, 6, material, mesh, p->base.error, sizeof p->base.error) &&
           host_renderer_add(p->renderer, mesh, p->base.error, sizeof p->base.error);
}

/* Before the meshes are destroyed, and these before fixture_tear_down. */
static inline void plate_close(plate_scene *p)
{
    host_accumulator_destroy(&p->sums);
    host_drawn_destroy(&p->picture);
    host_renderer_destroy(&p->renderer);
    host_environment_destroy(&p->base.device, &p->environment);
    host_target_destroy(&p->base.device, &p->target);
}

#endif
