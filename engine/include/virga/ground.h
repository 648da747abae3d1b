/* virga/ground.h - ground that gets wet: cells with a material, a height and counted water.
 *
 * Meshes that are marked as ground (virga_occluder.ground) get cells of a few centimetres. Rain on them goes through
 * these stages: the first drops leave dark spots, pores fill up, a film forms, flows downhill and gathers in puddles.
 * The water sinks in, runs into drains and dries. The model of drops is that of Mizukami et al., "Rendering of water
 * splash", section 4.6; what happens between drops (flow, infiltration, evaporation) is added here.
 *
 * Water is counted in whole nanolitres. All that has landed is on the ground, in it, run off or evaporated, to the last
 * nanolitre.
 *
 * Window. The cells are a square window around the camera. When it moves, tiles of 64 x 64 cells that leave it are
 * cached with their water, up to def.cached_tiles of them. Beyond that, the tiles that left longest ago are dropped;
 * their water is counted as evicted. There is one cell per (x, z): where surfaces lie above one another, it is that of
 * the highest one that is ground.
 *
 * Far map. Beyond the window there is a wider map, which counts no water (def.far_cells). It shows ground that has
 * stood in the rain for as long as the ground effect has lived, in the open or under cover. Cells that come into the
 * window for the first time start in that state. The host says in each step how much rain that is
 * (step_info.open_rain_mm_h). Blend from one map to the other, and the road is wet as far as it is visible.
 *
 * A frame: after virga_rain_step, and outside rendering,
 *
 *     virga_ground_step(ground, cmd, &info);
 *
 * Then the host samples the maps (virga_ground_maps_get) in its own materials; virga/shared/ground_map.glsl shows how.
 *
 * Deterministic: the same drops in the same ticks give the same state bit for bit, in whatever order the drops come.
 * Thread-safety: as virga/vulkan.h says.
 */
#ifndef VIRGA_GROUND_H
#define VIRGA_GROUND_H

#include <virga/contact.h>
#include <virga/material.h>
#include <virga/mesh.h>
#include <virga/shared/ground_cell.h>
#include <virga/shared/ground_limits.h>
#include <virga/shared/handed_droplet.h>
#include <virga/shared/impact.h>
#include <virga/shared/landing.h>
#include <virga/shared/particle.h>
#include <virga/shared/spawn.h>
#include <virga/shared/splash_rule.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_ground virga_ground; /* opaque */

typedef struct virga_ground_def {
    uint32_t size, cookie;

    /* Seed of everything random: fractions of spots and of infiltration. Default 1. */
    uint32_t seed;

    /* [128; 4096] cells along a side of the window, a power of two. About 64 bytes of device memory per cell. Default
     * 1024: 51 m with cells of 5 cm. */
    uint32_t cells;

    /* [0.01; 0.1] side of a cell (m). Default 0.05. */
    float cell_m;

    /* [0; 60000] tiles that are cached when they leave the window, 64 KiB each. Raised to twice the number of tiles in
     * the window, so that a camera cut and a cut back lose nothing. Default 1024. */
    uint32_t cached_tiles;

    /* [0; 2048] cells along a side of the far map; one of its cells is 8 x cell_m wide. Raised to twice the side of the
     * window, else rounded down to a multiple of 64. 32 bytes of device memory per cell. All meshes are drawn into it
     * twice, each time the camera has moved by 32 to 64 of its cells. 0: no far map, and cells that come into the
     * window know no cover. Default 512: 205 m with cells of 5 cm. */
    uint32_t far_cells;

    /* [64; 4096] texels along a side of the ripple map around the camera. Default 1024. */
    uint32_t ripple_texels;

    /* [0.002; 0.05] side of such a texel (m). Waves shorter than about three texels are smoothed away. Default
     * 0.005. */
    float ripple_texel_m;

    /* [1/1000; 1/20] the same as the rain's (s). Default 1/60. */
    double tick_s;

    /* [1; 60] ticks in which water flows once through all four sides of each cell, sinks and dries; a quarter of that
     * is done at a time. Default 4: one pass per tick. More is cheaper, but then the faster sheets of water (5 mm on a
     * slope of 1 %) are slower than Manning's speed. */
    uint32_t flow_ticks;

    /* [256; 4194240] the same as the rain's. Default 65536. */
    uint32_t max_impacts;

    /* [0; 1048576] drops of one step that may splash, 76 bytes each. Default 65536. */
    uint32_t max_spawns;

    /* [0; 4194240] droplets of splashes that may fall back in one step (step_info.returns). Default 131072. */
    uint32_t max_returned_droplets;

    /* [1; 64] the same as the rain's. Default 16. */
    uint32_t max_ticks_per_step;

    /* Vertex strides of meshes, see virga_rain_def. Default 12, 32, 0, 0. */
    uint32_t occluder_strides[4];
} virga_ground_def;

VIRGA_API virga_ground_def virga_default_ground_def(void);

/* What a material does with water. */
typedef struct virga_ground_material {
    float capacity_mm;       /* [0; 100] water that its pores hold when it is saturated */
    float retention_mm;      /* [0; 50] depth that its roughness holds back when the rest runs off */
    float infiltration_mm_h; /* [0; 10000] speed at which water sinks out of a wet cell */
    float drying;            /* [0; 10] factor of the settings' evaporation */
    float manning_n;         /* [0.005; 1] roughness to flow, s m^(-1/3) */
    float bump_height_mm;    /* [0; 50] standard deviation of its unevenness: decides where puddles gather */
    float bump_width_m;      /* [0.2; 50] width of a bump */
    bool drain;              /* removes all water that reaches it */
} virga_ground_material;

typedef struct virga_ground_settings {
    uint32_t size, cookie;

    /* By the number in virga_occluder.material. Numbers above 31 count as 31. The heights of bumps are applied when a
     * tile comes into the window; all else is live. */
    virga_ground_material materials[VIRGA_GROUND_MATERIALS];

    /* [0; 100] evaporation from a free surface: 0.1 in rain, 0.5 on a mild day, 5 in sun and wind. Default 0.2. */
    float evaporation_mm_h;

    /* [0; 1] how full the pores were when the ground was created, as a share of their capacity. Holds for the cells
     * that exist then; cells that come into the window later start as such ground would be by now. A new value of this
     * or of start_water_mm counts from then on, for what comes later. Default 0. */
    float start_wetness;

    /* [0; 50] depth of rain (mm) that had gathered in the hollows when the ground was created. Above 0, all pores were
     * full, and humps held half of what roughness holds back. Default 0: dry. */
    float start_water_mm;

    /* [0; 64] droplets at most that a wheel throws out of a cell in a tick. A foot throws once in a step: up to four
     * times as many, but at most 64. Each stands for many of its size. 0: none fly, all water is pushed aside, and feet
     * throw no sheets. Costs what droplets cost (virga/splash.h): the four wheels of a car throw a hundred times that
     * number in a tick at 60 km/h, and each is in the air for half a second. Default 12. */
    uint32_t contact_droplets;

    /* [0; 4] how high the waves are that running water has in the ripple map: those over the stones of its bed and over
     * its own turbulence, by its depth and speed. 1: as they are. 0: none, and no cost. Costs a pass over the cells of
     * the ripple map's area, and a draw of those that have such waves, by how many lengths of waves they have: half to
     * all of what the rings of heavy rain cost, where a whole road runs. Default 1. */
    float stream_waves;

    /* [0; 4] how high the waves are that wheels and feet (virga/contact.h) make on puddles, in the ripple map. 1: as
     * they are, by the water that they push out of its place. 0: none are drawn. Costs nothing where no wheel and no
     * foot was for two seconds. On a core of software Vulkan, with a map of 1024 texels of 5 mm: 0.4 ms for a step into
     * a puddle, 39 ms for four wheels that went through 5 m of one, as much as the rings of heavy rain. Default 1. */
    float wake_waves;

    /* Sums the water of all cells in each step, for the statistics. Costs one pass over all cells. Default true. */
    bool measure;
} virga_ground_settings;

/* Settings for dry ground in the open: the first drops soak in, and dry ground makes no splashes. For puddles and
 * splashes from the first second on, set start_wetness and start_water_mm. Materials are those of virga/material.h;
 * their sources are in engine/ground/materials.c. */
VIRGA_API virga_ground_settings virga_default_ground_settings(void);

/* Allocates, and builds pipelines when virga_context_def.pipeline_build_mode says so. VIRGA_DEGRADED: pools (cells,
 * cached_tiles, ripple_texels) were made smaller to fit the context's memory_budget; the log says how small. Errors as
 * virga_context_create; *ground is NULL then. */
VIRGA_API virga_result virga_ground_create(virga_context *context, const virga_ground_def *def, virga_ground **ground);

/* Destroys it and sets *ground to NULL. Accepts NULL. Frames in flight may still use it: their resources are freed when
 * they have completed. */
VIRGA_API void virga_ground_destroy(virga_ground **ground);

/* Returns VIRGA_OK if its pipelines for stepping are built, VIRGA_NOT_READY if some are missing, or the error of one
 * that could not be built. See virga_pipelines_build. Without VIRGA_PIPELINES_DEFERRED or _AS_JOBS it is always
 * VIRGA_OK. Costs nothing. */
VIRGA_API virga_result virga_ground_ready(const virga_ground *ground);

/* Applies new settings at once. Out of range: clamped, logged, VIRGA_DEGRADED. NaN, infinity or a wrong cookie:
 * VIRGA_ERROR_INVALID, and nothing changes. */
VIRGA_API virga_result virga_ground_set(virga_ground *ground, const virga_ground_settings *settings);

/* Reads the current settings. Does nothing for NULL. */
VIRGA_API void virga_ground_get(const virga_ground *ground, virga_ground_settings *settings);

/* Returns the device memory in bytes that virga_ground_create will allocate. */
VIRGA_API VkDeviceSize virga_ground_estimate(const virga_ground_def *def);

/* A picture of materials, which overrides those of the meshes. */
typedef struct virga_ground_material_map {
    /* 2D, any format with one unsigned integer (R8_UINT). A texel is a material number. A number that is not below
     * VIRGA_GROUND_MATERIALS leaves the material of the mesh. Read by compute shaders, in the layout of `before`. view
     * VK_NULL_HANDLE (default): no map. */
    virga_image image;

    /* Corners (x, z) of the area in the world that it covers. The first texel lies at low_m; rows run along x. Outside
     * of it the meshes decide. If high_m is not above low_m, there is no map. */
    double low_m[2], high_m[2];
} virga_ground_material_map;

/* Water that stands in cells becomes particles of a simulation, and comes back from it. */
typedef struct virga_ground_exchange {
    /* As virga_fluid_exchange_get returns them: a virga_exchange_gpu and its two lists, ready to be read by compute
     * shaders and as indirect arguments. VK_NULL_HANDLE: no water is exchanged. */
    VkBuffer buffer;

    /* A multiple of the device's minStorageBufferOffsetAlignment and of 4. */
    VkDeviceSize offset;

    /* Bytes from there. 0: all of the buffer. */
    VkDeviceSize size;

    /* [-1e9; 1e9] position in the world (m) that the particles' positions are relative to. */
    double origin_m[3];

    /* [-1e9; 1e9] corners (x, z) of the region in the world (m) whose water is simulated. Cells that are wholly in it
     * give their water, as many whole particles as they have; a remainder and a film of 0.05 mm (or what a rough
     * material hides) stay in the cell, and so does all that the simulation has no room for. In cells no water flows
     * over its border. If high_m is not above low_m, no cell gives water; what comes back lands anyway. */
    double low_m[2], high_m[2];
} virga_ground_exchange;

/* Arguments of one step. */
typedef struct virga_ground_step_info {
    /* Middle of the window, which follows it in whole tiles. Ground is found within 256 m above and below the camera's
     * height at the first step. */
    double camera_m[3];

    /* Middle of the ripple map: a point on the ground some metres ahead of the camera, where ripples are visible. The
     * best use of its texels: let the map begin where the lower edge of the picture meets the ground. */
    double ripple_center_m[3];

    /* All meshes of the host. Where the window moves, those with `ground` are drawn into its height map. Where the far
     * map moves, all that stand still are drawn into its own, for what they keep dry. */
    const virga_occluder *meshes;
    uint32_t mesh_count;

    /* (optional) It is read where the window moves, see virga_ground_refresh_heights. */
    virga_ground_material_map materials;

    /* As virga_rain_impacts returns them: a virga_impacts_gpu and the impacts after it, in a buffer with the usages
     * STORAGE and INDIRECT. */
    VkBuffer impacts;

    /* A multiple of the device's minStorageBufferOffsetAlignment and of 4. */
    VkDeviceSize impacts_offset;

    /* Bytes from there: the head, and the entries that fit. 0: all of the buffer, which must then not be larger than
     * the device's maxStorageBufferRange. */
    VkDeviceSize impacts_size;

    /* Ticks that the impacts belong to, see virga_rain_ticks. They must follow those of earlier steps, else the step is
     * refused (VIRGA_LOG_FRAME_ORDER). */
    uint32_t first_tick, ticks;

    /* (optional) A uniform buffer with a virga_splash_rules_gpu: which drops splash. NULL: none do. */
    VkBuffer splash_rules;

    /* A multiple of the device's minUniformBufferOffsetAlignment. */
    VkDeviceSize splash_rules_offset;

    /* (optional) Droplets of splashes that fell back: laid out as impacts, with is_return set. Their water lands in the
     * first tick of the step. Give each of them to exactly one step, and that step must have ticks. */
    VkBuffer returned_droplets;

    /* As those of the impacts. */
    VkDeviceSize returned_droplets_offset, returned_droplets_size;

    /* [0; 1000] rain that falls on level open ground during the step. For ground on which no impacts are counted: cells
     * that come into the window, and the far map. See virga_rain_rainfall_get. 0: such ground stays as it started, and
     * dries. */
    float open_rain_mm_h;

    /* [0; 0.01] mean diameter of its drops, by surface (m): sets the size of their spots, and how much they stir
     * puddles. 0: neither spots nor stirring. */
    float open_drop_m;

    /* (optional) Distance from the camera up to which impacts land (m). Cells of the window beyond it get no rain, see
     * virga_ground_maps.reach_m. 0: impacts land in the whole window. */
    float impacts_reach_m;

    /* (optional) Particles of simulated water, as virga_water_step takes them: `water_count` virga_particle_gpu from
     * `water_offset` on, a multiple of the device's minStorageBufferOffsetAlignment; ready to be read by compute
     * shaders. Ground that is nearer below them than `water_spacing_m` ([0; 10], their distance at rest) becomes wet:
     * its pores are filled, and it gets a film of 0.05 mm. A particle wets its own cell, and the cells whose middle is
     * in a square of that side around it, up to 16 along each axis. The simulation does not miss this water; it is
     * counted in virga_ground_stats.touched_nl. VK_NULL_HANDLE: there is none. Costs a pass over the particles. */
    VkBuffer water;
    VkDeviceSize water_offset;
    uint32_t water_count;
    float water_spacing_m;

    /* [-1e9; 1e9] position in the world (m) that their positions are relative to. */
    double water_origin_m[3];

    /* (optional) Water that goes into a simulation and comes back. Costs a pass over the cells of the region in one
     * workgroup (about 0.1 ms for 10,000 cells on software Vulkan), and two over the particles that come back. */
    virga_ground_exchange exchange;

    /* (optional) What rolls and walks over the ground, see virga/contact.h: where it is at the end of the step's last
     * tick. At most VIRGA_GROUND_MAX_CONTACTS together. Costs two passes over the cells near them in each tick, the
     * first in one workgroup. */
    const virga_wheel *wheels;
    uint32_t wheel_count;
    const virga_foot *feet;
    uint32_t foot_count;

    /* (optional) Where they throw droplets, behind those that are there: a virga_handed_droplets_gpu and the droplets
     * after it, as virga_splash_handed returns it; a storage buffer, ready to be read and written by compute shaders.
     * What finds no room there stays in its cell. NULL: nothing flies. */
    VkBuffer handed;

    /* A multiple of the device's minStorageBufferOffsetAlignment and of 4; bytes from there, 0: all of the buffer. */
    VkDeviceSize handed_offset, handed_size;

    /* As virga_splash_step_info has them. */
    double handed_origin_m[3];
    float handed_late_s;

    /* No picture is drawn before the next step, as in a pre-roll. The map of ripples, which only pictures read, may
     * then stay as it was; all else is done, and later steps give the same. Saves its draw. Default false. */
    bool is_unseen;
} virga_ground_step_info;

/* Lets the impacts land, runs the ticks, then writes the maps. Outside rendering. Impacts must be ready to be read by
 * compute shaders, as virga_rain_step leaves them. Maps and landings are then ready for compute, vertex and fragment
 * shaders. */
VIRGA_API virga_result virga_ground_step(virga_ground *ground, VkCommandBuffer cmd, const virga_ground_step_info *info);

/* Draws the height map of the whole window again in the next step. Call it after meshes have changed. Water stays. */
VIRGA_API void virga_ground_refresh_heights(virga_ground *ground);

/* What materials read.
 *
 * `wetness` and `spots` have cells x cells texels (`spots` is twice as wide), and wrap around: the texel of a position
 * is the number of its cell, floor(x / cell_m), modulo `cells`. They stay in VK_IMAGE_LAYOUT_GENERAL. The views are the
 * same for the whole life of the ground, so bind them once. Where they lie (low_m, ripple_low_m, far_low_m) changes
 * every frame. `wetness`, `spots` and `far_wetness` are fetched by texel, so any sampler will do; `ripples` may be
 * filtered. All zero for NULL. */
typedef struct virga_ground_maps {
    /* R16G16B16A16_SFLOAT. r: wetness [0; 1]. g: depth of water (mm). b: slope variance of ripples. a: height of the
     * ground above base_m (m).
     * Water that is hidden between blades of grass and clods of earth has no depth here: all that a material holds
     * back, if that is 1 mm or more; none of it, if that is 0.35 mm or less. */
    VkImageView wetness;

    /* R32_UINT: two texels per cell, 8 x 8 bits of dark spots, row by row. */
    VkImageView spots;

    /* R16G16_SFLOAT: slope of the water surface in x and z at the newest tick, of the rings of drops and of water that
     * runs. It goes on under dry ground, so use it only where the depth is not zero. Does not wrap. It has about four
     * fifths of the slope variance in `wetness`, so add a fifth of that to the roughness where the map is used, and all
     * of it elsewhere. */
    VkImageView ripples;
    uint32_t ripple_texels;
    float ripple_texel_m;

    /* Low corner of the ripple map in x and z. */
    double ripple_low_m[2];

    uint32_t cells;
    float cell_m;

    /* Height in the world: the camera's at the first step, in whole metres (as far as a float can hold them). */
    float base_m;

    /* Corners of the window in x and z. There are no cells outside. */
    double low_m[2], high_m[2];

    /* Distance from the step's camera, in x and in z, within which the window has cells and gets impacts. Blend into
     * the far map before it. 0: there is none (def.cells 128), and nothing to blend. */
    float reach_m;

    /* R16G16B16A16_SFLOAT, as `wetness`, but b holds minus the share of dark spots where there is no water. Texel (0,
     * 0) lies at far_low_m; it does not wrap. One more row, y = far_cells, has VIRGA_GROUND_MATERIALS texels: level
     * open ground by material, for what lies beyond. */
    VkImageView far_wetness;

    /* Along its side. 0: there is only that one row, y = 0. */
    uint32_t far_cells;
    float far_cell_m;

    /* Its low corner in x and z. */
    double far_low_m[2];
} virga_ground_maps;

VIRGA_API void virga_ground_maps_get(const virga_ground *ground, virga_ground_maps *maps);

/* ---- wet ground for hosts without materials that know water --------------------------------------------------- */

/* What virga_ground_draw_wet makes of water. Fill with virga_default_ground_wet. What is out of range is refused. */
typedef struct virga_ground_wet {
    uint32_t size, cookie;

    /* [0; 4] how much of all that is drawn. 0: nothing. 2: as much as two layers of wet ground over each other.
     * Default 1. */
    float strength;

    /* [0; 1] part of its light that soaked ground loses. Asphalt, soil and rough wood lose about half, smooth stone a
     * fifth. Default 0.5. */
    float darkening;

    /* [1; 1000] how far things may be from the water that mirrors them (m). Default 60. */
    float mirror_reach_m;

    /* [0; VIRGA_GROUND_MATERIALS - 1] material of the ground beyond the far map. Default VIRGA_MATERIAL_ASPHALT. */
    uint32_t far_material;

    /* What water mirrors where the picture does not show it, as virga_lighting.environment_sh. Default that of
     * virga_default_lighting. */
    float environment_sh[9][3];
} virga_ground_wet;

VIRGA_API virga_ground_wet virga_default_ground_wet(void);

/* Builds the pipeline of virga_ground_draw_wet for a target. virga_scene_attach does not. Errors as
 * virga_target_create. Another call with the same target does nothing. */
VIRGA_API virga_result virga_ground_attach(virga_ground *ground, const virga_target *target);

/* Darkens and mirrors what the host has drawn, where the ground is wet: for renderers whose materials do not read the
 * maps. Inside rendering, after the opaque scene and before all other water, in any frame after the first step; up to 8
 * times in a frame.
 *
 * It needs view->depth and view->color, and knows nothing else of the scene: position and normal come from the depth.
 * Ground that is steeper than 70 degrees stays dry. What is mirrored is looked up along a ray through the picture.
 * Where the picture ends the mirror fades into environment_sh; where something hides the end of the ray, it shows what
 * is seen in that direction. The color that is sampled is the one to which the draw adds: give a copy of the picture as
 * it is then, as an image that is attached can not be sampled. On a target whose values are encoded the result is exact
 * over that picture (virga_target_def.encoding).
 *
 * VIRGA_NOT_READY: the target is not attached, or the ground was never stepped. VIRGA_ERROR_INVALID: a wrong view or
 * `wet`, or no depth or color. Costs one pass over the viewport: for wet pixels about 70 samples, a tenth of that for
 * others. */
VIRGA_API virga_result virga_ground_draw_wet(virga_ground *ground, VkCommandBuffer cmd, const virga_view *view,
                                             const virga_ground_wet *wet, const virga_target *target);

/* The cells themselves (virga/shared/ground_cell.h), for display and checks. Each buffer has one entry for each cell of
 * the window, tile by tile. The cell (x, z), counted from the origin of the world, lies at
 *     ((z / 64 mod tiles) x tiles + (x / 64 mod tiles)) x 4096 + (z mod 64) x 64 + x mod 64
 * Divisions and remainders are rounded down, also for negative numbers. */
typedef struct virga_ground_cells {
    VkBuffer floors;     /* virga_floor_gpu: material and height */
    VkBuffer cells;      /* virga_cell_gpu: water. May be another buffer after each step */
    VkDeviceSize size;   /* bytes of each of the two, from its start */
    uint32_t tiles;      /* of 64 x 64 cells along a side of the window, a power of two */
    int32_t low_tile[2]; /* first tile of the window in x and z */
    uint32_t nl_per_um;  /* nanolitres that make a micrometre of depth on a cell */
    float base_m;        /* height in the world of height 0 of floors, as in virga_ground_maps */
} virga_ground_cells;

/* Reads where the cells of the newest step are; all zero for NULL. Compute shaders have written them, and may read them
 * after virga_ground_step. For readers in other stages the host records a barrier, from the stage of compute shaders
 * and their writes. The host must not write them. Costs nothing. Thread-safety: as the ground. */
VIRGA_API void virga_ground_cells_get(const virga_ground *ground, virga_ground_cells *cells);

/* Reads what the impacts of the newest step met: a virga_landing_gpu per impact, by its index. `size` in bytes. */
VIRGA_API void virga_ground_landings(const virga_ground *ground, VkBuffer *buffer, VkDeviceSize *size);

/* Reads the splashes of the newest step: a virga_spawns_gpu, then def.max_spawns x virga_spawn_gpu. Ready to be read by
 * compute shaders and as indirect arguments. `size` in bytes. */
VIRGA_API void virga_ground_spawns(const virga_ground *ground, VkBuffer *buffer, VkDeviceSize *size);

/* The newest statistics of completed frames. Water is in nanolitres, since creation or, in the last group, now. While
 * `measure` is on, and as long as rain drops no impact for lack of room:
 *     start + landed + touched + given - taken - thrown =
 *         film + puddles + held + cached + infiltrated + run_off + evaporated + evicted */
typedef struct virga_ground_stats {
    /* 0: none yet. */
    uint64_t frame_index;

    /* Water that cells had when they first came into the window. */
    uint64_t start_nl;

    /* Landed on cells; and landed elsewhere: on what is not ground, or outside the window. Without water that flew up
     * in a splash and has not fallen back. */
    uint64_t landed_nl, off_ground_nl;

    /* Flown up in splashes, and fallen back. The difference is in the air. */
    uint64_t flown_nl, returned_nl;

    /* Spray of simulated water, of wheels and of feet that fell on cells, and that fell elsewhere: parts of landed_nl
     * and off_ground_nl. */
    uint64_t spray_nl, spray_off_ground_nl;

    /* Taken from simulated water that touched it. The simulation keeps its volume. */
    uint64_t touched_nl;

    /* Became particles of a simulation, and came back from it: to cells, and where there is no ground (or a cell is
     * full). What is neither is in the simulation, or in a list between the two (virga/shared/exchange.h). */
    uint64_t taken_nl, given_nl, given_off_ground_nl;

    /* Thrown out of cells by wheels and feet. It comes back as spray. */
    uint64_t thrown_nl;

    /* Gone: sunk in, run into drains, evaporated, dropped with tiles. */
    uint64_t infiltrated_nl, run_off_nl, evaporated_nl, evicted_nl;

    /* Now: on wet and dry cells, in puddles, in pores, and all water of cached tiles. */
    uint64_t film_nl, puddles_nl, held_nl, cached_nl;

    /* Cells now, by state (VIRGA_GROUND_NONE to VIRGA_GROUND_PUDDLE_10). */
    uint32_t cells[VIRGA_GROUND_STATES];

    /* Tiles outside the window that are cached now. */
    uint32_t tiles_cached;
} virga_ground_stats;

VIRGA_API void virga_ground_stats_get(virga_ground *ground, virga_ground_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
