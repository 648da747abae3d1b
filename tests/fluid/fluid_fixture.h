/* fluid_fixture.h - a fluid on a device with validation, in a box that a test chooses. */
#ifndef VIRGA_TESTS_FLUID_FIXTURE_H
#define VIRGA_TESTS_FLUID_FIXTURE_H

#include "../host/effect_fixture.h"

#include "fluid/fluid_internal.h"

#include <virga/shared/random.h>
#include <virga/virga.h>

#include <math.h>

#define GRAVITY 9.81

typedef struct fluid_fixture {
    fixture gpu;
    virga_context *context;
    virga_fluid *fluid;
    virga_fluid_settings settings;
    host_buffer upload, download;
    double time_s;
    /* Read back. */
    const virga_particle_gpu *particles;
    const float (*pressures)[2];
    uint32_t count;
    virga_fluid_stats stats;
} fluid_fixture;

static inline virga_fluid_def fluid_fixture_def(void)
{
    virga_fluid_def def = virga_default_fluid_def();
    def.max_particles = 8192;
    def.max_cells = 32768;
    return def;
}

static inline void fluid_fixture_open_with(fluid_fixture *f, const virga_fluid_def *def, bool timings)
{
    memset(f, 0, sizeof *f);
    f->context = effect_fixture_open(&f->gpu, timings, effect_fixture_log, NULL);
    REQUIRE(virga_fluid_create(f->context, def, &f->fluid) == VIRGA_OK);
    f->settings = virga_default_fluid_settings();
    char *error = f->gpu.error;
    const size_t size = sizeof f->gpu.error;
    REQUIRE(host_buffer_create(&f->gpu.device, f->fluid->slots->size + f->fluid->slot_pressures->size,
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "fluid down", &f->download,
                               error, size));
    REQUIRE(host_buffer_create(&f->gpu.device, f->fluid->slots->size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                               HOST_BUFFER_UPLOAD, "fluid up", &f->upload, error, size));
}

static inline void fluid_fixture_open(fluid_fixture *f)
{
    const virga_fluid_def def = fluid_fixture_def();
    fluid_fixture_open_with(f, &def, false);
}

/* A box with a corner at the origin. */
static inline void fluid_fixture_box(fluid_fixture *f, double spacing, double x, double y, double z)
{
    const float high[3] = {(float)x, (float)y, (float)z};
    f->settings.spacing_m = (float)spacing;
    memset(f->settings.low_m, 0, sizeof f->settings.low_m);
    memcpy(f->settings.high_m, high, sizeof high);
    REQUIRE(virga_fluid_set(f->fluid, &f->settings) == VIRGA_OK);
}

static inline void fluid_fixture_block(fluid_fixture *f, double x0, double y0, double z0, double x1, double y1,
                                       double z1)
{
    const virga_fluid_block block = {.low_m = {(float)x0, (float)y0, (float)z0},
                                     .high_m = {(float)x1, (float)y1, (float)z1}};
    REQUIRE(virga_fluid_add(f->fluid, &block) == VIRGA_OK);
}

/* Records a step, adds the first `added` particles of the upload, and reads the result back if `read` is set. */
static inline virga_result fluid_fixture_try(fluid_fixture *f, double dt, uint32_t added, bool read)
{
    VkDeviceSize offset = 0;
    const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
    const virga_fluid_step_info info = {.dt_s = (float)dt, .particles = f->upload.buffer, .count = added};
    const virga_result result = virga_fluid_step(f->fluid, cmd, &info);
    if (read) {
        effect_fixture_transfers(cmd);
        f->particles = effect_fixture_copy(cmd, f->fluid->slots->buffer, f->fluid->slots->size, &f->download, &offset);
        f->pressures = effect_fixture_copy(cmd, f->fluid->slot_pressures->buffer, f->fluid->slot_pressures->size,
                                           &f->download, &offset);
    }
    effect_fixture_complete(&f->gpu, f->context);
    host_buffer_invalidate(&f->gpu.device, &f->download);
    virga_fluid_stats_get(f->fluid, &f->stats);
    virga_fluid_particles(f->fluid, NULL, &f->count);
    f->time_s += dt;
    return result;
}

static inline void fluid_fixture_step(fluid_fixture *f, double dt)
{
    REQUIRE(fluid_fixture_try(f, dt, 0, true) == VIRGA_OK);
}

/* Steps of 1/60 s, of which the last is read back. */
static inline void fluid_fixture_run(fluid_fixture *f, uint32_t steps)
{
    for (uint32_t i = 0; i < steps; i++)
        REQUIRE(fluid_fixture_try(f, 1.0 / 60, 0, i + 1 == steps) == VIRGA_OK);
}

static inline void fluid_fixture_close(fluid_fixture *f)
{
    virga_fluid_destroy(&f->fluid);
    virga_context_destroy(&f->context);
    host_buffer *const buffers[] = {&f->upload, &f->download};
    assert_int_equal(effect_fixture_end(&f->gpu, buffers, 2), 0);
}

/* ---- measures */

/* Kinetic and potential energy of all particles over their mass (m^2/s^2), with the floor at y = 0. */
static inline double fluid_energy(const fluid_fixture *f)
{
    double sum = 0;
    for (uint32_t i = 0; i < f->count; i++) {
        const float *v = f->particles[i].velocity;
        sum += 0.5 * (double)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + GRAVITY * (double)f->particles[i].position[1];
    }
    return sum / f->count;
}

/* Root of the mean square of all speeds (m/s). */
static inline double fluid_noise(const fluid_fixture *f)
{
    double sum = 0;
    for (uint32_t i = 0; i < f->count; i++)
        for (int axis = 0; axis < 3; axis++)
            sum += pow((double)f->particles[i].velocity[axis], 2);
    return sqrt(sum / f->count);
}

/* Mean height of the particles over the floor (m): half the depth of water at rest. */
static inline double fluid_mean_height(const fluid_fixture *f)
{
    double sum = 0;
    for (uint32_t i = 0; i < f->count; i++)
        sum += (double)f->particles[i].position[1];
    return sum / f->count;
}

#endif
