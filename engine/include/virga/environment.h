/* virga/environment.h - the environment's light from a host's images: a cube map, a panorama, or the picture itself.
 *
 * Water shows the environment as nine spherical harmonics (virga_lighting.environment_sh), and simulated water mirrors
 * a panorama (virga_water_environment). This makes both from what a host has, on the device:
 *
 *     virga_environment_record(environment, cmd, &info);     // outside rendering, when the light has changed
 *
 * and in any later frame, before the scene is recorded:
 *
 *     if (virga_environment_harmonics(environment, lighting.environment_sh))
 *         virga_scene_lighting_set(scene, &lighting);
 *
 * The harmonics come back when the frame has completed, late by the frames in flight. The panorama is ready at once.
 *
 * Deterministic: the same image gives the same bits on one device. Thread-safety: as virga/vulkan.h says. */
#ifndef VIRGA_ENVIRONMENT_H
#define VIRGA_ENVIRONMENT_H

#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_environment virga_environment; /* opaque */

typedef struct virga_environment_def {
    uint32_t size, cookie;

    /* [1; 4096] texels along the panorama that is made, for virga_water_environment; its height is half of that. 12
     * bytes of device memory per column and row. 1: no panorama. Default 1. */
    uint32_t panorama_width;
} virga_environment_def;

VIRGA_API virga_environment_def virga_default_environment_def(void);

typedef struct virga_environment_settings {
    uint32_t size, cookie;

    /* [0; 1e6] factor of all light, e.g. the host's exposure. Default 1. */
    float gain;
} virga_environment_settings;

VIRGA_API virga_environment_settings virga_default_environment_settings(void);

/* Allocates, and builds pipelines when virga_context_def.pipeline_build_mode says so. Errors as virga_context_create;
 * *environment is NULL then. */
VIRGA_API virga_result virga_environment_create(virga_context *context, const virga_environment_def *def,
                                                virga_environment **environment);

/* Destroys it and sets *environment to NULL. Accepts NULL. Frames in flight may still use it. */
VIRGA_API void virga_environment_destroy(virga_environment **environment);

/* Returns VIRGA_OK if its pipelines are built, VIRGA_NOT_READY if some are missing, or the error of one that could not
 * be built. Costs nothing. */
VIRGA_API virga_result virga_environment_ready(const virga_environment *environment);

/* Applies new settings from the next record on. Out of range: clamped, logged, VIRGA_DEGRADED. NaN, infinity or a wrong
 * cookie: VIRGA_ERROR_INVALID, and nothing changes. */
VIRGA_API virga_result virga_environment_set(virga_environment *environment,
                                             const virga_environment_settings *settings);

/* Reads the current settings. Does nothing for NULL. */
VIRGA_API void virga_environment_get(const virga_environment *environment, virga_environment_settings *settings);

/* Returns the device memory in bytes that virga_environment_create will allocate at most. */
VIRGA_API VkDeviceSize virga_environment_estimate(const virga_environment_def *def);

typedef enum virga_environment_kind {
    /* Equirectangular, as virga_water_environment has it: row 0 is straight up (+Y), the middle column looks along -Z,
     * columns run towards +X. A 2D view. */
    VIRGA_ENVIRONMENT_PANORAMA = 0,

    /* A cube map, looked up as Vulkan does. A view of the type CUBE. */
    VIRGA_ENVIRONMENT_CUBE = 1,

    /* The host's picture of a view, e.g. of the last frame: it stands for the part of the surroundings that it shows,
     * and rest_sh for all others. A 2D view; the viewport of `view` is read. */
    VIRGA_ENVIRONMENT_PICTURE = 2,
} virga_environment_kind;

typedef struct virga_environment_info {
    virga_environment_kind kind;

    /* Required. `before` is its layout; its contents are visible to compute shaders when the device executes the call,
     * and the image lives until then. Integers are refused. */
    virga_image image;

    /* [1; 16384] pixels of its first level; of a cube map, along a face. Not read for a picture. */
    uint32_t width, height;

    /* How its values stand for light. Default VIRGA_ENCODING_NOT_GIVEN: linear. */
    virga_encoding encoding;

    /* (panorama, cube) Rotation from Virga's world to the image's: three rows. For images whose up is not +Y. All zero:
     * none. */
    float image_from_world[9];

    /* (picture) Required: the camera of the picture. */
    const virga_view *view;

    /* (picture) What is around beyond the picture, as virga_lighting.environment_sh. */
    float rest_sh[9][3];
} virga_environment_info;

/* Reads the image, and computes harmonics and panorama. Outside rendering, once in a frame. Costs one read of each
 * texel of the image's first level: about 10 ms per million on two cores of software Vulkan, so record it when the
 * light has changed.
 *
 * VIRGA_ERROR_INVALID: an image is missing, of a wrong format, or with wrong sizes; a wrong view. */
VIRGA_API virga_result virga_environment_record(virga_environment *environment, VkCommandBuffer cmd,
                                                const virga_environment_info *info);

/* Reads the harmonics of the newest completed frame that recorded them, and returns its number. 0: there is none, and
 * `sh` stays as it is. */
VIRGA_API uint64_t virga_environment_harmonics(virga_environment *environment, float sh[9][3]);

/* The panorama: R16G16B16A16_SFLOAT, in VK_IMAGE_LAYOUT_GENERAL; ready to be read by compute and fragment shaders after
 * the record. Give it to virga_water_environment. All zero before the first record, and with a panorama_width of 1. */
VIRGA_API void virga_environment_panorama(const virga_environment *environment, virga_image *panorama);

#ifdef __cplusplus
}
#endif
#endif
