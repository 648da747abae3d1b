/* png.c - PNG and JPEG through stb, PNG as numbers, and the tone curve of previews. */
#include "png.h"

#include "file.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* stb declares functions that the macros below leave undefined. GCC warns at the end of the file, after any pop. */
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS PNG_MAX_SIDE
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#define MAX_FILE ((size_t)1 << 30) /* bytes */

static bool refuse(char *error, size_t error_size, const char *verb, const char *path, const char *reason)
{
    return file_fail(error, error_size, "cannot %s %s: %s", verb, path, reason);
}

static void append_bytes(void *user, void *data, int size)
{
    file_write(user, data, (size_t)size);
}

bool png_write(const char *path, uint32_t width, uint32_t height, uint32_t channels, const uint8_t *pixels, char *error,
               size_t error_size)
{
    file_writer file;
    if (!width || !height || width > PNG_MAX_SIDE || height > PNG_MAX_SIDE ||
        (channels != 1 && channels != 3 && channels != 4))
        return refuse(error, error_size, "write", path, "expected 1 to 16384 pixels a side, grey, RGB or RGBA");
    /* stb has sizes as int and doubles its buffers. */
    if (((uint64_t)width * channels + 1) * height > INT_MAX / 2)
        return refuse(error, error_size, "write", path, "larger than 1 GiB");
    if (!file_start(&file, path, error, error_size))
        return false;
    if (stbi_write_png_to_func(append_bytes, &file, (int)width, (int)height, (int)channels, pixels, 0))
        return file_finish(&file, error, error_size);
    file_abandon(&file);
    return refuse(error, error_size, "write", path, "no memory");
}

bool png_read_memory(const void *data, size_t size, const char *what, uint32_t *width, uint32_t *height, uint8_t **rgba,
                     char *error, size_t error_size)
{
    int across = 0, down = 0, channels = 0;
    *width = *height = 0;
    *rgba = NULL;
    if (!size)
        return refuse(error, error_size, "read", what, "the file is empty");
    if (size > MAX_FILE)
        return refuse(error, error_size, "read", what, "larger than 1 GiB");
    /* stb tries one format after the other, and its reason is about the last one. */
    if (!stbi_info_from_memory(data, (int)size, &across, &down, &channels))
        return refuse(error, error_size, "read", what,
                      "not a PNG or JPEG picture of at most 16384 pixels on each side");
    *rgba = stbi_load_from_memory(data, (int)size, &across, &down, &channels, 4);
    if (!*rgba) {
        char reason[96];
        snprintf(reason, sizeof reason, "the picture is damaged: %s", stbi_failure_reason());
        return refuse(error, error_size, "read", what, reason);
    }
    *width = (uint32_t)across;
    *height = (uint32_t)down;
    return true;
}

bool png_read(const char *path, uint32_t *width, uint32_t *height, uint8_t **rgba, char *error, size_t error_size)
{
    void *data;
    size_t size;
    *width = *height = 0;
    *rgba = NULL;
    if (!file_read(path, MAX_FILE, &data, &size, error, error_size))
        return false;
    bool ok = png_read_memory(data, size, path, width, height, rgba, error, error_size);
    free(data);
    return ok;
}

/* ---- numbers */

/* Offsets in the first chunk of a PNG, and values there. */
enum { CHUNKS = 8, DEPTH = 24, COLOR = 25, FIRST_END = 33, GREY = 0, PALETTE = 3 };

static bool is_png(const uint8_t *data, size_t size)
{
    static const uint8_t begins[16] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R'};
    return size >= FIRST_END && !memcmp(data, begins, sizeof begins);
}

/* stb returns the colors of a palette, never its indices. But it returns grey values unchanged, and it does not check
 * checksums. So this declares the picture as grey. The chunk with the transparency of palette entries would be wrong in
 * a grey picture, so it gets a name that stb skips. */
static void call_grey(uint8_t *png, size_t size)
{
    static const uint8_t unread[4] = {'s', 'k', 'i', 'p'};
    png[COLOR] = GREY;
    for (size_t at = CHUNKS; size - at >= 12;) {
        uint8_t *chunk = png + at;
        const size_t length = (size_t)chunk[0] << 24 | (size_t)chunk[1] << 16 | (size_t)chunk[2] << 8 | chunk[3];
        if (!memcmp(chunk + 4, "tRNS", 4))
            memcpy(chunk + 4, unread, sizeof unread);
        if (length > size - at - 12)
            return;
        at += length + 12;
    }
}

/* Keeps the first channel of each pixel, in place. stb scales grey values of fewer bits to 8 bits, which is right for
 * grey, but not for indices. */
static void keep_first_channel(uint8_t *pixels, size_t count, int channels, int stretch)
{
    for (size_t i = 0; i < count; i++)
        pixels[i] = (uint8_t)(pixels[i * (size_t)channels] / stretch);
}

static bool numbers_from_memory(uint8_t *data, size_t size, const char *path, uint32_t *width, uint32_t *height,
                                uint8_t **numbers, char *error, size_t error_size)
{
    int across = 0, down = 0, channels = 0, stretch = 1;
    if (size > MAX_FILE || !is_png(data, size) || !stbi_info_from_memory(data, (int)size, &across, &down, &channels))
        return refuse(error, error_size, "read", path, "not a PNG picture of at most 16384 pixels on each side");
    if (data[DEPTH] > 8)
        return refuse(error, error_size, "read", path, "expected 8 bits a channel, got 16");
    if (data[COLOR] == PALETTE) {
        stretch = 255 / ((1 << data[DEPTH]) - 1);
        call_grey(data, size);
    }
    *numbers = stbi_load_from_memory(data, (int)size, &across, &down, &channels, 0);
    if (!*numbers) {
        char reason[96];
        snprintf(reason, sizeof reason, "the picture is damaged: %s", stbi_failure_reason());
        return refuse(error, error_size, "read", path, reason);
    }
    keep_first_channel(*numbers, (size_t)across * (size_t)down, channels, stretch);
    *width = (uint32_t)across;
    *height = (uint32_t)down;
    return true;
}

bool png_read_numbers(const char *path, uint32_t *width, uint32_t *height, uint8_t **numbers, char *error,
                      size_t error_size)
{
    void *data;
    size_t size;
    *width = *height = 0;
    *numbers = NULL;
    if (!file_read(path, MAX_FILE, &data, &size, error, error_size))
        return false;
    const bool ok = numbers_from_memory(data, size, path, width, height, numbers, error, error_size);
    free(data);
    return ok;
}

/* ---- light to bytes */

/* With u = (x - a) / (1 - a), the shoulder is y = a + (1 - a) u (1 + u / w^2) / (1 + u) (the extended curve of Reinhard
 * et al. 2002): slope 1 at u = 0, y = 1 at u = w. Here a = 0.6 and x = 8 gives 1, so w = 7.4 / 0.4 = 18.5. */
static float shoulder(float linear)
{
    const float knee = 0.6f, room = 1.0f - 0.6f, white = (8.0f - 0.6f) / room;
    if (linear <= knee)
        return linear;
    if (linear >= 8.0f)
        return 1.0f;
    float u = (linear - knee) / room;
    return fminf(1.0f, knee + room * u * (1.0f + u / (white * white)) / (1.0f + u));
}

/* Krzysztof Narkowicz, "ACES Filmic Tone Mapping Curve", 2015. */
static float filmic(float linear)
{
    const float x = fminf(0.6f * linear, 1e6f); /* squares stay finite */
    return fminf(1.0f, x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f));
}

float png_tone(png_curve curve, float linear)
{
    if (!(linear > 0.0f))
        return 0.0f;
    if (curve == PNG_CURVE_NONE)
        return fminf(1.0f, linear);
    return curve == PNG_CURVE_FILMIC ? filmic(linear) : shoulder(linear);
}

static uint8_t srgb_byte(float linear)
{
    float coded = linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1.0f / 2.4f) - 0.055f;
    return (uint8_t)lrintf(255.0f * fminf(1.0f, fmaxf(0.0f, coded)));
}

void png_from_linear(const float *rgba, size_t pixels, float exposure_ev, png_curve curve, uint8_t *rgb)
{
    float gain = exp2f(exposure_ev);
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            rgb[i * 3 + c] = srgb_byte(png_tone(curve, gain * rgba[i * 4 + c]));
}
