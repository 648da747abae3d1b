/* accumulate.c - sums and means of sub-frames on the CPU. */
#include "accumulate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool host_accumulator_create(host_accumulator *a, uint32_t width, uint32_t height, char *error, size_t error_size)
{
    size_t pixels = (size_t)width * height;
    *a = (host_accumulator){.width = width, .height = height};
    a->color = calloc(pixels, 4 * sizeof(float));
    a->normal = calloc(pixels, 4 * sizeof(float));
    a->velocity = calloc(pixels, 2 * sizeof(float));
    a->water = calloc(pixels, 2 * sizeof(float));
    a->depth = calloc(pixels, sizeof(float));
    a->id = calloc(pixels, sizeof(uint32_t));
    bool made = a->color && a->normal && a->velocity && a->water && a->depth && a->id;
    for (int i = 0; i < HOST_MAX_LAYERS; i++) {
        a->layers[i] = calloc(pixels, 4 * sizeof(float));
        made = made && a->layers[i];
    }
    if (made)
        return true;
    host_accumulator_destroy(a);
    return host_fail(error, error_size, "no memory for a picture of %u x %u", width, height);
}

void host_accumulator_destroy(host_accumulator *a)
{
    free(a->color);
    for (int i = 0; i < HOST_MAX_LAYERS; i++)
        free(a->layers[i]);
    free(a->normal);
    free(a->velocity);
    free(a->water);
    free(a->depth);
    free(a->id);
    free(a->weights);
    free(a->weight_sums);
    memset(a, 0, sizeof *a);
}

void host_accumulator_reset(host_accumulator *a)
{
    a->samples = 0;
}

float *host_accumulator_weigh(host_accumulator *a, char *error, size_t error_size)
{
    const size_t pixels = (size_t)a->width * a->height;
    a->weights = a->weights ? a->weights : calloc(pixels, sizeof(float));
    a->weight_sums = a->weight_sums ? a->weight_sums : calloc(pixels, sizeof(float));
    if (!a->weights || !a->weight_sums)
        host_fail(error, error_size, "no memory for a picture of %u x %u", a->width, a->height);
    return a->weight_sums ? a->weights : NULL;
}

/* The first sample is stored instead of added, so that a reset need not clear anything. */
static void add(const host_accumulator *a, float *sum, const float *values, size_t channels)
{
    const size_t pixels = (size_t)a->width * a->height;
    if (!a->samples)
        memset(sum, 0, pixels * channels * sizeof *sum);
    if (!a->weights) {
        for (size_t i = 0; i < pixels * channels; i++)
            sum[i] += values[i];
        return;
    }
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < channels; c++)
            sum[i * channels + c] += a->weights[i] * values[i * channels + c];
}

static void add_layers(host_accumulator *a, const host_device *device, const host_target *target, bool first, bool keep)
{
    const size_t values = (size_t)a->width * a->height * 4;
    a->layer_count = target->layer_count;
    for (uint32_t i = 0; i < target->layer_count; i++) {
        const float *pixels = host_target_floats(device, target, (host_output)(HOST_LAYER + i));
        if (!(target->kept_layers & 1u << i))
            add(a, a->layers[i], pixels, 4);
        else if (first || keep)
            memcpy(a->layers[i], pixels, values * sizeof(float));
    }
    a->kept_layers = target->kept_layers;
}

void host_accumulator_add(host_accumulator *a, const host_device *device, const host_target *target, bool keep)
{
    size_t pixels = (size_t)a->width * a->height;
    bool first = a->samples == 0;
    add(a, a->color, host_target_floats(device, target, HOST_COLOR), 4);
    add_layers(a, device, target, first, keep);
    add(a, a->normal, host_target_floats(device, target, HOST_NORMAL), 4);
    add(a, a->velocity, host_target_floats(device, target, HOST_VELOCITY), 2);
    add(a, a->water, host_target_floats(device, target, HOST_WATER), 2);
    for (size_t i = 0; a->weights && i < pixels; i++)
        a->weight_sums[i] = a->weights[i] + (first ? 0 : a->weight_sums[i]);
    if (first || keep) {
        memcpy(a->depth, host_target_floats(device, target, HOST_DEPTH), pixels * sizeof(float));
        memcpy(a->id, host_target_ids(device, target), pixels * sizeof(uint32_t));
    }
    a->samples++;
}

static void scale(float *values, size_t count, float factor)
{
    for (size_t i = 0; i < count; i++)
        values[i] *= factor;
}

static void divide(const host_accumulator *a, float *values, size_t channels)
{
    const size_t pixels = (size_t)a->width * a->height;
    if (!a->weights)
        scale(values, pixels * channels, 1.0f / (float)a->samples);
    for (size_t i = 0; a->weights && i < pixels; i++)
        scale(&values[i * channels], channels, 1.0f / a->weight_sums[i]);
}

void host_accumulator_finish(host_accumulator *a)
{
    size_t pixels = (size_t)a->width * a->height;
    if (a->samples < 2 && !a->weights)
        return;
    divide(a, a->color, 4);
    for (uint32_t i = 0; i < a->layer_count; i++)
        if (!(a->kept_layers & 1u << i))
            divide(a, a->layers[i], 4);
    divide(a, a->normal, 4);
    divide(a, a->velocity, 2);
    divide(a, a->water, 2);
    for (size_t i = 0; i < pixels; i++) {
        float *n = &a->normal[i * 4];
        float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (length > 0.0f)
            scale(n, 3, 1.0f / length);
    }
}
