/* scene/scene_quality.c - presets: a table of sizes for each effect, with one column for each quality. */
#include <virga/quality.h>

#include "core/settings.h"
#include "gpu/effect.h"

#include <string.h>

enum { QUALITIES = VIRGA_QUALITY_FILM + 1 };

/* A member of a definition, and its values from low to film. */
typedef struct quality_row {
    virga_number number;
    size_t member;
    double values[QUALITIES];
} quality_row;

#define ROW(type, kind, member, ...)                               \
    {                                                              \
        VIRGA_NUMBER_##kind, offsetof(virga_##type##_def, member), \
        {                                                          \
            __VA_ARGS__                                            \
        }                                                          \
    }
#define TICKS(type) ROW(type, U32, max_ticks_per_step, 2, 3, 4, 64)

static const quality_row rain_rows[] = {
    TICKS(rain),
    ROW(rain, U32, max_drops, 16384, 65536, 131072, 1048576),
    ROW(rain, U32, max_impacts, 8192, 32768, 65536, 524288),
    ROW(rain, U32, max_streaks, 8192, 32768, 0, 0),
    ROW(rain, U32, occlusion_size, 512, 1024, 1024, 2048),
    ROW(rain, U32, occlusion_cascades, 2, 2, 2, 3),
    ROW(rain, U32, occlusion_slants, 1, 1, 2, 3),
};

static const quality_row ground_rows[] = {
    TICKS(ground),
    ROW(ground, U32, cells, 256, 512, 1024, 2048),
    ROW(ground, FLOAT, cell_m, 0.1, 0.08, 0.05, 0.03),
    ROW(ground, U32, cached_tiles, 256, 512, 1024, 4096),
    ROW(ground, U32, far_cells, 256, 512, 512, 1024),
    ROW(ground, U32, ripple_texels, 256, 512, 1024, 2048),
    ROW(ground, FLOAT, ripple_texel_m, 0.01, 0.0075, 0.005, 0.004),
    ROW(ground, U32, flow_ticks, 12, 6, 4, 1),
    ROW(ground, U32, max_impacts, 8192, 32768, 65536, 524288),
    ROW(ground, U32, max_spawns, 8192, 32768, 65536, 524288),
    ROW(ground, U32, max_returned_droplets, 16384, 65536, 131072, 1048576),
};

static const quality_row splash_rows[] = {
    TICKS(splash),
    ROW(splash, U32, max_splashes, 4096, 16384, 65536, 262144),
    ROW(splash, U32, max_droplets, 8192, 32768, 131072, 1048576),
    ROW(splash, U32, max_spawns, 8192, 32768, 65536, 524288),
    ROW(splash, U32, max_returned_droplets, 16384, 65536, 131072, 1048576),
};

static const quality_row glass_rows[] = {
    TICKS(glass),
    ROW(glass, FLOAT, cell_m, 0.004, 0.003, 0.002, 0.001),
    ROW(glass, U32, max_drops, 4096, 16384, 32768, 131072),
    ROW(glass, U32, max_texels, 512, 768, 1024, 2048),
};

/* Foam and droplets, and the sizes that as many particles need. */
static const quality_row water_rows[] = {
    ROW(water, U32, max_particles, 16384, 32768, 65536, 1048576),
    ROW(water, U32, max_cells, 65536, 131072, 262144, 4194304),
    ROW(water, U32, max_blocks, 16384, 24576, 32768, 262144),
    ROW(water, U32, max_surfels, 65536, 131072, 262144, 2097152),
    ROW(water, U32, max_spray, 1024, 2048, 4096, 65536),
    ROW(water, U32, max_droplets, 16384, 32768, 65536, 1048576),
    ROW(water, U32, max_foam, 4096, 16384, 65536, 524288),
    ROW(water, U32, max_width, 960, 1280, 1920, 3840),
    ROW(water, U32, max_height, 540, 720, 1080, 2160),
};

static const quality_row fluid_rows[] = {
    ROW(fluid, U32, max_particles, 16384, 32768, 65536, 1048576),
    ROW(fluid, U32, max_cells, 65536, 131072, 262144, 4194304),
    ROW(fluid, U32, max_substeps, 3, 5, 8, 32),
    ROW(fluid, U32, max_iterations, 10, 15, 20, 60),
};

static const quality_row lens_rows[] = {
    ROW(lens, U32, half_resolution, 1, 1, 1, 0),
};

static void apply(virga_quality quality, const quality_row *rows, uint32_t count, void *def)
{
    if (!def || (uint32_t)quality >= QUALITIES)
        return;
    for (uint32_t i = 0; i < count; i++) {
        char *member = (char *)def + rows[i].member;
        const uint32_t whole = (uint32_t)rows[i].values[quality];
        const float real = (float)rows[i].values[quality];
        memcpy(member, rows[i].number == VIRGA_NUMBER_U32 ? (const void *)&whole : &real, 4);
    }
}

#define APPLY(type)                                                                   \
    void virga_##type##_apply_quality(virga_quality quality, virga_##type##_def *def) \
    {                                                                                 \
        apply(quality, type##_rows, VIRGA_ROWS(type##_rows), def);                    \
    }
APPLY(rain)
APPLY(ground)
APPLY(splash)
APPLY(glass)
APPLY(water)
APPLY(fluid)
APPLY(lens)

void virga_scene_apply_quality(virga_quality quality, virga_scene_def *def)
{
    if (!def)
        return;
    virga_rain_apply_quality(quality, &def->rain);
    virga_ground_apply_quality(quality, &def->ground);
    virga_splash_apply_quality(quality, &def->splash);
    virga_water_apply_quality(quality, &def->water);
}

const char *virga_quality_name(virga_quality quality)
{
    static const char *const names[QUALITIES] = {"low", "medium", "high", "film"};
    return (uint32_t)quality < QUALITIES ? names[quality] : "unknown";
}
