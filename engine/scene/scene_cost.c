/* scene/scene_cost.c - what a definition takes on a kind of device, before there is one.
 *
 * A table says what each part of a frame takes for each of the units that it grows with, on software Vulkan with two
 * cores: medians of tests/bench. On GPUs these are divided by a ratio of speeds, which is about that of the measured
 * times to the cycles in tests/bench/amd_navi21.txt. E.g. for moving a drop it is 5 and 60, for a texel of the ground's
 * maps 15 and 190, for a particle's density 12 and 150. A dispatch takes the same time whatever is in it. */
#include <virga/quality.h>

#include "scene/scene_internal.h"

#include <math.h>
#include <string.h>

/* What work grows with. */
typedef enum unit {
    SLOTS,        /* of drops */
    STREAKS,      /* drops in view */
    STREAK_ROWS,  /* the same, times the side of the picture in pixels */
    MAP_TEXELS,   /* of occlusion maps */
    GROUNDS,      /* 1, if there is one */
    CELLS,        /* of the ground */
    FLOWN_CELLS,  /* of them that flow in a tick */
    RIPPLES,      /* texels */
    SPLASHES,     /* that live in a storm */
    PANES,        /* number of panes */
    PANE_DROPS,   /* that live in a storm, on all panes */
    PANE_TEXELS,  /* of their height maps */
    PANE_PIXELS,  /* that they cover */
    PARTICLES,    /* of water */
    WATER_PIXELS, /* of the images that water is drawn from */
    PIXELS,       /* of the view */
    UNITS
} unit;

enum { TICK, FRAME, DRAW, STAGES };

typedef struct cost_row {
    int stage;
    unit grows_with;
    double ns;         /* for each of them, on two cores */
    double dispatches; /* if there are any */
} cost_row;

static const cost_row rows[] = {
    {TICK, SLOTS, 9, 2},           /* step */
    {TICK, SLOTS, 41, 6},          /* impacts */
    {TICK, GROUNDS, 7e6, 6},       /* land: by impacts, of which a storm has as many at all qualities */
    {TICK, FLOWN_CELLS, 21, 1},    /* flow */
    {TICK, SPLASHES, 1000, 8},     /* step and spawns */
    {TICK, PANE_DROPS, 2900, 45},  /* motion, spawns, wipers, particles */
    {FRAME, MAP_TEXELS, 4, 4},     /* occlusion */
    {FRAME, RIPPLES, 30, 2},       /* rings */
    {FRAME, CELLS, 46, 3},         /* maps and sums */
    {FRAME, SLOTS, 35, 7},         /* prepare */
    {FRAME, SPLASHES, 430, 7},     /* prepare */
    {FRAME, PANE_TEXELS, 53, 12},  /* film, balls, height map, plate */
    {FRAME, PARTICLES, 2600, 40},  /* grid to surfels, spray, foam */
    {FRAME, WATER_PIXELS, 55, 12}, /* thickness and splats */
    {DRAW, STREAKS, 330, 1},       /* streaks: their corners ... */
    {DRAW, STREAK_ROWS, 0.58, 0},  /* ... and their pixels */
    {DRAW, PIXELS, 15, 1},         /* haze */
    {DRAW, SPLASHES, 1200, 2},     /* sprites */
    {DRAW, PANE_PIXELS, 45, 1},    /* refraction */
    {DRAW, WATER_PIXELS, 75, 2},   /* reflection, refraction, foam */
};

#define IN_VIEW     0.045 /* share of all drops that a view shows */
#define LIVE_IN_AIR 3000  /* splashes around the camera at 50 mm/h */
#define LIVE_ON     3000  /* drops on a pane */
#define FLOW_PASSES 4     /* for a round of flow */

static double least(double a, double b)
{
    return a < b ? a : b;
}

static void count_units(const virga_scene_def *def, double width, double height, double units[UNITS])
{
    const double pixels = width * height, cells = (double)def->ground.cells * def->ground.cells;
    memset(units, 0, UNITS * sizeof *units);
    units[PIXELS] = pixels;
    units[SLOTS] = def->rain.max_drops;
    units[STREAKS] = IN_VIEW * units[SLOTS];
    if (def->rain.max_streaks)
        units[STREAKS] = least(units[STREAKS], def->rain.max_streaks);
    units[STREAK_ROWS] = units[STREAKS] * sqrt(pixels);
    units[MAP_TEXELS] = (double)def->rain.occlusion_size * def->rain.occlusion_size * def->rain.occlusion_cascades *
                        def->rain.occlusion_slants;
    if (def->with_ground) {
        units[GROUNDS] = 1;
        units[CELLS] = cells;
        units[FLOWN_CELLS] = cells * FLOW_PASSES / (def->ground.flow_ticks > 0 ? def->ground.flow_ticks : 1);
        units[RIPPLES] = (double)def->ground.ripple_texels * def->ground.ripple_texels;
    }
    if (def->with_splash)
        units[SPLASHES] = least(LIVE_IN_AIR, def->splash.max_splashes);
    for (uint32_t i = 0; i < def->pane_count; i++) {
        const double texels = def->panes[i].max_texels;
        units[PANES]++;
        units[PANE_DROPS] += least(LIVE_ON, def->panes[i].max_drops);
        units[PANE_TEXELS] += least(texels, width) * least(texels, height);
        units[PANE_PIXELS] += pixels;
    }
    if (def->with_water) {
        units[PARTICLES] = def->water.max_particles;
        units[WATER_PIXELS] = least(width, def->water.max_width) * least(height, def->water.max_height);
    }
}

/* How often faster than two cores, and how long a dispatch takes (ms). False for a kind that does not exist. */
static bool speed_of(VkPhysicalDeviceType kind, double *faster, double *dispatch_ms)
{
    *dispatch_ms = 0.007;
    switch (kind) {
    case VK_PHYSICAL_DEVICE_TYPE_OTHER:
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: *faster = 8; return true;
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: *faster = 80; return true;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        *faster = 1;
        *dispatch_ms = 0.045;
        return true;
    default: return false;
    }
}

virga_result virga_scene_cost(const virga_scene_def *def, VkPhysicalDeviceType kind, uint32_t width, uint32_t height,
                              virga_scene_costs *costs)
{
    double units[UNITS], sums[STAGES] = {0}, faster, dispatch_ms;
    if (!costs)
        return VIRGA_ERROR_INVALID;
    memset(costs, 0, sizeof *costs);
    if (width < 1 || width > 16384 || height < 1 || height > 16384 || !speed_of(kind, &faster, &dispatch_ms))
        return VIRGA_ERROR_INVALID;
    costs->memory_bytes = virga_scene_estimate(def);
    if (!costs->memory_bytes)
        return VIRGA_ERROR_INVALID;
    count_units(def, width, height, units);
    for (size_t i = 0; i < VIRGA_ROWS(rows); i++) {
        const double count = units[rows[i].grows_with], objects = rows[i].grows_with == PANE_DROPS ? units[PANES] : 1;
        sums[rows[i].stage] += count * rows[i].ns * 1e-6 / faster;
        if (count > 0)
            sums[rows[i].stage] += rows[i].dispatches * objects * dispatch_ms;
    }
    costs->tick_ms = (float)sums[TICK];
    costs->frame_ms = (float)sums[FRAME];
    costs->draw_ms = (float)sums[DRAW];
    return VIRGA_OK;
}
