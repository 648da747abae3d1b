/* water_fixture.h - water on a device with validation, with particles that a test chooses. */
#ifndef VIRGA_TESTS_WATER_FIXTURE_H
#define VIRGA_TESTS_WATER_FIXTURE_H

#include "../host/effect_fixture.h"

#include "water/water_internal.h"

#include <virga/shared/random.h>
#include <virga/virga.h>

#include <math.h>

typedef struct water_fixture {
    fixture gpu;
    virga_context *context;
    virga_water *water;
    virga_water_settings settings;
    host_buffer particle_buffer, download;
    virga_particle_gpu *particles; /* of the next step */
    uint32_t count;
    double *covers, *shares; /* as of the newest water_fixture_shares */
    double origin_m[3], time_s;
    VkBuffer bodies; /* (optional) of the next step */
    bool sub_frame;
    uint32_t lines; /* of the log: warnings and errors */
    char said[512]; /* the last of them */
    /* Read back. */
    const float *densities;
    const virga_surfel_gpu *surfels;
    const uint32_t *sorted_indices; /* for each kernel, the index of its particle */
    const float *centers;           /* of kernels: x, y, z, factor */
    const virga_spray_gpu *droplets;
    const float *shapes; /* of kernels: xx, yy, zz, xy, xz, yz, 0, 0 */
    virga_water_stats stats;
} water_fixture;

static inline virga_water_def water_fixture_def(void)
{
    virga_water_def def = virga_default_water_def();
    def.max_particles = 8192;
    def.max_cells = 32768;
    def.max_blocks = 4096;
    def.max_surfels = 65536;
    def.max_foam = 0;                   /* only test_water_foam.c has foam */
    def.max_width = def.max_height = 0; /* a test that draws sets them */
    return def;
}

static inline void water_fixture_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    water_fixture *f = user;
    effect_fixture_log(NULL, level, id, text);
    if (level > VIRGA_LOG_WARNING)
        return;
    f->lines++;
    snprintf(f->said, sizeof f->said, "%s", text);
}

static inline void water_fixture_open_with(water_fixture *f, const virga_water_def *def, bool timings)
{
    memset(f, 0, sizeof *f);
    f->context = effect_fixture_open(&f->gpu, timings, water_fixture_log, f);
    REQUIRE(virga_water_create(f->context, def, &f->water) == VIRGA_OK);
    f->settings = virga_default_water_settings();
    f->settings.spray_density = 0; /* only test_water_spray.c has spray */
    char *error = f->gpu.error;
    const size_t size = sizeof f->gpu.error;
    REQUIRE(host_buffer_create(&f->gpu.device, (VkDeviceSize)def->max_particles * sizeof(virga_particle_gpu),
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HOST_BUFFER_UPLOAD, "particles", &f->particle_buffer,
                               error, size));
    REQUIRE(host_buffer_create(&f->gpu.device,
                               2 * f->water->densities->size + f->water->surfels->size + f->water->shapes->size +
                                   f->water->centers->size + f->water->spray.droplets->size,
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "water down", &f->download,
                               error, size));
    f->particles = f->particle_buffer.mapped;
    f->covers = calloc(def->max_particles, sizeof *f->covers);
    f->shares = calloc(def->max_particles, sizeof *f->shares);
    REQUIRE(f->covers && f->shares);
    for (uint32_t i = 0; i < def->max_particles; i++)
        f->covers[i] = f->shares[i] = 1;
}

static inline void water_fixture_open(water_fixture *f)
{
    const virga_water_def def = water_fixture_def();
    water_fixture_open_with(f, &def, false);
}

static inline virga_particle_gpu *water_fixture_add(water_fixture *f, double x, double y, double z)
{
    REQUIRE(f->count < f->water->def.max_particles);
    virga_particle_gpu *particle = &f->particles[f->count];
    *particle = (virga_particle_gpu){.position = {(float)x, (float)y, (float)z}, .share = 1, .id = f->count++};
    return particle;
}

/* Radius of the kernel in m. */
static inline double water_h(const water_fixture *f)
{
    return (double)f->settings.kernel_spacings * (double)f->settings.spacing_m;
}

/* How much of the water around a particle is there: the largest share, with a factor that falls from 1 at the distance
 * VIRGA_WATER_COVER_NEAR h to 0 at h. */
static inline double water_reference_cover(const water_fixture *f, uint32_t i)
{
    double cover = (double)f->particles[i].share;
    for (uint32_t j = 0; j < f->count; j++) {
        double r2 = 0;
        for (int axis = 0; axis < 3; axis++)
            r2 += pow((double)f->particles[j].position[axis] - (double)f->particles[i].position[axis], 2);
        const double factor = (1 - sqrt(r2) / water_h(f)) / (1 - VIRGA_WATER_COVER_NEAR);
        cover = fmax(cover, (double)f->particles[j].share * fmin(factor, 1));
    }
    return cover;
}

/* The covers of particles, and their shares of these, which the references below use: 1 until then. A step calls it. */
static inline void water_fixture_shares(water_fixture *f)
{
    bool fades = false;
    for (uint32_t i = 0; f->settings.fading == VIRGA_WATER_FADING_COVERAGE && i < f->count; i++)
        fades |= f->particles[i].share < 1;
    for (uint32_t i = 0; i < f->count; i++) {
        f->covers[i] = fades ? water_reference_cover(f, i) : 1;
        f->shares[i] = (double)f->particles[i].share / f->covers[i];
    }
}

/* Records a step with the particles of the fixture and reads its results back. */
static inline virga_result water_fixture_try(water_fixture *f)
{
    VkDeviceSize offset = 0;
    water_fixture_shares(f);
    const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
    virga_water_step_info info = {.particles = f->particle_buffer.buffer,
                                  .count = f->count,
                                  .time_s = f->time_s,
                                  .sub_frame = f->sub_frame,
                                  .bodies = f->bodies};
    memcpy(info.origin_m, f->origin_m, sizeof info.origin_m);
    const virga_result result = virga_water_step(f->water, cmd, &info);
    effect_fixture_transfers(cmd);
    f->densities =
        effect_fixture_copy(cmd, f->water->densities->buffer, f->water->densities->size, &f->download, &offset);
    f->surfels = effect_fixture_copy(cmd, f->water->surfels->buffer, f->water->surfels->size, &f->download, &offset);
    f->sorted_indices = effect_fixture_copy(cmd, f->water->grid.sorted_indices->buffer,
                                            f->water->grid.sorted_indices->size, &f->download, &offset);
    f->centers = effect_fixture_copy(cmd, f->water->centers->buffer, f->water->centers->size, &f->download, &offset);
    f->shapes = effect_fixture_copy(cmd, f->water->shapes->buffer, f->water->shapes->size, &f->download, &offset);
    f->droplets = effect_fixture_copy(cmd, f->water->spray.droplets->buffer, f->water->spray.droplets->size,
                                      &f->download, &offset);
    effect_fixture_complete(&f->gpu, f->context);
    host_buffer_invalidate(&f->gpu.device, &f->download);
    virga_water_stats_get(f->water, &f->stats);
    return result;
}

static inline void water_fixture_step(water_fixture *f)
{
    REQUIRE(virga_water_set(f->water, &f->settings) == VIRGA_OK);
    REQUIRE(water_fixture_try(f) == VIRGA_OK);
}

/* Records a step in a frame that the host then throws away. */
static inline void water_fixture_throw_away(water_fixture *f)
{
    host_device *device = &f->gpu.device;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
    const virga_water_step_info info = {.particles = f->particle_buffer.buffer, .count = f->count, .time_s = f->time_s};
    assert_int_equal(virga_water_step(f->water, cmd, &info), VIRGA_OK);
    REQUIRE(vkEndCommandBuffer(cmd) == VK_SUCCESS);
    REQUIRE(vkResetCommandPool(device->device, device->frames[device->frame % HOST_FRAMES].pool, 0) == VK_SUCCESS);
    REQUIRE(vkBeginCommandBuffer(cmd, &begin) == VK_SUCCESS);
    effect_fixture_complete(&f->gpu, f->context);
}

static inline void water_fixture_close(water_fixture *f)
{
    virga_water_destroy(&f->water);
    virga_context_destroy(&f->context);
    free(f->covers);
    free(f->shares);
    host_buffer *const buffers[] = {&f->particle_buffer, &f->download};
    assert_int_equal(effect_fixture_end(&f->gpu, buffers, 2), 0);
}

/* The radius of a surfel of which all is there, see virga_surfel_gpu. */
static inline float water_whole_radius(double radius_m)
{
    const float given = (float)radius_m;
    uint32_t bits;
    float whole;
    memcpy(&bits, &given, sizeof bits);
    bits &= ~0xffu;
    memcpy(&whole, &bits, sizeof whole);
    return whole;
}

/* ---- shapes of water, with particles `d` apart */

static inline double water_random(uint32_t *hash, double low, double high)
{
    *hash = virga_hash1(*hash);
    return low + (high - low) * (double)virga_unit(*hash);
}

/* A box of particles, each moved by up to `jitter` d on each axis. */
static inline void water_fixture_box(water_fixture *f, const double low[3], const uint32_t counts[3], double d,
                                     double jitter)
{
    uint32_t hash = 7;
    for (uint32_t z = 0; z < counts[2]; z++)
        for (uint32_t y = 0; y < counts[1]; y++)
            for (uint32_t x = 0; x < counts[0]; x++)
                water_fixture_add(f, low[0] + d * (x + water_random(&hash, -jitter, jitter)),
                                  low[1] + d * (y + water_random(&hash, -jitter, jitter)),
                                  low[2] + d * (z + water_random(&hash, -jitter, jitter)));
}

/* A ball of particles on a lattice, around a center. */
static inline void water_fixture_ball(water_fixture *f, const double center[3], double radius, double d)
{
    const int n = (int)(radius / d) + 1;
    for (int z = -n; z <= n; z++)
        for (int y = -n; y <= n; y++)
            for (int x = -n; x <= n; x++)
                if (d * d * (x * x + y * y + z * z) <= radius * radius)
                    water_fixture_add(f, center[0] + d * x, center[1] + d * y, center[2] + d * z);
}

/* A ball of particles on shells: rounder than one on a lattice. Its radius is a multiple of d. */
static inline void water_fixture_shells(water_fixture *f, const double center[3], double radius, double d)
{
    for (int shell = 0; shell < (int)lround(radius / d); shell++) {
        const double r = (shell + 0.5) * d;
        const int n = (int)lround(4 * M_PI * (r * r / (d * d) + 1.0 / 12)); /* the volume of the shell over d^3 */
        for (int i = 0; i < n; i++) {
            const double y = 1 - (2 * i + 1.0) / n, phi = 2.399963 * i + 1.3 * shell, side = r * sqrt(1 - y * y);
            water_fixture_add(f, center[0] + side * cos(phi), center[1] + r * y, center[2] + side * sin(phi));
        }
    }
}

/* ---- reference in double precision */

/* Density at a point (equation 1), and its gradient. */
static inline double water_reference(const water_fixture *f, const double at[3], double gradient[3])
{
    const double d = (double)f->settings.spacing_m, h = (double)f->settings.kernel_spacings * d;
    const double volume = f->settings.volume_m3 > 0 ? (double)f->settings.volume_m3 : d * d * d;
    const double factor = 315 / (64 * M_PI * pow(h, 9)) * volume;
    double sum = 0;
    for (int axis = 0; gradient && axis < 3; axis++)
        gradient[axis] = 0;
    for (uint32_t i = 0; i < f->count; i++) {
        double apart[3], r2 = 0;
        for (int axis = 0; axis < 3; axis++) {
            apart[axis] = at[axis] - (double)f->particles[i].position[axis];
            r2 += apart[axis] * apart[axis];
        }
        if (!(r2 < h * h))
            continue;
        sum += f->shares[i] * factor * pow(h * h - r2, 3);
        for (int axis = 0; gradient && axis < 3; axis++)
            gradient[axis] -= f->shares[i] * factor * 6 * pow(h * h - r2, 2) * apart[axis];
    }
    return sum;
}

/* A grid of points, and a field on it: sizes[0] along x, then y, then z; its first point is `low` steps from 0. */
typedef struct water_grid {
    int low[3], sizes[3];
    double step;   /* m */
    double *field; /* sizes[0] * sizes[1] * sizes[2] */
} water_grid;

static inline void water_grid_at(const water_grid *grid, size_t i, double at[3])
{
    size_t rest = i;
    for (int axis = 0; axis < 3; axis++) {
        at[axis] = grid->step * (double)(grid->low[axis] + (int)(rest % (size_t)grid->sizes[axis]));
        rest /= (size_t)grid->sizes[axis];
    }
}

/* Number of edges of the grid on which the field crosses `level`. */
static inline uint32_t water_count_crossings(const water_grid *grid, double level)
{
    const size_t row = (size_t)grid->sizes[0], plane = row * (size_t)grid->sizes[1];
    uint32_t crossings = 0;
    for (int z = 0; z < grid->sizes[2] - 1; z++)
        for (int y = 0; y < grid->sizes[1] - 1; y++)
            for (int x = 0; x < grid->sizes[0] - 1; x++) {
                const double *at = grid->field + (size_t)z * plane + (size_t)y * row + (size_t)x;
                const bool out = at[0] < level;
                crossings += (out != (at[1] < level)) + (out != (at[row] < level)) + (out != (at[plane] < level));
            }
    return crossings;
}

/* Mean radius of the surface around a point within it. */
static inline double water_reference_radius(const water_fixture *f, const double center[3], double max)
{
    enum { DIRECTIONS = 100 };
    double sum = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        const double y = 1 - (2 * i + 1.0) / DIRECTIONS, phi = 2.399963 * i, side = sqrt(1 - y * y);
        const double d[3] = {side * cos(phi), y, side * sin(phi)};
        double low = 0.5 * max, high = max;
        for (int k = 0; k < 12; k++) {
            const double r = 0.5 * (low + high);
            const double at[3] = {center[0] + r * d[0], center[1] + r * d[1], center[2] + r * d[2]};
            if (water_reference(f, at, NULL) > (double)f->settings.level)
                low = r;
            else
                high = r;
        }
        sum += low / DIRECTIONS;
    }
    return sum;
}

static inline void water_unpack_normal(uint32_t packed, double n[3])
{
    const double x = (double)(int16_t)(packed & 0xffff) / 32767, y = (double)(int16_t)(packed >> 16) / 32767;
    n[0] = x;
    n[1] = y;
    n[2] = 1 - fabs(x) - fabs(y);
    if (n[2] < 0) {
        n[0] = (1 - fabs(y)) * (x >= 0 ? 1 : -1);
        n[1] = (1 - fabs(x)) * (y >= 0 ? 1 : -1);
    }
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int axis = 0; axis < 3; axis++)
        n[axis] /= length;
}

#endif
