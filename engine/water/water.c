/* water/water.c - creates and destroys water objects, applies settings, and answers queries. */
#include "water/water_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/errors.h"

#define EFFECT water
#include "gpu/effect_rows.h"

#include "shaders/particles_shaders.h"
#include "shaders/water_shaders.h"

#include <virga/shared/compact.h>
#include <virga/shared/foam.h>

#include <stdio.h>
#include <string.h>

/* ---- defaults */

static const virga_setting_row def_rows[] = {
    DEF(U32, max_particles, 64, 8388608, 65536),
    DEF(U32, max_cells, 4096, 16777216, 262144),
    DEF(U32, max_blocks, 64, 1048576, 32768),
    DEF(U32, max_surfels, 256, 8388608, 262144),
    DEF(U32, max_spray, 64, 262144, 4096),
    DEF(U32, max_droplets, 256, 4194304, 65536),
    DEF(U32, max_foam, 0, 1048576, 65536),
    DEF(U32, max_width, 0, 16384, 1920, .look = true),
    DEF(U32, max_height, 0, 16384, 1080, .look = true),
    DEF(U32, max_parts, 0, 4194304, .look = true),
    DEF(U32, max_views, 1, VIRGA_MAX_VIEWS, 1, .look = true),
};

static const virga_setting_row setting_rows[] = {
    SETTING(FLOAT, spacing_m, 1e-4, 10, 0.02),
    SETTING(FLOAT, volume_m3, 0, 1000),
    SETTING(FLOAT, kernel_spacings, 1, 4, 2),
    SETTING(FLOAT, level, 0.05, 0.95, 0.5),
    SETTING(ENUM, fading, 0, VIRGA_WATER_FADING_VOLUME, VIRGA_WATER_FADING_COVERAGE),
    SETTING(ENUM, kernel, 0, VIRGA_WATER_KERNEL_ANISOTROPIC, VIRGA_WATER_KERNEL_ISOTROPIC),
    SETTING(FLOAT, smoothing, 0, 1, 0.9),
    SETTING(FLOAT, stretch, 1, 4, 2),
    SETTING(ENUM, style, 0, VIRGA_WATER_STYLE_PHYSICAL, VIRGA_WATER_STYLE_PHYSICAL),
    SETTING(FLOAT, spray_density, 0, 0.9, 0.35),
    SETTING(U32, spray_pieces, 1, VIRGA_WATER_PIECES, 25),
    SETTING(FLOAT, spray_speed_m_s, 0.01, 1000, 4),
    SETTING(FLOAT, spray_pattern, 0, 4, 1.25),
    SETTING(FLOAT, spray_turbulence, 0, 1, 0.1),
    SETTING(BOOL, hand_over, false, true, true),
    SETTING(FLOAT, hand_over_s, 0, 10, 0.03),
    SETTING(FLOAT, foam_air_hz, 0, 1e6, 600),
    SETTING(FLOAT, foam_crest_hz, 0, 1e6, 600),
    SETTING(FLOAT, foam_speed_m_s[0], 0, 1000, 0.6),
    SETTING(FLOAT, foam_speed_m_s[1], 0, 1000, 2),
    SETTING(FLOAT, foam_air_m_s[0], 0, 1000, 0.25),
    SETTING(FLOAT, foam_air_m_s[1], 0, 1000, 0.8),
    SETTING(FLOAT, foam_walls_low_m[0], -10000, 10000),
    SETTING(FLOAT, foam_walls_low_m[1], -10000, 10000),
    SETTING(FLOAT, foam_walls_low_m[2], -10000, 10000),
    SETTING(FLOAT, foam_walls_high_m[0], -10000, 10000),
    SETTING(FLOAT, foam_walls_high_m[1], -10000, 10000),
    SETTING(FLOAT, foam_walls_high_m[2], -10000, 10000),
    SETTING(FLOAT, foam_crest[0], 0, 10, 0.25),
    SETTING(FLOAT, foam_crest[1], 0, 10, 0.6),
    SETTING(FLOAT, foam_life_s[0], 0.01, 1000, 1),
    SETTING(FLOAT, foam_life_s[1], 0.01, 1000, 4),
    SETTING(FLOAT, foam_radius_m, 1e-5, 1, 0.002),
    SETTING(FLOAT, foam_rise_m_s, 0, 10, 0.25),
    SETTING(FLOAT, foam_drag_hz, 0.01, 1000, 40),
    SETTING(FLOAT, absorption_1_m[0], 0, 1000, 0.29, .look = true),
    SETTING(FLOAT, absorption_1_m[1], 0, 1000, 0.056, .look = true),
    SETTING(FLOAT, absorption_1_m[2], 0, 1000, 0.0103, .look = true),
    SETTING(FLOAT, scattering_1_m[0], 0, 1000, .look = true),
    SETTING(FLOAT, scattering_1_m[1], 0, 1000, .look = true),
    SETTING(FLOAT, scattering_1_m[2], 0, 1000, .look = true),
    SETTING(FLOAT, reflection, 0, 4, 1, .look = true),
    SETTING(FLOAT, refraction, 0, 4, 1, .look = true),
    SETTING(FLOAT, surfel_radius, 0.5, 4, 1.25, .look = true),
    SETTING(ENUM, shading, 0, VIRGA_WATER_SHADING_SURFELS, VIRGA_WATER_SHADING_PIXELS, .look = true),
    SETTING(FLOAT, surfel_difference, 0, 1000, 0.1, .look = true),
    SETTING(U32, surfel_divisions, 0, VIRGA_WATER_DIVISIONS, 3, .look = true),
    SETTING(FLOAT, soft_m, 0, 10, 0.002, .look = true),
    SETTING(ENUM, contact, 0, VIRGA_WATER_CONTACT_PREPARE, VIRGA_WATER_CONTACT_DRAW, .look = true),
    SETTING(FLOAT, foam_coverage, 0, 1, 0.3, .look = true),
    SETTING(FLOAT, light_gain, 0, 1000, 1, .look = true),
};

static virga_result check_def(const virga_log *log, void *given)
{
    virga_water_def *def = given;
    (void)log;
    if (!def->max_width || !def->max_height)
        def->max_width = def->max_height = def->max_parts = 0;
    def->max_cells = particle_grid_cells(def->max_cells);
    return VIRGA_OK;
}

/* Whole surfels are in the same buffer. */
static bool fit_parts(const virga_context *context, virga_water_def *def)
{
    const uint32_t bytes_each = VIRGA_WATER_PART_TEXELS * 16;
    const bool reduced = virga_fit_storage(context, "water_def.max_surfels", bytes_each, &def->max_surfels);
    uint32_t all = def->max_surfels + def->max_parts;
    const bool parts_reduced = virga_fit_storage(context, "water_def.max_surfels + max_parts", bytes_each, &all);
    def->max_parts = all - def->max_surfels;
    return reduced || parts_reduced;
}

static virga_result fit_device(const virga_context *context, void *given)
{
    virga_water_def *def = given;
    bool reduced =
        virga_fit_storage(context, "water_def.max_particles", sizeof(virga_particle_gpu), &def->max_particles);
    reduced |= virga_fit_storage(context, "water_def.max_blocks", VIRGA_WATER_POINTS * sizeof(float), &def->max_blocks);
    reduced |= virga_fit_storage(context, "water_def.max_foam", sizeof(virga_foam_gpu), &def->max_foam);
    reduced |= virga_fit_storage(context, "water_def.max_spray", 2 * VIRGA_WATER_PIECES * sizeof(virga_water_piece_gpu),
                                 &def->max_spray);
    const uint32_t surfel_bytes = def->max_width ? VIRGA_WATER_SPLAT_TEXELS * 16 : sizeof(virga_surfel_gpu);
    reduced |= virga_fit_storage(context, "water_def.max_surfels", surfel_bytes, &def->max_surfels);
    if (def->max_parts)
        reduced |= fit_parts(context, def);
    return reduced ? VIRGA_DEGRADED : VIRGA_OK;
}

/* ---- resources */

enum {
    COUNT_PARTICLES = 1,
    COUNT_CELLS,
    COUNT_SCAN_GROUPS,
    COUNT_SELECTION_BYTES,
    COUNT_BLOCKS,
    COUNT_POINTS,
    COUNT_SURFELS,
    COUNT_SPRAY,
    COUNT_SPRAY_SELECTION_BYTES,
    COUNT_TABLE,
    COUNT_DROPLETS,
    COUNT_FOAM,
    COUNT_FOAM_SELECTION_BYTES,
    COUNT_FOAM_ENTRIES,
    COUNT_FOAM_SOURCES,
    COUNT_FOAM_SOURCE_ENTRIES,
    COUNT_FOAM_SPLATS,
    COUNT_DRAWN,
    COUNT_DRAWN_ENTRIES,
    COUNT_SPLAT_SELECTION_BYTES,
    COUNT_SPLATS,
    COUNT_DIVISIONS,
    COUNT_PARTS,
    COUNT_PYRAMID,
    COUNT_PYRAMID_COLUMNS,
    COUNT_PYRAMID_ROWS,
    COUNT_COLUMNS,
    COUNT_ROWS,
    COUNT_OPEN_TEXELS,
    COUNT_TILE_WORDS,
    COUNT_VIEWS,
};

static VkDeviceSize whole_groups(uint32_t items)
{
    return ((VkDeviceSize)items + VIRGA_WATER_LANES - 1) / VIRGA_WATER_LANES * VIRGA_WATER_LANES;
}

/* Entries of a list with its head, in words. */
static VkDeviceSize list_entries(uint32_t items)
{
    return items ? (VkDeviceSize)items + sizeof(virga_list_gpu) / sizeof(uint32_t) : 0;
}

/* Rectangles of so many pixels that cover the images. */
static VkDeviceSize squares(const virga_water_def *def, uint32_t width, uint32_t height)
{
    return (VkDeviceSize)((def->max_width + width - 1) / width) * ((def->max_height + height - 1) / height);
}

static void count_foam(const virga_water_def *def, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS])
{
    const uint32_t sources = def->max_foam ? def->max_particles : 0;
    counts[COUNT_FOAM] = def->max_foam;
    counts[COUNT_FOAM_ENTRIES] = list_entries(def->max_foam);
    counts[COUNT_FOAM_SOURCES] = sources;
    counts[COUNT_FOAM_SOURCE_ENTRIES] = list_entries(sources);
    /* For both lists, one after the other. */
    counts[COUNT_FOAM_SELECTION_BYTES] =
        VIRGA_SELECTION_BYTES(whole_groups(sources > def->max_foam ? sources : def->max_foam));
    counts[COUNT_FOAM_SPLATS] = def->max_width ? def->max_foam : 0;
}

static void count(const void *given, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS])
{
    const virga_water_def *def = given;
    counts[COUNT_PARTICLES] = def->max_particles;
    counts[COUNT_CELLS] = def->max_cells;
    counts[COUNT_SCAN_GROUPS] = def->max_cells / VIRGA_GRID_SCAN_CELLS;
    counts[COUNT_SELECTION_BYTES] = VIRGA_SELECTION_BYTES((VkDeviceSize)def->max_cells);
    counts[COUNT_BLOCKS] = def->max_blocks;
    counts[COUNT_POINTS] = (VkDeviceSize)def->max_blocks * VIRGA_WATER_POINTS;
    counts[COUNT_SURFELS] = def->max_surfels;
    counts[COUNT_SPRAY] = def->max_spray;
    counts[COUNT_SPRAY_SELECTION_BYTES] = VIRGA_SELECTION_BYTES(whole_groups(def->max_particles));
    counts[COUNT_TABLE] = water_table_entries(def);
    counts[COUNT_DROPLETS] = def->max_droplets;
    count_foam(def, counts);
    counts[COUNT_DRAWN] = def->max_width > 0;
    counts[COUNT_SPLATS] = def->max_width ? def->max_surfels : 0;
    counts[COUNT_DRAWN_ENTRIES] = def->max_width ? list_entries(def->max_surfels) : 0;
    counts[COUNT_SPLAT_SELECTION_BYTES] = def->max_width ? VIRGA_SELECTION_BYTES(whole_groups(def->max_surfels)) : 0;
    counts[COUNT_DIVISIONS] = def->max_parts ? def->max_surfels : 0;
    counts[COUNT_PARTS] = def->max_parts ? (VkDeviceSize)def->max_surfels + def->max_parts : 0;
    counts[COUNT_PYRAMID] = water_pyramid_texels(def, NULL);
    counts[COUNT_PYRAMID_COLUMNS] = water_pyramid_extent(def).width;
    counts[COUNT_PYRAMID_ROWS] = water_pyramid_extent(def).height;
    counts[COUNT_COLUMNS] = def->max_width;
    counts[COUNT_ROWS] = def->max_height;
    /* Bits of blocks that are listed and of those that are open, and the list. */
    counts[COUNT_OPEN_TEXELS] = 2 * squares(def, VIRGA_WATER_BLOCK_PX * VIRGA_WATER_OPEN_COLUMNS,
                                            VIRGA_WATER_BLOCK_PX * VIRGA_WATER_OPEN_ROWS) +
                                (squares(def, VIRGA_WATER_BLOCK_PX, VIRGA_WATER_BLOCK_PX) + 3) / 4;
    /* Tiles without contact lines, and tiles with them. */
    counts[COUNT_TILE_WORDS] = def->max_width ? sizeof(virga_water_tiles_gpu) / sizeof(uint32_t) +
                                                    2 * squares(def, VIRGA_WATER_TILE_PX, VIRGA_WATER_TILE_PX)
                                              : 0;
    counts[COUNT_VIEWS] = WATER_MAX_VIEWS;
}

static const virga_effect_buffer buffers[] = {
    PARTICLE_GRID_BUFFERS(virga_water, "water", COUNT_PARTICLES, COUNT_CELLS, COUNT_SCAN_GROUPS),
    {"water.state", AT(state), VIRGA_USE_INDIRECT, DEVICE, .head = sizeof(virga_water_state_gpu),
     .first = VIRGA_FIRST_FILL},
    {"water.cell_marks", AT(cell_marks), VIRGA_USE_STORAGE, DEVICE, .entry = 4, .count = COUNT_CELLS},
    {"water.selection", AT(selection), VIRGA_USE_STORAGE, DEVICE, .entry = 1, .count = COUNT_SELECTION_BYTES},
    {"water.block_insides", AT(block_insides), VIRGA_USE_STORAGE, DEVICE, .entry = 8, .count = COUNT_BLOCKS},
    {"water.blocks", AT(blocks), VIRGA_USE_INDIRECT, DEVICE, .head = sizeof(virga_list_gpu), .entry = 4,
     .count = COUNT_BLOCKS},
    {"water.block_of", AT(block_of), VIRGA_USE_STORAGE, DEVICE, .entry = 4, .count = COUNT_CELLS},
    {"water.fields", AT(fields), VIRGA_USE_STORAGE, DEVICE, .entry = 4, .count = COUNT_POINTS},
    {"water.block_starts", AT(block_starts), VIRGA_USE_STORAGE, DEVICE, .entry = 4, .count = COUNT_BLOCKS},
    {"water.densities", AT(densities), VIRGA_USE_STORAGE, DEVICE, .entry = 4, .count = COUNT_PARTICLES},
    {"water.shifts", AT(shifts), VIRGA_USE_TEXELS, DEVICE, .entry = 16, .count = COUNT_PARTICLES},
    {"water.shapes", AT(shapes), VIRGA_USE_TEXELS, DEVICE, .entry = 2 * 16, .count = COUNT_PARTICLES},
    {"water.centers", AT(centers), VIRGA_USE_TEXELS, DEVICE, .entry = 16, .count = COUNT_PARTICLES},
    {"water.spray_selection", AT(spray.selection), VIRGA_USE_STORAGE, DEVICE, .entry = 1,
     .count = COUNT_SPRAY_SELECTION_BYTES},
    {"water.spray_list", AT(spray.list), VIRGA_USE_INDIRECT, DEVICE, .head = sizeof(virga_list_gpu), .entry = 4,
     .count = COUNT_SPRAY},
    {"water.splashes", AT(spray.splashes), VIRGA_USE_STORAGE, DEVICE, .head = sizeof(virga_leavers_gpu),
     .entry = 2 * sizeof(virga_leaver_gpu), .count = COUNT_SPRAY, .first = VIRGA_FIRST_FILL},
    {"water.spray_pieces", AT(spray.pieces), VIRGA_USE_STORAGE, DEVICE,
     .entry = 2 * VIRGA_WATER_PIECES * sizeof(virga_water_piece_gpu), .count = COUNT_SPRAY, .first = VIRGA_FIRST_FILL},
    {"water.spray_table", AT(spray.table), VIRGA_USE_STORAGE, DEVICE, .entry = 2 * 4, .count = COUNT_TABLE,
     .first = VIRGA_FIRST_FILL},
    {"water.spray_starts", AT(spray.starts), VIRGA_USE_STORAGE, DEVICE, .entry = 4, .count = COUNT_SPRAY},
    {"water.droplets", AT(spray.droplets), VIRGA_USE_TEXELS, DEVICE, .entry = sizeof(virga_spray_gpu),
     .count = COUNT_DROPLETS, .first = VIRGA_FIRST_FILL, .scratch = true},
    {"water.surfels", AT(surfels), VIRGA_USE_TEXELS, DEVICE, .entry = sizeof(virga_surfel_gpu), .count = COUNT_SURFELS,
     .first = VIRGA_FIRST_FILL, .scratch = true},
    {"water.splat_selection", AT(picture.selection), VIRGA_USE_STORAGE, DEVICE, .entry = 1,
     .count = COUNT_SPLAT_SELECTION_BYTES},
    {"water.splat_list", AT(picture.list), VIRGA_USE_INDIRECT, DEVICE, .entry = 4, .count = COUNT_DRAWN_ENTRIES},
    {"water.splats", AT(picture.splats), VIRGA_USE_TEXELS, DEVICE, .entry = VIRGA_WATER_SPLAT_TEXELS * 16,
     .count = COUNT_SPLATS},
    {"water.divisions", AT(picture.divisions), VIRGA_USE_STORAGE, DEVICE, .entry = 8, .count = COUNT_DIVISIONS},
    {"water.parts", AT(picture.parts), VIRGA_USE_TEXELS, DEVICE, .entry = VIRGA_WATER_PART_TEXELS * 16,
     .count = COUNT_PARTS},
    {"water.prepared", AT(picture.prepared), VIRGA_USE_INDIRECT, DEVICE, .entry = sizeof(virga_water_prepared_gpu),
     .count = COUNT_DRAWN},
    {"water.pyramid", AT(picture.pyramid), VIRGA_USE_STORAGE, DEVICE, .entry = 4, .count = COUNT_PYRAMID},
    {"water.open_blocks", AT(picture.open_blocks), VIRGA_USE_TEXELS, DEVICE, .entry = 16, .count = COUNT_OPEN_TEXELS},
    {"water.tiles", AT(picture.tiles), VIRGA_USE_INDIRECT, DEVICE, .entry = 4, .count = COUNT_TILE_WORDS,
     .per_view = true},
    {"water.foam_selection", AT(foam.selection), VIRGA_USE_STORAGE, DEVICE, .entry = 1,
     .count = COUNT_FOAM_SELECTION_BYTES},
    {"water.foam_slots", AT(foam.slots), VIRGA_USE_STORAGE, DEVICE, .entry = 4, .count = COUNT_FOAM_ENTRIES},
    {"water.foam", AT(foam.particles), VIRGA_USE_STORAGE, DEVICE, .entry = sizeof(virga_foam_gpu), .count = COUNT_FOAM,
     .first = VIRGA_FIRST_FILL},
    {"water.foam_normals", AT(foam.normals), VIRGA_USE_TEXELS, DEVICE, .entry = 16, .count = COUNT_FOAM_SOURCES},
    {"water.foam_emissions", AT(foam.emissions), VIRGA_USE_STORAGE, DEVICE, .entry = 16, .count = COUNT_FOAM_SOURCES},
    {"water.foam_sources", AT(foam.sources), VIRGA_USE_INDIRECT, DEVICE, .entry = 4,
     .count = COUNT_FOAM_SOURCE_ENTRIES},
    {"water.foam_splats", AT(picture.foam_splats), VIRGA_USE_TEXELS, DEVICE, .entry = 2 * 16,
     .count = COUNT_FOAM_SPLATS, .per_view = true},
};

static const virga_effect_ring rings[] = {
    {"water.steps", AT(step_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(virga_water_step_gpu), VIRGA_COUNT_ONE},
    {"water.views", AT(picture.view_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(water_view_block), COUNT_VIEWS},
};

static const virga_effect_image images[] = {
    {"water.thickness", AT(picture.thickness), VK_FORMAT_R32_SFLOAT, COLOR,
     VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT, COUNT_PYRAMID_COLUMNS, COUNT_PYRAMID_ROWS, 1,
     VIRGA_FIRST_STORAGE, .per_view = true},
    {"water.gaps", AT(picture.gaps), VK_FORMAT_R32_UINT, COLOR, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT,
     COUNT_COLUMNS, COUNT_ROWS, 1, VIRGA_FIRST_STORAGE, .per_view = true},
    BLANK_DEPTH("water.blank_depth", picture.blank_depth),
    BLANK_COLOR("water.blank_color", picture.blank_color),
};

static const virga_binding_kind grid_bindings[] = {
    PARTICLE_GRID_BINDING_ROWS(virga_water, step_ring, virga_water_step_gpu),
};

/* The first bindings of all passes of a step but the grid's. */
/* clang-format off */
#define STEP_BINDINGS \
    RING(COMPUTE, step_ring, virga_water_step_gpu), /* 0 */ \
    BUFFER(state),                                 /* 1 */ \
    [WATER_BIND_PARTICLES] = {STORAGE, COMPUTE},                                        /* 2 */ \
    BUFFER(grid.state),                            /* 3 */ \
    BUFFER(grid.cell_starts)                       /* 4 */
/* clang-format on */

static const virga_binding_kind kernel_bindings[] = {
    STEP_BINDINGS,                  /* 0 to 4 */
    BUFFER(grid.sorted),            /* 5 */
    BUFFER(grid.sorted_indices),    /* 6 */
    BUFFER(cell_marks),             /* 7 */
    BUFFER(densities),              /* 8 */
    BUFFER(shifts),                 /* 9 */
    BUFFER(selection),              /* 10 */
    BUFFER(shapes),                 /* 11 */
    BUFFER(centers),                /* 12 */
    TEXEL_BUFFER(grid.sorted),      /* 13 */
    TEXEL_BUFFER(shifts),           /* 14 */
    BUFFER(grid.sorted_velocities), /* 15 */
};

static const virga_binding_kind bindings[] = {
    STEP_BINDINGS,                        /* 0 to 4 */
    BUFFER(centers),                      /* 5 */
    BUFFER(shapes),                       /* 6 */
    BUFFER(cell_marks),                   /* 7 */
    BUFFER(selection),                    /* 8 */
    BUFFER(block_insides),                /* 9 */
    BUFFER(blocks),                       /* 10 */
    BUFFER(block_of),                     /* 11 */
    BUFFER(fields),                       /* 12 */
    BUFFER(block_starts),                 /* 13 */
    BUFFER(grid.sorted_velocities),       /* 14 */
    BUFFER(surfels),                      /* 15 */
    TEXEL_BUFFER(centers),                /* 16 */
    TEXEL_BUFFER(grid.sorted_velocities), /* 17 */
    TEXEL_BUFFER(shapes),                 /* 18 */
};

static const virga_binding_kind spray_bindings[] = {
    STEP_BINDINGS,                            /* 0 to 4 */
    BUFFER(grid.sorted),                      /* 5 */
    BUFFER(grid.sorted_indices),              /* 6 */
    BUFFER(spray.selection),                  /* 7 */
    BUFFER(densities),                        /* 8 */
    BUFFER(spray.list),                       /* 9 */
    BUFFER(spray.splashes),                   /* 10 */
    BUFFER(spray.pieces),                     /* 11 */
    BUFFER(spray.table),                      /* 12 */
    BUFFER(spray.starts),                     /* 13 */
    BUFFER(spray.droplets),                   /* 14 */
    BUFFER(surfels),                          /* 15 */
    TEXEL_BUFFER(spray.droplets),             /* 16 */
    [WATER_BIND_HANDED] = {STORAGE, COMPUTE}, /* 17 */
};

static const virga_binding_kind foam_bindings[] = {
    STEP_BINDINGS,                        /* 0 to 4 */
    BUFFER(grid.sorted),                  /* 5 */
    BUFFER(grid.sorted_indices),          /* 6 */
    BUFFER(foam.selection),               /* 7 */
    BUFFER(densities),                    /* 8 */
    BUFFER(foam.slots),                   /* 9 */
    BUFFER(foam.particles),               /* 10 */
    BUFFER(foam.normals),                 /* 11 */
    BUFFER(foam.emissions),               /* 12 */
    BUFFER(foam.sources),                 /* 13 */
    BUFFER(grid.sorted_velocities),       /* 14 */
    TEXEL_BUFFER(grid.sorted),            /* 15 */
    TEXEL_BUFFER(grid.sorted_velocities), /* 16 */
    TEXEL_BUFFER(foam.normals),           /* 17 */
    [WATER_BIND_BODIES] = {STORAGE, COMPUTE},
};

static const virga_effect_layout layouts[] = {
    [WATER_LAYOUT_GRID] = PARTICLE_GRID_LAYOUT(virga_water, grid_bindings, 1),
    [WATER_LAYOUT_KERNELS] = {AT(kernel_bindings), kernel_bindings, VIRGA_ROWS(kernel_bindings), 1, 0},
    [WATER_LAYOUT_SURFACE] = {AT(bindings), bindings, VIRGA_ROWS(bindings), 1, 0},
    [WATER_LAYOUT_SPRAY] = {AT(spray.bindings), spray_bindings, VIRGA_ROWS(spray_bindings), 1, 0},
    [WATER_LAYOUT_FOAM] = {AT(foam.bindings), foam_bindings, VIRGA_ROWS(foam_bindings), 1, 0},
    [WATER_LAYOUT_DRAW] = {AT(picture.bindings), water_draw_bindings, WATER_DRAW_BINDINGS, WATER_MAX_VIEWS, 0},
};

#define SURFACE(pass)       PASS_AT(surface, pass, pass, .layout = WATER_LAYOUT_SURFACE)
#define SPRAY(pass, member) PASS_AT(spray, pass, spray.member, .layout = WATER_LAYOUT_SPRAY)
#define FOAM(pass, member)  PASS_AT(foam, pass, foam.member, .layout = WATER_LAYOUT_FOAM)
#define PICTURE(pass)       PASS_AT(draw, pass, picture.pass, .layout = WATER_LAYOUT_DRAW)
/* One form for each virga_water_kernel. */
#define KERNEL(pass, row) PASS_AT(surface, pass, pass, .layout = row, .forms = WATER_KERNELS)
static const virga_effect_pass passes[] = {
    PARTICLE_GRID_PASSES(virga_water, "water", WATER_LAYOUT_GRID),
    PASS_AT(surface, cover, cover, .layout = WATER_LAYOUT_KERNELS),
    PASS_AT(surface, relative, relative, .layout = WATER_LAYOUT_KERNELS),
    KERNEL(density, WATER_LAYOUT_KERNELS),
    KERNEL(kernel, WATER_LAYOUT_KERNELS),
    SURFACE(block_mark),
    SURFACE(block_scan),
    SURFACE(block_compact),
    KERNEL(field, WATER_LAYOUT_SURFACE),
    SURFACE(surfel_count),
    SURFACE(surfel_scan),
    SURFACE(edge_write),
    KERNEL(surfel_write, WATER_LAYOUT_SURFACE),
    SPRAY(begin, begin),
    SPRAY(mark, mark),
    SPRAY(scan, scan),
    SPRAY(compact, compact),
    SPRAY(break, break_up),
    SPRAY(fly, fly),
    SPRAY(starts, starts_scan),
    SPRAY(write, write),
    SPRAY(write_pieces, write_pieces),
    SPRAY(range, range),
    SPRAY(surfel, surfel),
    FOAM(move, move),
    FOAM(scan, scan),
    FOAM(list, list_slots),
    FOAM(normal, normal),
    FOAM(potential, potential),
    FOAM(source_scan, source_scan),
    FOAM(source_list, source_list),
    FOAM(starts, starts),
    FOAM(make, make),
    PICTURE(splat_mark),
    PICTURE(splat_scan),
    PICTURE(splat_compact),
    PICTURE(splat_write),
    PICTURE(splat_gaps),
    PICTURE(splat_close),
    PICTURE(contact_tiles),
    PICTURE(divide_mark),
    PICTURE(divide_scan),
    PICTURE(divide_write),
    PICTURE(volume),
    PICTURE(volume_merge),
    PICTURE(foam),
};

static const virga_effect_pool pools[] = {
    POOL(max_parts, 0, 256),
    POOL(max_foam, 0, 256),
    POOL(max_surfels, 256, 256),
    POOL(max_droplets, 256, 256),
    POOL(max_spray, 64, 64),
    POOL(max_blocks, 64, 64),
    POOL(max_cells, 4096, VIRGA_GRID_SCAN_CELLS),
    POOL(max_particles, 64, 64),
};

static virga_result create(void *object)
{
    return water_images_create(object);
}

static void destroy(void *object)
{
    water_images_retire(object);
}

static virga_result check_settings(const void *object, void *given, bool *changed)
{
    const virga_water *water = object;
    virga_water_settings *settings = given;
    if (settings->shading != VIRGA_WATER_SHADING_SURFELS || water->def.max_parts || !water->def.max_width)
        return VIRGA_OK;
    virga_log_write(
        &water->base.context->log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED,
        "water_settings.shading: surfels need water_def.max_parts, which is 0: light is computed in pixels");
    settings->shading = VIRGA_WATER_SHADING_PIXELS;
    *changed = true;
    return VIRGA_OK;
}

static VkDeviceSize extra_bytes(const void *def)
{
    return water_images_bytes(def);
}

/* For scenes: water without a size is not drawn, which is no error there. */
static virga_result prepare(void *object, VkCommandBuffer cmd, const virga_view *view, double time_s,
                            virga_prepared *prepared)
{
    (void)time_s; /* the host's particles are at that time */
    *prepared = 0;
    return ((virga_water *)object)->def.max_width ? virga_water_prepare_view(object, cmd, view, prepared) : VIRGA_OK;
}

static void describe(const void *object, char *line, size_t size)
{
    const virga_water *water = object;
    snprintf(line, size, "water: up to %u particles and %u surfels", water->def.max_particles, water->def.max_surfels);
}

/* ---- state: what goes on from step to step; the surface is made anew in each */

static const virga_effect_state_row state_rows[] = {
    STATE(origin_m),    STATE(spray_goes_on),      STATE(spray_serial), STATE(spray_time_s), STATE(spray_hands_over),
    STATE(spray_first), STATE(spray_first_time_s), STATE(spray_style),  STATE(foam_time_s),  STATE(foam_late_s),
};

VIRGA_EFFECT_FUNCTIONS(water)
VIRGA_EFFECT_STATE_FUNCTIONS(water)
VIRGA_EFFECT_STATISTICS_FUNCTION(water)
VIRGA_EFFECT_VIEW_FUNCTIONS(water)

/* For scenes, as `prepare`. */
static virga_result draw_if_sized(void *object, VkCommandBuffer cmd, const virga_target *target,
                                  virga_prepared prepared)
{
    virga_water *water = object;
    if (!water->def.max_width)
        return VIRGA_OK;
    const virga_result result = water_type_draw(object, cmd, target, prepared);
    if (result)
        return result;
    return prepared == VIRGA_PREPARED_NEWEST ? virga_water_draw_foam(water, cmd, target)
                                             : virga_water_draw_foam_view(water, cmd, target, prepared);
}

const virga_effect_type water_type = {
    VIRGA_EFFECT_TYPE(water, "water", "water_settings"),
    VIRGA_TABLE(image),
    VIRGA_CALLBACKS(fit_device, create, destroy, extra_bytes, check_settings, prepare),
    .lighting = offsetof(virga_water_settings, lighting),
    .draws = water_draws,
    .draw_count = WATER_DRAWS,
    .draw_layout = WATER_LAYOUT_DRAW,
    .draw = draw_if_sized,
    .max_views = offsetof(virga_water_def, max_views),
    VIRGA_TABLE(state_row),
    .check_state = water_check_state,
};

/* ---- queries */

static virga_water_buffer whole_buffer(const virga_water *water, const virga_buffer *buffer)
{
    return water->base.contents ? (virga_water_buffer){buffer->buffer, 0, buffer->size} : (virga_water_buffer){0};
}

void virga_water_surfels(const virga_water *water, virga_water_buffer *surfels, double origin_m[3])
{
    if (surfels)
        *surfels = water ? whole_buffer(water, water->surfels) : (virga_water_buffer){0};
    for (int axis = 0; origin_m && axis < 3; axis++)
        origin_m[axis] = water ? water->origin_m[axis] : 0;
}

void virga_water_spray(const virga_water *water, virga_water_buffer *droplets, double origin_m[3])
{
    if (droplets)
        *droplets = water ? whole_buffer(water, water->spray.droplets) : (virga_water_buffer){0};
    for (int axis = 0; origin_m && axis < 3; axis++)
        origin_m[axis] = water ? water->origin_m[axis] : 0;
}

void virga_water_foam(const virga_water *water, virga_water_buffer *foam, double origin_m[3])
{
    if (foam)
        *foam = water && water->foam.particles ? whole_buffer(water, water->foam.particles) : (virga_water_buffer){0};
    for (int axis = 0; origin_m && axis < 3; axis++)
        origin_m[axis] = water ? water->origin_m[axis] : 0;
}

void virga_water_densities(const virga_water *water, virga_water_buffer *densities)
{
    if (densities)
        *densities = water ? whole_buffer(water, water->densities) : (virga_water_buffer){0};
}

void virga_water_leavers_get(const virga_water *water, virga_water_leavers *leavers)
{
    if (!leavers)
        return;
    *leavers = (virga_water_leavers){0};
    if (water && water->base.contents)
        *leavers = (virga_water_leavers){water->spray.splashes->buffer, water->spray.table->buffer,
                                         water->spray.splashes->size, water->spray.table->size};
}
