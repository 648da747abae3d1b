/* texture.c - textures of a mesh. Mip levels are averages in linear light, weighted by alpha, so that the color of cut-
 * out texels does not bleed into edges. */
#include "texture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#pragma GCC diagnostic ignored "-Wunused-function" /* the warning is reported at the end of the file, so it stays off */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#define MAX_SIDE 16384u

/* ---- decoding ----------------------------------------------------------------------------------------------- */

bool host_picture_from_rgba(const uint8_t *rgba, uint32_t width, uint32_t height, host_picture *picture)
{
    memset(picture, 0, sizeof *picture);
    if (width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE)
        return false;
    size_t size = (size_t)width * height * 4;
    picture->texels = malloc(size);
    if (!picture->texels)
        return false;
    memcpy(picture->texels, rgba, size);
    picture->width = width;
    picture->height = height;
    picture->levels = 1;
    picture->size = size;
    for (size_t i = 3; i < size && !picture->alpha; i += 4)
        picture->alpha = rgba[i] != 255;
    return true;
}

static bool copy_texels(stbi_uc *rgba, int width, int height, const char *what, host_picture *picture, char *error,
                        size_t error_size)
{
    if (!rgba)
        return host_fail(error, error_size, "%s: cannot be decoded: %s", what, stbi_failure_reason());
    bool ok = host_picture_from_rgba(rgba, (uint32_t)width, (uint32_t)height, picture);
    stbi_image_free(rgba);
    return ok || host_fail(error, error_size, "%s: no memory for %d x %d texels (at most %u on a side)", what, width,
                           height, MAX_SIDE);
}

bool host_picture_decode(const void *data, size_t size, const char *what, host_picture *picture, char *error,
                         size_t error_size)
{
    int width = 0, height = 0, channels = 0;
    memset(picture, 0, sizeof *picture);
    if (size > INT32_MAX)
        return host_fail(error, error_size, "%s: larger than 2 GiB", what);
    stbi_uc *rgba = stbi_load_from_memory(data, (int)size, &width, &height, &channels, 4);
    return copy_texels(rgba, width, height, what, picture, error, error_size);
}

bool host_picture_read(const char *path, host_picture *picture, char *error, size_t error_size)
{
    int width = 0, height = 0, channels = 0;
    memset(picture, 0, sizeof *picture);
    stbi_uc *rgba = stbi_load(path, &width, &height, &channels, 4);
    return copy_texels(rgba, width, height, path, picture, error, error_size);
}

void host_picture_free(host_picture *picture)
{
    free(picture->texels);
    memset(picture, 0, sizeof *picture);
}

/* ---- what it holds ------------------------------------------------------------------------------------------ */

float host_picture_alpha(const host_picture *picture, float u, float v)
{
    u -= floorf(u);
    v -= floorf(v);
    uint32_t x = (uint32_t)(u * (float)picture->width), y = (uint32_t)(v * (float)picture->height);
    x = x < picture->width ? x : picture->width - 1;
    y = y < picture->height ? y : picture->height - 1;
    return (float)picture->texels[((size_t)y * picture->width + x) * 4 + 3] / 255.0f;
}

void host_picture_mean(const host_picture *picture, float mean[4])
{
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    size_t count = (size_t)picture->width * picture->height;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 4; c++)
            sum[c] += picture->texels[i * 4 + c];
    for (int c = 0; c < 4; c++)
        mean[c] = (float)(sum[c] / (255.0 * (double)count));
}

bool host_picture_add_joints(const host_picture *color, const host_picture *occlusion, host_picture *out)
{
    if (!host_picture_from_rgba(color->texels, color->width, color->height, out))
        return false;
    for (uint32_t y = 0; y < color->height; y++)
        for (uint32_t x = 0; x < color->width; x++) {
            const size_t ox = (size_t)x * occlusion->width / color->width,
                         oy = (size_t)y * occlusion->height / color->height;
            out->texels[4 * ((size_t)y * color->width + x) + 3] = occlusion->texels[4 * (oy * occlusion->width + ox)];
        }
    out->joints = true;
    return true;
}

/* ---- mips --------------------------------------------------------------------------------------------------- */

static float linear_of[256];

static void fill_table(void)
{
    for (int i = 0; i < 256; i++) {
        float s = (float)i / 255.0f;
        linear_of[i] = s <= 0.04045f ? s / 12.92f : powf((s + 0.055f) / 1.055f, 2.4f);
    }
}

float host_picture_light(const host_picture *picture)
{
    double sum = 0, weight = 0;
    fill_table();
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++) {
        const uint8_t *texel = &picture->texels[4 * i];
        const double light = linear_of[texel[0]] + linear_of[texel[1]] + linear_of[texel[2]];
        sum += (double)texel[3] * light / 3;
        weight += texel[3];
    }
    return weight > 0 ? (float)(sum / weight) : 0;
}

static uint8_t srgb_of(float linear)
{
    float s = linear <= 0.0031308f ? linear * 12.92f : 1.055f * powf(linear, 1.0f / 2.4f) - 0.055f;
    return (uint8_t)(s * 255.0f + 0.5f);
}

static uint32_t half_of(uint32_t size)
{
    return size > 1 ? size / 2 : 1;
}

/* One texel of a level from up to four of the level above, weighted by alpha or all alike. */
static void average(const uint8_t *above, uint32_t width, uint32_t height, uint32_t x, uint32_t y, bool alike,
                    uint8_t out[4])
{
    float weighted[3] = {0}, plain[3] = {0}, alpha = 0.0f;
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t sx = 2 * x + (i & 1), sy = 2 * y + (i >> 1);
        sx = sx < width ? sx : width - 1;
        sy = sy < height ? sy : height - 1;
        const uint8_t *texel = &above[((size_t)sy * width + sx) * 4];
        float a = (float)texel[3] / 255.0f;
        alpha += a;
        for (int c = 0; c < 3; c++) {
            weighted[c] += a * linear_of[texel[c]];
            plain[c] += linear_of[texel[c]];
        }
    }
    for (int c = 0; c < 3; c++)
        out[c] = srgb_of(alpha > 0.0f && !alike ? weighted[c] / alpha : plain[c] / 4.0f);
    out[3] = (uint8_t)(alpha / 4.0f * 255.0f + 0.5f);
}

static float coverage(const uint8_t *texels, size_t count, float cutoff, float scale)
{
    size_t covered = 0;
    for (size_t i = 0; i < count; i++)
        covered += (float)texels[i * 4 + 3] / 255.0f * scale >= cutoff;
    return (float)covered / (float)count;
}

/* Scales the alpha of a level so that the same share of texels passes the cutoff as in the first one (Castano 2010). */
static void keep_coverage(uint8_t *texels, size_t count, float cutoff, float wanted)
{
    float low = 0.0f, high = 8.0f;
    for (int i = 0; i < 10; i++) {
        float middle = 0.5f * (low + high);
        if (coverage(texels, count, cutoff, middle) < wanted)
            low = middle;
        else
            high = middle;
    }
    /* With few texels the share moves in steps: use the nearer one. */
    float above = coverage(texels, count, cutoff, high) - wanted, below = wanted - coverage(texels, count, cutoff, low);
    float scale = below < above ? low : high;
    for (size_t i = 0; i < count; i++) {
        float a = (float)texels[i * 4 + 3] * scale;
        texels[i * 4 + 3] = (uint8_t)(a < 255.0f ? a + 0.5f : 255.0f);
    }
}

/* Gives cut-out texels the color of the next smaller level, coarsest first, because bilinear filtering mixes it in. */
static void dilate(uint8_t *level, const uint8_t *below, uint32_t width, uint32_t height)
{
    uint32_t below_width = half_of(width), below_height = half_of(height);
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            uint8_t *texel = &level[((size_t)y * width + x) * 4];
            uint32_t bx = x / 2 < below_width ? x / 2 : below_width - 1;
            uint32_t by = y / 2 < below_height ? y / 2 : below_height - 1;
            if (texel[3] == 0)
                memcpy(texel, &below[((size_t)by * below_width + bx) * 4], 3);
        }
    }
}

bool host_picture_make_mips(host_picture *picture, float cutoff)
{
    size_t offsets[32], total = 0;
    uint32_t widths[32], heights[32], levels = 0;
    for (uint32_t w = picture->width, h = picture->height;; w = half_of(w), h = half_of(h)) {
        widths[levels] = w;
        heights[levels] = h;
        offsets[levels++] = total;
        total += (size_t)w * h * 4;
        if (w == 1 && h == 1)
            break;
    }
    uint8_t *texels = realloc(picture->texels, total);
    if (!texels)
        return false;
    picture->texels = texels;
    picture->levels = levels;
    picture->size = total;
    fill_table();
    for (uint32_t l = 1; l < levels; l++)
        for (uint32_t y = 0; y < heights[l]; y++)
            for (uint32_t x = 0; x < widths[l]; x++)
                average(texels + offsets[l - 1], widths[l - 1], heights[l - 1], x, y, picture->joints,
                        texels + offsets[l] + ((size_t)y * widths[l] + x) * 4);
    if (picture->alpha)
        for (uint32_t l = levels - 1; l-- > 0;)
            dilate(texels + offsets[l], texels + offsets[l + 1], widths[l], heights[l]);
    if (picture->alpha && cutoff > 0.0f) {
        float wanted = coverage(texels, (size_t)widths[0] * heights[0], cutoff, 1.0f);
        for (uint32_t l = 1; l < levels; l++)
            keep_coverage(texels + offsets[l], (size_t)widths[l] * heights[l], cutoff, wanted);
    }
    return true;
}

bool host_picture_upload(host_device *device, const host_picture *picture, const char *name, host_image *image,
                         char *error, size_t error_size)
{
    host_image_def def = {
        .format = VK_FORMAT_R8G8B8A8_SRGB,
        .extent = {picture->width, picture->height, 1},
        .levels = picture->levels,
        .name = name,
    };
    uint32_t limit = device->properties.limits.maxImageDimension2D;
    if (picture->width > limit || picture->height > limit)
        return host_fail(error, error_size, "%s: %u x %u is more than this device's %u", name, picture->width,
                         picture->height, limit);
    return host_image_create_with(device, &def, picture->texels, picture->size, 4, image, error, error_size);
}
