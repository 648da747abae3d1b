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
    a->splash = calloc(pixels, 4 * sizeof(float));
    a->layer = calloc(pixels, 4 * sizeof(float));
    a->glass = calloc(pixels, 4 * sizeof(float));
    a->refraction = calloc(pixels, 4 * sizeof(float));
    a->normal = calloc(pixels, 4 * sizeof(float));
    a->velocity = calloc(pixels, 2 * sizeof(float));
    a->water = calloc(pixels, 2 * sizeof(float));
    a->depth = calloc(pixels, sizeof(float));
    a->id = calloc(pixels, sizeof(uint32_t));
    if (a->color && a->splash && a->layer && a->glass && a->refraction && a->normal && a->velocity && a->water &&
        a->depth && a->id)
        return true;
    host_accumulator_destroy(a);
    return host_fail(error, error_size, "no memory for a picture of %u x %u", width, height);
}

void host_accumulator_destroy(host_accumulator *a)
{
    free(a->color);
    free(a->splash);
    free(a->layer);
    free(a->glass);
    free(a->refraction);
    free(a->normal);
    free(a->velocity);
    free(a->water);
    free(a->depth);
    free(a->id);
    memset(a, 0, sizeof *a);
}

void host_accumulator_reset(host_accumulator *a)
{
    a->samples = 0;
}

/* The first sample is stored, so that a reset costs nothing. */
static void add(float *sum, const float *values, size_t count, bool first)
{
    if (first) {
        memcpy(sum, values, count * sizeof *sum);
        return;
    }
    for (size_t i = 0; i < count; i++)
        sum[i] += values[i];
}

void host_accumulator_add(host_accumulator *a, const host_device *device, const host_target *target, bool keep)
{
    size_t pixels = (size_t)a->width * a->height;
    bool first = a->samples == 0;
    add(a->color, host_target_floats(device, target, HOST_COLOR), pixels * 4, first);
    if (target->images[HOST_SPLASH].image)
        add(a->splash, host_target_floats(device, target, HOST_SPLASH), pixels * 4, first);
    add(a->layer, host_target_floats(device, target, HOST_LAYER), pixels * 4, first);
    a->panes = target->images[HOST_GLASS].image;
    if (a->panes)
        add(a->glass, host_target_floats(device, target, HOST_GLASS), pixels * 4, first);
    add(a->normal, host_target_floats(device, target, HOST_NORMAL), pixels * 4, first);
    add(a->velocity, host_target_floats(device, target, HOST_VELOCITY), pixels * 2, first);
    add(a->water, host_target_floats(device, target, HOST_WATER), pixels * 2, first);
    if (first || keep) {
        memcpy(a->depth, host_target_floats(device, target, HOST_DEPTH), pixels * sizeof(float));
        memcpy(a->id, host_target_ids(device, target), pixels * sizeof(uint32_t));
        if (a->panes)
            memcpy(a->refraction, host_target_floats(device, target, HOST_REFRACTION), pixels * 4 * sizeof(float));
    }
    a->samples++;
}

static void scale(float *values, size_t count, float factor)
{
    for (size_t i = 0; i < count; i++)
        values[i] *= factor;
}

void host_accumulator_finish(host_accumulator *a)
{
    size_t pixels = (size_t)a->width * a->height;
    if (a->samples < 2)
        return;
    float factor = 1.0f / (float)a->samples;
    scale(a->color, pixels * 4, factor);
    scale(a->splash, pixels * 4, factor);
    scale(a->layer, pixels * 4, factor);
    if (a->panes)
        scale(a->glass, pixels * 4, factor);
    scale(a->normal, pixels * 4, factor);
    scale(a->velocity, pixels * 2, factor);
    scale(a->water, pixels * 2, factor);
    for (size_t i = 0; i < pixels; i++) {
        float *n = &a->normal[i * 4];
        float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (length > 0.0f)
            scale(n, 3, 1.0f / length);
    }
}
