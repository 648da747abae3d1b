/* fluid/fluid.c - creates and destroys fluid objects, applies settings, takes blocks of water, and answers queries. */
#include "fluid/fluid_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/errors.h"

#define EFFECT fluid
#include "gpu/effect_rows.h"

#include "shaders/fluid_shaders.h"
#include "shaders/particles_shaders.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- defaults */

static const virga_setting_row def_rows[] = {
    DEF(U32, max_particles, 64, 2097152, 65536),
    DEF(U32, max_cells, 4096, 16777216, 262144),
    DEF(U32, max_substeps, 1, 64, 8),
    DEF(U32, max_iterations, 1, 100, 20),
    DEF(U32, max_bodies, 0, VIRGA_FLUID_MAX_BODIES),
    DEF(U32, max_body_nodes, 4096, 16777216, 262144),
    DEF(U32, max_contacts, 256, 1048576, 16384),
    DEF(U32, max_exchanged, 0, 1048576),
};

static const virga_setting_row setting_rows[] = {
    SETTING(FLOAT, spacing_m, 1e-4, 10, 0.02),
    SETTING(FLOAT, viscosity_m2_s, 0, 10, 0.001),
    SETTING(FLOAT, cfl, 0.05, 1, 0.4),
    SETTING(FLOAT, solver_error, 1e-6, 0.01, 0.0001),
    SETTING(BOOL, gives_back, false, true, true),
    SETTING(BOOL, open_sides, false, true),
    SETTING(FLOAT, rest_speed_m_s, 0, 10, 0.1),
    SETTING(FLOAT, film_speed_m_s, 0, 10, 0.5),
    SETTING(FLOAT, rest_s, 0, 60, 0.25),
    SETTING(FLOAT, rest_height_m, 0, 100, 0.05),
};

static void fill_settings(void *given)
{
    static const float low_m[3] = {-0.5f, 0, -0.5f}, high_m[3] = {0.5f, 1, 0.5f}, gravity_m_s2[3] = {0, -9.81f, 0};
    virga_fluid_settings *settings = given;
    memcpy(settings->low_m, low_m, sizeof low_m);
    memcpy(settings->high_m, high_m, sizeof high_m);
    memcpy(settings->gravity_m_s2, gravity_m_s2, sizeof gravity_m_s2);
}

static virga_result check_def(const virga_log *log, void *given)
{
    virga_fluid_def *def = given;
    (void)log;
    def->max_cells = particle_grid_cells(def->max_cells);
    fluid_fit_exchanged(def);
    return VIRGA_OK;
}

/* The lists are the largest buffer by far. */
static virga_result fit_device(const virga_context *context, void *given)
{
    virga_fluid_def *def = given;
    const bool reduced =
        virga_fit_storage(context, "fluid_def.max_particles", 16 * VIRGA_FLUID_LIST_TEXELS, &def->max_particles);
    fluid_fit_exchanged(def);
    return reduced ? VIRGA_DEGRADED : VIRGA_OK;
}

/* ---- resources */

enum {
    COUNT_PARTICLES = 1,
    COUNT_CELLS,
    COUNT_SCAN_GROUPS,
    COUNT_LIST_TEXELS,
    COUNT_BLOCKS,
    COUNT_CONTACTS,
    COUNT_TOUCHES,
    COUNT_NODES,
    COUNT_PRESSURES,
    COUNT_ENTRIES
};

static void count(const void *given, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS])
{
    const virga_fluid_def *def = given;
    counts[COUNT_PARTICLES] = def->max_particles;
    counts[COUNT_CELLS] = def->max_cells;
    counts[COUNT_SCAN_GROUPS] = def->max_cells / VIRGA_GRID_SCAN_CELLS;
    counts[COUNT_LIST_TEXELS] = (VkDeviceSize)def->max_particles * VIRGA_FLUID_LIST_TEXELS;
    counts[COUNT_BLOCKS] = FLUID_MAX_BLOCKS + 1;
    /* A buffer that no pass reads has a texel. */
    counts[COUNT_CONTACTS] = def->max_bodies ? VIRGA_FLUID_MAX_BODIES * (VkDeviceSize)def->max_contacts : 1;
    counts[COUNT_TOUCHES] = def->max_bodies ? VIRGA_FLUID_TOUCHES * (VkDeviceSize)def->max_particles : 1;
    counts[COUNT_PRESSURES] = (def->max_exchanged ? 2 : 1) * (VkDeviceSize)def->max_particles;
    counts[COUNT_ENTRIES] = 2 * (VkDeviceSize)(def->max_exchanged ? def->max_exchanged : 1);
    counts[COUNT_NODES] = def->max_bodies ? def->max_body_nodes : 1;
}

static const virga_effect_buffer buffers[] = {
    PARTICLE_GRID_BUFFERS(virga_fluid, "fluid", COUNT_PARTICLES, COUNT_CELLS, COUNT_SCAN_GROUPS),
    {"fluid.state", AT(state), VIRGA_USE_INDIRECT, DEVICE, .head = sizeof(virga_fluid_state_gpu),
     .first = VIRGA_FIRST_FILL},
    {"fluid.particles", AT(slots), VIRGA_USE_STORAGE, DEVICE, .entry = sizeof(virga_particle_gpu),
     .count = COUNT_PARTICLES, .first = VIRGA_FIRST_FILL},
    {"fluid.pressures", AT(slot_pressures), VIRGA_USE_STORAGE, DEVICE, .entry = 8, .count = COUNT_PRESSURES,
     .first = VIRGA_FIRST_FILL},
    {"fluid.moved", AT(moved), VIRGA_USE_TEXELS, DEVICE, .entry = 16, .count = COUNT_PARTICLES},
    {"fluid.walls", AT(walls), VIRGA_USE_TEXELS, DEVICE, .entry = 16, .count = COUNT_PARTICLES},
    {"fluid.solved", AT(solved), VIRGA_USE_STORAGE, DEVICE, .entry = 8, .count = COUNT_PARTICLES},
    {"fluid.bodies", AT(body_states), VIRGA_USE_STORAGE, DEVICE,
     .head = VIRGA_FLUID_MAX_BODIES * sizeof(virga_fluid_body_gpu), .entry = 4, .count = COUNT_CONTACTS,
     .first = VIRGA_FIRST_FILL},
    {"fluid.touches", AT(touches), VIRGA_USE_TEXELS, DEVICE, .entry = 16, .count = COUNT_TOUCHES},
    {"fluid.maps", AT(maps), VIRGA_USE_TEXELS, DEVICE, .entry = 16, .count = COUNT_NODES},
    {"fluid.exchange", AT(exchange), VIRGA_USE_INDIRECT, DEVICE, .head = sizeof(virga_exchange_gpu),
     .entry = sizeof(virga_exchanged_gpu), .count = COUNT_ENTRIES, .first = VIRGA_FIRST_FILL},
    {"fluid.lists", AT(lists), VIRGA_USE_TEXELS, DEVICE, .entry = 16, .count = COUNT_LIST_TEXELS},
    {"fluid.gradients", AT(gradients), VIRGA_USE_TEXELS, DEVICE, .entry = 16, .count = COUNT_LIST_TEXELS},
};

static const virga_effect_ring rings[] = {
    {"fluid.steps", AT(step_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(virga_fluid_step_gpu), VIRGA_COUNT_ONE},
    {"fluid.shapes", AT(shape_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(virga_fluid_shapes_gpu), VIRGA_COUNT_ONE},
    {"fluid.adds", AT(add_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(virga_fluid_add_gpu), COUNT_BLOCKS},
};

static const virga_binding_kind grid_bindings[] = {
    PARTICLE_GRID_BINDING_ROWS(virga_fluid, step_ring, virga_fluid_step_gpu),
};

static const virga_binding_kind add_bindings[] = {
    RING(COMPUTE, add_ring, virga_fluid_add_gpu), /* 0 */
    BUFFER(state),                                /* 1 */
    BUFFER(slots),                                /* 2 */
    [FLUID_BIND_ADDED] = {STORAGE, COMPUTE},      /* 3 */
    BUFFER(slot_pressures),                       /* 4 */
};

static const virga_binding_kind bindings[] = {
    RING(COMPUTE, step_ring, virga_fluid_step_gpu),    /* 0 */
    BUFFER(state),                                     /* 1 */
    BUFFER(slots),                                     /* 2 */
    BUFFER(grid.state),                                /* 3 */
    BUFFER(grid.cell_starts),                          /* 4 */
    BUFFER(grid.sorted),                               /* 5 */
    BUFFER(grid.sorted_indices),                       /* 6 */
    BUFFER(body_states),                               /* 7 */
    BUFFER(slot_pressures),                            /* 8 */
    BUFFER(solved),                                    /* 9 */
    BUFFER(grid.sorted_velocities),                    /* 10 */
    BUFFER(gradients),                                 /* 11 */
    BUFFER(moved),                                     /* 12 */
    BUFFER(walls),                                     /* 13 */
    BUFFER(lists),                                     /* 14 */
    TEXEL_BUFFER(grid.sorted),                         /* 15 */
    TEXEL_BUFFER(grid.sorted_velocities),              /* 16 */
    TEXEL_BUFFER(gradients),                           /* 17 */
    TEXEL_BUFFER(moved),                               /* 18 */
    TEXEL_BUFFER(walls),                               /* 19 */
    TEXEL_BUFFER(lists),                               /* 20 */
    BUFFER(touches),                                   /* 21 */
    TEXEL_BUFFER(touches),                             /* 22 */
    BUFFER(maps),                                      /* 23 */
    TEXEL_BUFFER(maps),                                /* 24 */
    RING(COMPUTE, shape_ring, virga_fluid_shapes_gpu), /* 25 */
};

static const virga_binding_kind exchange_bindings[] = {
    RING(COMPUTE, step_ring, virga_fluid_step_gpu), /* 0 */
    BUFFER(slots),                                  /* 1 */
    BUFFER(slot_pressures),                         /* 2 */
    BUFFER(exchange),                               /* 3 */
    [FLUID_BIND_LEAVERS] = {STORAGE, COMPUTE},      /* 4 */
};

static const virga_effect_layout layouts[] = {
    [FLUID_LAYOUT_GRID] = PARTICLE_GRID_LAYOUT(virga_fluid, grid_bindings, 1),
    [FLUID_LAYOUT_ADD] = {AT(add_bindings), add_bindings, VIRGA_ROWS(add_bindings), 1, 0},
    [FLUID_LAYOUT_STEP] = {AT(bindings), bindings, VIRGA_ROWS(bindings), 1, 0},
    [FLUID_LAYOUT_EXCHANGE] = {AT(exchange_bindings), exchange_bindings, VIRGA_ROWS(exchange_bindings), 1, 0},
};

#define STEP_PASS(pass) PASS(pass, .layout = FLUID_LAYOUT_STEP)
#define GRID_PASS(pass) PARTICLE_GRID_PASS(virga_fluid, "fluid", pass, FLUID_LAYOUT_GRID)
static const virga_effect_pass passes[] = {
    PASS(add, .layout = FLUID_LAYOUT_ADD),
    STEP_PASS(begin),
    PASS(count, .layout = FLUID_LAYOUT_GRID),
    GRID_PASS(thin),
    GRID_PASS(sums),
    GRID_PASS(scan),
    GRID_PASS(offsets),
    GRID_PASS(fill),
    GRID_PASS(order),
    STEP_PASS(copy),
    PASS_SHUFFLE(neighbours, .layout = FLUID_LAYOUT_STEP),
    STEP_PASS(neighbours),
    STEP_PASS(push),
    PASS_SHUFFLE(correct, .layout = FLUID_LAYOUT_STEP),
    STEP_PASS(correct),
    STEP_PASS(body_contacts),
    STEP_PASS(body_push),
    STEP_PASS(body_move),
    STEP_PASS(advance),
    STEP_PASS(body_hit),
    STEP_PASS(body_near),
    PASS(exchange_spray, .layout = FLUID_LAYOUT_EXCHANGE),
    PASS(exchange_in, .layout = FLUID_LAYOUT_EXCHANGE),
    PASS(exchange_out, .layout = FLUID_LAYOUT_EXCHANGE),
};

static const virga_effect_pool pools[] = {
    POOL(max_particles, 64, 64),
    POOL(max_cells, 4096, VIRGA_GRID_SCAN_CELLS),
};

static void describe(const void *object, char *line, size_t size)
{
    const virga_fluid *fluid = object;
    snprintf(line, size, "fluid: up to %u particles", fluid->def.max_particles);
}

/* ---- settings */

#define MAX_POSITION_M 10000.0f
#define MIN_SPACINGS   4 /* of a side of the box */

void fluid_grid_box(const virga_fluid_settings *settings, int32_t first[3], uint32_t dims[3])
{
    const float inv_cell_m = 1 / (2 * settings->spacing_m);
    for (int axis = 0; axis < 3; axis++) {
        const int32_t low = (int32_t)floorf(settings->low_m[axis] * inv_cell_m);
        const int32_t high = (int32_t)floorf(settings->high_m[axis] * inv_cell_m);
        first[axis] = low - VIRGA_GRID_MARGIN;
        dims[axis] = (uint32_t)(high - low + 1 + 2 * VIRGA_GRID_MARGIN);
    }
}

static virga_result check_box(const virga_fluid *fluid, const virga_fluid_settings *settings)
{
    const virga_log *log = &fluid->base.context->log;
    int32_t first[3];
    uint32_t dims[3];
    for (int axis = 0; axis < 3; axis++) {
        const double side = (double)settings->high_m[axis] - (double)settings->low_m[axis];
        const double spacing = (double)settings->spacing_m;
        if (side < MIN_SPACINGS * spacing)
            return virga_wrong_argument(log,
                                        "fluid_settings.high_m[%d]: expected at least %d spacings of %g m above "
                                        "low_m, got a side of %g m",
                                        axis, MIN_SPACINGS, spacing, side);
        if (side > 2 * spacing * fluid->def.max_cells || fabsf(settings->low_m[axis]) / settings->spacing_m > 4e5f ||
            fabsf(settings->high_m[axis]) / settings->spacing_m > 4e5f)
            return virga_wrong_argument(log,
                                        "fluid_settings.low_m, high_m: too large or too far for particles %g m "
                                        "apart",
                                        spacing);
    }
    fluid_grid_box(settings, first, dims);
    if ((double)dims[0] * dims[1] * dims[2] > fluid->def.max_cells)
        return virga_wrong_argument(log,
                                    "fluid_settings.low_m, high_m: the box needs %u x %u x %u cells, and "
                                    "fluid_def.max_cells is %u",
                                    dims[0], dims[1], dims[2], fluid->def.max_cells);
    return VIRGA_OK;
}

static uint32_t pass_constant(const void *object)
{
    const virga_fluid_def *def = &((const virga_fluid *)object)->def;
    return (def->max_bodies ? VIRGA_FLUID_FORM_BODIES : 0) | (def->max_exchanged ? VIRGA_FLUID_FORM_EXCHANGE : 0);
}

/* While the map of a body is on its way to the device. */
static VkDeviceSize extra_bytes(const void *given)
{
    const virga_fluid_def *def = given;
    return def->max_bodies ? (VkDeviceSize)def->max_body_nodes * 16 : 0;
}

/* The first slots are for water of the ground. */
static virga_result init(void *object)
{
    virga_fluid *fluid = object;
    fluid->particles = fluid->def.max_exchanged;
    return VIRGA_OK;
}

static void destroy(void *object)
{
    fluid_remove_bodies(object);
}

static virga_result check_settings(const void *object, void *settings, bool *changed)
{
    const virga_fluid *fluid = object;
    const virga_log *log = &fluid->base.context->log;
    virga_fluid_settings *next = settings;
    if (virga_settings_check_finite(log, "fluid_settings.low_m", next->low_m, 3) ||
        virga_settings_check_finite(log, "fluid_settings.high_m", next->high_m, 3) ||
        virga_settings_check_finite(log, "fluid_settings.gravity_m_s2", next->gravity_m_s2, 3))
        return VIRGA_ERROR_INVALID;
    virga_clamp_vector(log, "fluid_settings.low_m", next->low_m, MAX_POSITION_M, changed);
    virga_clamp_vector(log, "fluid_settings.high_m", next->high_m, MAX_POSITION_M, changed);
    virga_clamp_vector(log, "fluid_settings.gravity_m_s2", next->gravity_m_s2, VIRGA_MAX_ACCELERATION_M_S2, changed);
    if (fluid->body_count && next->spacing_m != fluid->settings.spacing_m)
        return virga_wrong_argument(log, "fluid_settings.spacing_m: expected %g, as there are bodies, got %g",
                                    (double)fluid->settings.spacing_m, (double)next->spacing_m);
    return fluid_check_exchange(fluid, next) ? VIRGA_ERROR_INVALID : check_box(fluid, next);
}

/* ---- state */

#define MATCHING(name, member)                                                 \
    {                                                                          \
        name, AT(member), sizeof((virga_fluid *)0)->member, .must_match = true \
    }
static const virga_effect_state_row state_rows[] = {
    MATCHING("fluid_settings.low_m", settings.low_m),
    MATCHING("fluid_settings.high_m", settings.high_m),
    MATCHING("fluid_settings.gravity_m_s2", settings.gravity_m_s2),
    MATCHING("the number of bodies", body_count),
    STATE(particles),
    STATE(blocks),
    STATE(block_count),
    STATE(bodies),
    STATE(region_low_m),
    STATE(region_high_m),
    STATE(empties),
};

VIRGA_EFFECT_FUNCTIONS(fluid)
VIRGA_EFFECT_STATE_FUNCTIONS(fluid)
VIRGA_EFFECT_STATISTICS_FUNCTION(fluid)

const virga_effect_type fluid_type = {
    VIRGA_EFFECT_TYPE(fluid, "fluid", "fluid_settings"),
    VIRGA_CALLBACKS(fit_device, init, fill_settings, check_settings, pass_constant, extra_bytes, destroy),
    .lost = fluid_lost,
    VIRGA_TABLE(state_row),
    .check_state = fluid_check_state,
    .state_loaded = fluid_state_loaded,
};

/* ---- blocks of water */

/* Particles along an axis; 0 if there is none, or far too many. */
static uint32_t particles_along(const virga_fluid_block *block, int axis, double spacing)
{
    const double side = (double)block->high_m[axis] - (double)block->low_m[axis], along = floor(side / spacing + 0.5);
    return along >= 1 && along <= 1e6 ? (uint32_t)along : 0;
}

static virga_result check_block(const virga_log *log, const virga_fluid_block *block)
{
    for (int axis = 0; axis < 3; axis++)
        if (!(fabsf(block->low_m[axis]) <= MAX_POSITION_M && fabsf(block->high_m[axis]) <= MAX_POSITION_M &&
              fabsf(block->velocity_m_s[axis]) <= VIRGA_MAX_SPEED_M_S))
            return virga_wrong_argument(log, "fluid_block: axis %d from %g to %g m at %g m/s is out of range", axis,
                                        (double)block->low_m[axis], (double)block->high_m[axis],
                                        (double)block->velocity_m_s[axis]);
    return VIRGA_OK;
}

virga_result virga_fluid_add(virga_fluid *fluid, const virga_fluid_block *block)
{
    if (!fluid)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &fluid->base.context->log;
    if (!block)
        return virga_wrong_argument(log, "virga_fluid_add: NULL argument");
    if (fluid->base.context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    const double spacing = (double)fluid->settings.spacing_m;
    if (check_block(log, block))
        return VIRGA_ERROR_INVALID;
    if (fluid->block_count == FLUID_MAX_BLOCKS)
        return virga_wrong_argument(log, "virga_fluid_add: expected up to %d blocks between two steps",
                                    FLUID_MAX_BLOCKS);
    virga_fluid_add_gpu add = {.spacing_m = fluid->settings.spacing_m, .first_slot = fluid->particles};
    double count = 1;
    for (int axis = 0; axis < 3; axis++) {
        add.counts[axis] = particles_along(block, axis, spacing);
        add.low_m[axis] = block->low_m[axis] + fluid->settings.spacing_m / 2;
        add.velocity_m_s[axis] = block->velocity_m_s[axis];
        count *= add.counts[axis];
    }
    if (!(count >= 1))
        return virga_wrong_argument(log, "fluid_block: a block of %u x %u x %u particles", add.counts[0], add.counts[1],
                                    add.counts[2]);
    if (count > fluid->def.max_particles - fluid->particles)
        return virga_wrong_argument(log, "fluid_block: %.0f particles, and there is room for %u more", count,
                                    fluid->def.max_particles - fluid->particles);
    add.count = (uint32_t)count;
    add.first_id = fluid->particles;
    fluid->particles += add.count;
    fluid->blocks[fluid->block_count++] = add;
    return VIRGA_OK;
}

virga_result virga_fluid_clear(virga_fluid *fluid)
{
    if (!fluid)
        return VIRGA_ERROR_INVALID;
    fluid_remove_bodies(fluid);
    fluid->particles = fluid->def.max_exchanged;
    fluid->block_count = 0;
    fluid->empties = fluid->def.max_exchanged > 0;
    memset(fluid->sent, 0, sizeof fluid->sent);
    return VIRGA_OK;
}

/* ---- queries */

static virga_fluid_buffer first_bytes(const virga_fluid *fluid, const virga_buffer *buffer, VkDeviceSize each)
{
    const bool any = fluid->base.contents && fluid->particles;
    return any ? (virga_fluid_buffer){buffer->buffer, 0, fluid->particles * each} : (virga_fluid_buffer){0};
}

void virga_fluid_particles(const virga_fluid *fluid, virga_fluid_buffer *particles, uint32_t *number)
{
    const virga_fluid_buffer found =
        fluid ? first_bytes(fluid, fluid->slots, sizeof(virga_particle_gpu)) : (virga_fluid_buffer){0};
    if (particles)
        *particles = found;
    if (number)
        *number = (uint32_t)(found.size / sizeof(virga_particle_gpu));
}

void virga_fluid_pressures(const virga_fluid *fluid, virga_fluid_buffer *pressures)
{
    if (pressures)
        *pressures = fluid ? first_bytes(fluid, fluid->slot_pressures, 8) : (virga_fluid_buffer){0};
}
