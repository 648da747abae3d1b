/* panorama.c - panoramas on the CPU. They are a few hundred pixels wide, so plain loops are fast enough. */
#include "panorama.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI           3.14159265358979f
#define HALF_MAX     65504.0f
#define BLUR_SAMPLES 192 /* fewer give speckles on smooth metal */

bool panorama_alloc(panorama *out, uint32_t width, uint32_t height)
{
    out->width = width;
    out->height = height;
    out->rgba = calloc((size_t)width * height * 4, sizeof *out->rgba);
    return out->rgba != NULL;
}

void panorama_free(panorama *p)
{
    free(p->rgba);
    memset(p, 0, sizeof *p);
}

bool panorama_from_rgb(const float *rgb, uint32_t width, uint32_t height, float gain, panorama *out)
{
    if (!panorama_alloc(out, width, height))
        return false;
    for (size_t i = 0; i < (size_t)width * height; i++) {
        for (int c = 0; c < 3; c++) {
            float value = rgb[i * 3 + (size_t)c] * gain;
            out->rgba[i * 4 + (size_t)c] = value > 0.0f ? fminf(value, HALF_MAX) : 0.0f;
        }
        out->rgba[i * 4 + 3] = 1.0f;
    }
    return true;
}

/* ---- scaling ------------------------------------------------------------------------------------------------ */

/* Weights of the four texels around position t in [0; 1) between the middle two (Catmull and Rom 1974). */
static void cubic(float t, float w[4])
{
    w[0] = t * (-0.5f + t * (1.0f - 0.5f * t));
    w[1] = 1.0f + t * t * (-2.5f + 1.5f * t);
    w[2] = t * (0.5f + t * (2.0f - 1.5f * t));
    w[3] = t * t * (-0.5f + 0.5f * t);
}

static const float *texel(const panorama *p, int64_t x, int64_t y)
{
    int64_t w = p->width, h = p->height;
    if (x < 0 || x >= w)
        x = ((x % w) + w) % w;
    y = y < 0 ? 0 : y >= h ? h - 1 : y;
    return &p->rgba[(y * w + x) * 4];
}

/* Interpolates between four texels in a row or column. Clamped to the middle two, because the cubic overshoots: dark
 * dots beside bright texels. */
static void sample_cubic(const float *texels[4], const float w[4], float out[4])
{
    for (int c = 0; c < 4; c++) {
        float sum = 0.0f;
        for (int i = 0; i < 4; i++)
            sum += w[i] * texels[i][c];
        const float a = texels[1][c], b = texels[2][c], low = a < b ? a : b, high = a < b ? b : a;
        out[c] = sum < low ? low : sum > high ? high : sum;
    }
}

/* Along one axis at a time: `across` is the panorama's x. The texels of a row or column lie `step` floats apart, and
 * which rows or columns are read depends on i alone. */
static bool enlarge(const panorama *in, uint32_t size, bool across, panorama *out)
{
    if (!panorama_alloc(out, across ? size : in->width, across ? in->height : size))
        return false;
    const float scale = (float)(across ? in->width : in->height) / (float)size;
    const uint32_t count = across ? in->height : in->width;
    const size_t step = across ? (size_t)in->width * 4 : 4, out_step = across ? (size_t)size * 4 : 4;
    for (uint32_t i = 0; i < size; i++) {
        float position = ((float)i + 0.5f) * scale - 0.5f, weights[4];
        int64_t first = (int64_t)floorf(position) - 1;
        cubic(position - floorf(position), weights);
        const float *texels[4];
        for (int k = 0; k < 4; k++)
            texels[k] = across ? texel(in, first + k, 0) : texel(in, 0, first + k);
        float *to = &out->rgba[across ? (size_t)i * 4 : (size_t)i * in->width * 4];
        for (uint32_t j = 0; j < count; j++, to += out_step) {
            sample_cubic(texels, weights, to);
            for (int k = 0; k < 4; k++)
                texels[k] += step;
        }
    }
    return true;
}

static void sample_box(const panorama *p, float x0, float y0, float x1, float y1, float out[4])
{
    float sum[4] = {0}, weight = 0.0f;
    for (int64_t y = (int64_t)y0; (float)y < y1; y++)
        for (int64_t x = (int64_t)x0; (float)x < x1; x++) {
            float w =
                (fminf((float)x + 1.0f, x1) - fmaxf((float)x, x0)) * (fminf((float)y + 1.0f, y1) - fmaxf((float)y, y0));
            const float *t = texel(p, x, y);
            for (int c = 0; c < 4; c++)
                sum[c] += w * t[c];
            weight += w;
        }
    for (int c = 0; c < 4; c++)
        out[c] = weight > 0.0f ? sum[c] / weight : 0.0f;
}

static bool shrink(const panorama *in, uint32_t width, uint32_t height, panorama *out)
{
    if (!panorama_alloc(out, width, height))
        return false;
    float sx = (float)in->width / (float)width, sy = (float)in->height / (float)height;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            float fx = (float)x, fy = (float)y;
            sample_box(in, fx * sx, fy * sy, (fx + 1.0f) * sx, (fy + 1.0f) * sy,
                       &out->rgba[((size_t)y * width + x) * 4]);
        }
    return true;
}

bool panorama_resize(const panorama *in, uint32_t width, uint32_t height, panorama *out)
{
    if (width <= in->width || height <= in->height)
        return shrink(in, width, height, out);
    panorama widened;
    bool ok = enlarge(in, width, true, &widened) && enlarge(&widened, height, false, out);
    panorama_free(&widened);
    return ok;
}

/* ---- light -------------------------------------------------------------------------------------------------- */

static void direction_of(const panorama *p, uint32_t x, uint32_t y, float rotation, float d[3])
{
    float azimuth = (((float)x + 0.5f) / (float)p->width - 0.5f) * 2.0f * PI - rotation;
    float polar = ((float)y + 0.5f) / (float)p->height * PI;
    d[0] = sinf(azimuth) * sinf(polar);
    d[1] = cosf(polar);
    d[2] = -cosf(azimuth) * sinf(polar);
}

/* Solid angle of a pixel in a row. */
static float solid_angle(const panorama *p, uint32_t y)
{
    float top = cosf((float)y / (float)p->height * PI), bottom = cosf(((float)y + 1.0f) / (float)p->height * PI);
    return (top - bottom) * 2.0f * PI / (float)p->width;
}

void panorama_mean(const panorama *p, float mean[3])
{
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t y = 0; y < p->height; y++) {
        double row[3] = {0.0, 0.0, 0.0};
        for (uint32_t x = 0; x < p->width; x++)
            for (size_t c = 0; c < 3; c++)
                row[c] += p->rgba[((size_t)y * p->width + x) * 4 + c];
        for (int c = 0; c < 3; c++)
            sum[c] += row[c] * solid_angle(p, y);
    }
    for (int c = 0; c < 3; c++)
        mean[c] = (float)(sum[c] / (4.0 * (double)PI));
}

void panorama_clamp(panorama *p, float limit)
{
    for (size_t i = 0; i < (size_t)p->width * p->height; i++) {
        float *t = &p->rgba[i * 4];
        float luminance = 0.2126f * t[0] + 0.7152f * t[1] + 0.0722f * t[2];
        if (luminance > limit)
            for (int c = 0; c < 3; c++)
                t[c] *= limit / luminance;
    }
}

void panorama_basis(const float d[3], float basis[9])
{
    float x = d[0], y = d[1], z = d[2];
    const float all[9] = {
        0.28209479f,
        0.48860251f * y,
        0.48860251f * z,
        0.48860251f * x,
        1.09254843f * x * y,
        1.09254843f * y * z,
        0.31539157f * (3.0f * z * z - 1.0f),
        1.09254843f * x * z,
        0.54627422f * (x * x - y * y),
    };
    memcpy(basis, all, sizeof all);
}

void panorama_project(const panorama *p, float rotation, float sh[9][3])
{
    double sum[9][3] = {{0}};
    for (uint32_t y = 0; y < p->height; y++) {
        float angle = solid_angle(p, y);
        for (uint32_t x = 0; x < p->width; x++) {
            float d[3], basis[9];
            direction_of(p, x, y, rotation, d);
            panorama_basis(d, basis);
            const float *t = &p->rgba[((size_t)y * p->width + x) * 4];
            for (int k = 0; k < 9; k++)
                for (int c = 0; c < 3; c++)
                    sum[k][c] += (double)(basis[k] * angle * t[c]);
        }
    }
    for (int k = 0; k < 9; k++)
        for (int c = 0; c < 3; c++)
            sh[k][c] = (float)sum[k][c];
}

/* ---- blur --------------------------------------------------------------------------------------------------- */

/* Reflected directions of a GGX lobe of this roughness around +Z, seen from +Z, with the cosine weight of Karis 2013.
 * */
static void lobe(float roughness, float samples[BLUR_SAMPLES][4])
{
    float a = fmaxf(roughness * roughness, 1e-3f);
    for (uint32_t i = 0; i < BLUR_SAMPLES; i++) {
        uint32_t bits = i;
        float u = ((float)i + 0.5f) / BLUR_SAMPLES, v = 0.0f, digit = 0.5f;
        for (; bits; bits >>= 1, digit *= 0.5f)
            v += (float)(bits & 1) * digit;
        float c = sqrtf((1.0f - u) / (1.0f + (a * a - 1.0f) * u)); /* of the half vector, Walter et al. 2007 */
        float s = sqrtf(fmaxf(1.0f - c * c, 0.0f)), phi = 2.0f * PI * v;
        samples[i][0] = 2.0f * c * s * cosf(phi);
        samples[i][1] = 2.0f * c * s * sinf(phi);
        samples[i][2] = 2.0f * c * c - 1.0f;
        samples[i][3] = fmaxf(samples[i][2], 0.0f);
    }
}

/* Where the samples of the lobe around the texel (0, y) of `out` fall: `column` and `row` of the texel of `in`, which
 * is as wide as `out`. Around (x, y) all lie x columns further, as the panorama turns about the vertical axis. */
static void find_lobe(const panorama *in, const panorama *out, uint32_t y, const float samples[BLUR_SAMPLES][4],
                      int64_t column[BLUR_SAMPLES], int64_t row[BLUR_SAMPLES])
{
    float n[3];
    direction_of(out, 0, y, 0.0f, n);
    const float flat = sqrtf(n[0] * n[0] + n[2] * n[2]); /* never 0: rows lie between the poles */
    const float side[3] = {n[2] / flat, 0.0f, -n[0] / flat};
    const float up[3] = {n[1] * side[2], n[2] * side[0] - n[0] * side[2], -n[1] * side[0]};
    for (int i = 0; i < BLUR_SAMPLES; i++) {
        float d[3];
        for (int c = 0; c < 3; c++)
            d[c] = samples[i][0] * side[c] + samples[i][1] * up[c] + samples[i][2] * n[c];
        const float u = atan2f(d[0], -d[2]) / (2.0f * PI) + 0.5f;
        const float v = acosf(fminf(fmaxf(d[1], -1.0f), 1.0f)) / PI;
        column[i] = (int64_t)(u * (float)in->width);
        row[i] = (int64_t)(v * (float)in->height);
    }
}

void panorama_blur(const panorama *in, float roughness, panorama *out)
{
    float samples[BLUR_SAMPLES][4];
    int64_t column[BLUR_SAMPLES], row[BLUR_SAMPLES];
    lobe(roughness, samples);
    for (uint32_t y = 0; y < out->height; y++) {
        find_lobe(in, out, y, samples, column, row);
        for (uint32_t x = 0; x < out->width; x++) {
            float sum[3] = {0}, weight = 0.0f;
            for (int i = 0; i < BLUR_SAMPLES; i++) {
                const float *t = texel(in, column[i] + x, row[i]);
                for (int c = 0; c < 3; c++)
                    sum[c] += samples[i][3] * t[c];
                weight += samples[i][3];
            }
            float *to = &out->rgba[((size_t)y * out->width + x) * 4];
            for (int c = 0; c < 3; c++)
                to[c] = sum[c] / weight;
            to[3] = 1.0f;
        }
    }
}
