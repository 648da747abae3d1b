/* environment.c - sky, reflections and diffuse light from one panorama. */
#include "environment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "panorama.h"

#define SUN_LIMIT     32.0f /* times the mean luminance; above, harmonics of degree 2 ring and the blur has speckles */
#define SKY_MIN_WIDTH 2048  /* smaller panoramas are upsampled to this width, because their texels would show */
#define SKY_MAX_WIDTH 8192
#define LIGHT_WIDTH   256 /* harmonics are computed at this size */
#define BLUR_WIDTH    128 /* size of each reflection level */

host_environment_def host_default_environment(void)
{
    return (host_environment_def){
        .zenith = {0.75f, 0.82f, 0.92f},
        .horizon = {1.0f, 1.0f, 1.0f},
        .ground = {0.25f, 0.24f, 0.22f},
        .intensity = 1.0f,
    };
}

/* ---- the panorama ------------------------------------------------------------------------------------------- */

/* A gradient from zenith to horizon, and the ground below. */
static bool make_sky(const host_environment_def *def, panorama *out)
{
    if (!panorama_alloc(out, 256, 128))
        return false;
    for (uint32_t y = 0; y < out->height; y++) {
        float elevation = cosf(((float)y + 0.5f) / (float)out->height * 3.14159265f);
        float t = elevation > 0.0f ? sqrtf(elevation) : 0.0f;
        float below = fminf(fmaxf(-elevation * 24.0f, 0.0f), 1.0f);
        for (uint32_t x = 0; x < out->width; x++) {
            float *to = &out->rgba[((size_t)y * out->width + x) * 4];
            for (int c = 0; c < 3; c++) {
                float sky = def->horizon[c] + t * (def->zenith[c] - def->horizon[c]);
                to[c] = def->intensity * (sky + below * (def->ground[c] - sky));
            }
            to[3] = 1.0f;
        }
    }
    return true;
}

static bool load(const host_environment_def *def, panorama *out, char *error, size_t error_size)
{
    if (!(def->intensity >= 0.0f) || !isfinite(def->intensity) || !isfinite(def->rotation_deg))
        return host_fail(error, error_size, "environment: intensity and rotation_deg must be finite, intensity >= 0");
    if (def->pixels && (def->width < 2 || def->height < 2))
        return host_fail(error, error_size, "environment: %u x %u pixels are no panorama", def->width, def->height);
    bool ok =
        def->pixels ? panorama_from_rgb(def->pixels, def->width, def->height, def->intensity, out) : make_sky(def, out);
    return ok || host_fail(error, error_size, "environment: out of memory");
}

/* ---- onto the device ---------------------------------------------------------------------------------------- */

static uint16_t half_from(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    int32_t exponent = (int32_t)(bits >> 23 & 0xff) - 112;
    if (exponent <= 0)
        return 0; /* such small values are not visible */
    if (exponent >= 31)
        return 0x7bff;
    uint32_t rounded = ((uint32_t)exponent << 10 | (bits >> 13 & 0x3ff)) + (bits >> 12 & 1);
    return rounded < 0x7bff ? (uint16_t)rounded : 0x7bff;
}

/* Full floats on software devices if they can be filtered, because these are fastest there; else half floats. */
static bool upload(host_device *device, const float *rgba, VkExtent3D extent, const char *name, host_image *image,
                   char *error, size_t error_size)
{
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(device->physical, VK_FORMAT_R32G32B32A32_SFLOAT, &properties);
    bool full = device->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU &&
                (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT);
    host_image_def def = {
        .format = full ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT,
        .extent = extent,
        .name = name,
    };
    size_t count = (size_t)extent.width * extent.height * extent.depth * 4;
    uint16_t *halves = full ? NULL : malloc(count * sizeof *halves);
    if (!full && !halves)
        return host_fail(error, error_size, "%s: out of memory", name);
    for (size_t i = 0; halves && i < count; i++)
        halves[i] = half_from(rgba[i]);
    uint32_t texel = full ? 16 : 8;
    bool ok = host_image_create_with(device, &def, full ? (const void *)rgba : halves, count / 4 * texel, texel, image,
                                     error, error_size);
    free(halves);
    return ok;
}

static bool make_sky_image(host_device *device, const panorama *source, host_image *image, char *error,
                           size_t error_size)
{
    uint32_t limit = device->properties.limits.maxImageDimension2D;
    uint32_t widest = limit < SKY_MAX_WIDTH ? limit : SKY_MAX_WIDTH, width = source->width;
    if (width < SKY_MIN_WIDTH)
        width = SKY_MIN_WIDTH;
    if (width > widest)
        width = widest;
    panorama scaled;
    if (!panorama_resize(source, width, width / 2, &scaled))
        return host_fail(error, error_size, "environment: out of memory");
    bool ok = upload(device, scaled.rgba, (VkExtent3D){width, width / 2, 1}, "sky", image, error, error_size);
    panorama_free(&scaled);
    return ok;
}

static bool make_reflection(host_device *device, const panorama *source, host_image *image, char *error,
                            size_t error_size)
{
    const uint32_t width = BLUR_WIDTH, height = BLUR_WIDTH / 2;
    panorama small = {0}, all = {0};
    bool ok =
        panorama_resize(source, width, height, &small) && panorama_alloc(&all, width, height * HOST_REFLECTION_LEVELS);
    if (!ok)
        host_fail(error, error_size, "environment: out of memory");
    size_t level_floats = (size_t)width * height * 4;
    for (uint32_t level = 0; ok && level < HOST_REFLECTION_LEVELS; level++) {
        panorama out = {width, height, all.rgba + level * level_floats};
        if (level == 0)
            memcpy(out.rgba, small.rgba, level_floats * sizeof(float));
        else
            panorama_blur(&small, (float)level / (HOST_REFLECTION_LEVELS - 1), &out);
    }
    ok = ok && upload(device, all.rgba, (VkExtent3D){width, height, HOST_REFLECTION_LEVELS}, "reflection", image, error,
                      error_size);
    panorama_free(&all);
    panorama_free(&small);
    return ok;
}

static bool build(host_device *device, const panorama *source, host_environment *environment, char *error,
                  size_t error_size)
{
    if (!make_sky_image(device, source, &environment->sky, error, error_size))
        return false;
    panorama light;
    uint32_t width = source->width < LIGHT_WIDTH ? source->width : LIGHT_WIDTH;
    if (!panorama_resize(source, width, width / 2, &light))
        return host_fail(error, error_size, "environment: out of memory");
    float mean[3];
    panorama_mean(&light, mean);
    environment->brightest = SUN_LIMIT * (0.2126f * mean[0] + 0.7152f * mean[1] + 0.0722f * mean[2]);
    panorama_clamp(&light, environment->brightest);
    panorama_project(&light, environment->rotation, environment->sh);
    bool ok = make_reflection(device, &light, &environment->reflection, error, error_size);
    panorama_free(&light);
    return ok;
}

bool host_environment_create(host_device *device, const host_environment_def *def, host_environment *environment,
                             char *error, size_t error_size)
{
    memset(environment, 0, sizeof *environment);
    panorama source = {0};
    if (!load(def, &source, error, error_size))
        return false;
    environment->rotation = def->rotation_deg * 3.14159265f / 180.0f;
    bool ok = build(device, &source, environment, error, error_size);
    panorama_free(&source);
    if (!ok)
        host_environment_destroy(device, environment);
    return ok;
}

void host_environment_destroy(host_device *device, host_environment *environment)
{
    host_image_destroy(device, &environment->sky);
    host_image_destroy(device, &environment->reflection);
    memset(environment, 0, sizeof *environment);
}

/* ---- harmonics ---------------------------------------------------------------------------------------------- */

void host_environment_radiance(const host_environment *environment, const float direction[3], float rgb[3])
{
    float basis[9];
    panorama_basis(direction, basis);
    memset(rgb, 0, 3 * sizeof *rgb);
    for (int k = 0; k < 9; k++)
        for (int c = 0; c < 3; c++)
            rgb[c] += basis[k] * environment->sh[k][c];
    for (int c = 0; c < 3; c++)
        rgb[c] = fmaxf(rgb[c], 0.0f);
}

/* The cosine lobe's factors of each degree: Ramamoorthi and Hanrahan 2001. */
void host_environment_irradiance(const float sh[9][3], const float normal[3], float rgb[3])
{
    static const float factor[9] = {3.14159265f, 2.09439510f, 2.09439510f, 2.09439510f, 0.78539816f,
                                    0.78539816f, 0.78539816f, 0.78539816f, 0.78539816f};
    float basis[9];
    panorama_basis(normal, basis);
    memset(rgb, 0, 3 * sizeof *rgb);
    for (int k = 0; k < 9; k++)
        for (int c = 0; c < 3; c++)
            rgb[c] += factor[k] * basis[k] * sh[k][c];
    for (int c = 0; c < 3; c++)
        rgb[c] = fmaxf(rgb[c], 0.0f);
}

float host_environment_white(const host_environment *environment)
{
    const float up[3] = {0, 1, 0};
    float rgb[3];
    host_environment_irradiance(environment->sh, up, rgb);
    return fmaxf(rgb[0], fmaxf(rgb[1], rgb[2])) / 3.14159265f;
}
