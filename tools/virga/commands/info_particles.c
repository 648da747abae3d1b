/* info_particles.c - `virga info FILE`: what is in a file of simulated particles. */
#include "commands/commands.h"
#include "options.h"

#include "particle_spacing.h"
#include "particles.h"
#include "water.h"

#include <math.h>
#include <stdio.h>

static void print_bounds(const particles *frame)
{
    float low[3], high[3];
    uint32_t invalid;
    const bool any = particles_bounds(frame, low, high, &invalid);
    if (any)
        printf("  position     %g to %g, %g to %g, %g to %g\n", (double)low[0], (double)high[0], (double)low[1],
               (double)high[1], (double)low[2], (double)high[2]);
    if (invalid)
        printf("  not finite   %u positions; these particles are left out\n", invalid);
}

static void print_velocity(const particles *frame)
{
    double fastest = 0;
    for (uint32_t i = 0; i < frame->count; i++) {
        const float *v = frame->velocity[i];
        fastest = fmax(fastest, sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] +
                                     (double)v[2] * (double)v[2])); /* fmax leaves NaN out */
    }
    printf("  velocity     up to %g\n", fastest);
}

static void print_id(const particles *frame)
{
    uint32_t low = UINT32_MAX, high = 0;
    for (uint32_t i = 0; i < frame->count; i++) {
        low = frame->id[i] < low ? frame->id[i] : low;
        high = frame->id[i] > high ? frame->id[i] : high;
    }
    printf("  id           %u to %u\n", low, high);
}

static void print_density(const particles *frame)
{
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < frame->count; i++) {
        low = fmin(low, (double)frame->density[i]);
        high = fmax(high, (double)frame->density[i]);
    }
    printf("  density      %g to %g\n", low, high);
}

static void print_attributes(const particles *frame)
{
    if (frame->velocity)
        print_velocity(frame);
    if (frame->id)
        print_id(frame);
    if (frame->density)
        print_density(frame);
    if (!frame->velocity && !frame->id && !frame->density)
        printf("  without      velocity, id, density\n");
}

static void print_spacing(const particles *frame)
{
    particle_spacing guess;
    if (particle_spacing_guess(frame, &guess))
        printf("  spacing      %.4g, by the number of particles per volume inside the water, %.3g each; %.4g to the "
               "nearest\n",
               guess.spacing, pow(guess.spacing, 3), guess.nearest);
    else
        printf("  spacing      no guess from so few particles, or all at one place\n");
}

int info_particles(const char *path)
{
    particles frame;
    char error[1024];
    if (!particles_read(path, &frame, error, sizeof error)) {
        options_complain("info", "%s", error);
        return EXIT_USAGE;
    }
    const char *format = particles_format(path);
    printf("%s: %s, %u particles\n", path, format ? format : "particles", frame.count);
    if (frame.count > WATER_MAX_PARTICLES)
        printf("  too many     %u particles are left out: water has room for %u\n", frame.count - WATER_MAX_PARTICLES,
               WATER_MAX_PARTICLES);
    if (frame.count) {
        print_bounds(&frame);
        print_attributes(&frame);
        print_spacing(&frame);
    }
    particles_free(&frame);
    return EXIT_OK;
}
