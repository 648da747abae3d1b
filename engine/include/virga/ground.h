/* virga/ground.h - ground that gets wet: cells with a material, a height and counted water.
 *
 * What rain drops on the meshes that are marked as ground (virga_occluder.ground) is followed by cells of some
 * centimetres: the first drops leave dark spots, pores fill up, a film forms, flows to where it is lower and gathers in
 * puddles; it sinks, runs into drains and dries. The model of drops is Mizukami et al., "Rendering of water splash",
 * section 4.6; what happens between drops (flow, infiltration, evaporation) is added here. Water is counted in whole
 * nanolitres: what landed is on the ground, in it, run off or evaporated, to the last one.
 *
 * The cells are a square window around the camera. Where it moves, tiles of 64 x 64 cells that leave it are kept with
 * their water until def.kept_tiles are; then those that left longest ago are forgotten, and their water is counted as
 * that. A place has one cell: of surfaces above one another the highest that is ground.
 *
 * Beyond the window there is a wider map without water of its own (def.far_cells). It and cells that come into the
 * window for the first time show what has stood in the rain for as long as the ground is there, in the open or under
 * cover: the host tells in each step how much rain that is (step_info.open_rain_mm_h). Blend from one map to the other,
 * and the road is wet as far as it is seen.
 *
 * A frame: after virga_rain_step, and outside rendering,
 *
 *     virga_ground_step(ground, cmd, &info);
 *
 * then the host samples the maps (virga_ground_maps_get) in its own materials; virga/shared/ground_map.glsl shows how.
 *
 * Deterministic: the same drops in the same ticks give the same state bit for bit, whatever order they come in.
 * Thread-safety: as virga/vulkan.h says.
 */
#ifndef VIRGA_GROUND_H
#define VIRGA_GROUND_H

#include <virga/material.h>
#include <virga/mesh.h>
#include <virga/shared/ground_cell.h>
#include <virga/shared/ground_limits.h>
#include <virga/shared/impact.h>
#include <virga/shared/landing.h>
#include <virga/shared/spawn.h>
#include <virga/shared/splash_rule.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_ground virga_ground; /* opaque */

typedef struct virga_ground_def {
    uint32_t size, cookie;
    uint32_t seed;          /* of what is left to chance: fractions of spots, of infiltration. Default 1 */
    uint32_t cells;         /* [128; 4096] along the window's side, a power of two. About 64 bytes of device memory a
                          * cell. Default 1024: 51 m at 5 cm */
    float cell_m;           /* [0.01; 0.1] side of a cell. Default 0.05 */
    uint32_t kept_tiles;    /* [0; 60000] tiles kept when they leave the window, 64 KiB each; raised to twice the
                          * tiles of the window, so that a cut of the camera and back loses nothing. Default 1024 */
    uint32_t far_cells;     /* [0; 2048] along the side of the map of ground beyond the window, in cells of 8 x cell_m;
                             * raised to twice the window's side, else rounded down to whole 64. 32 bytes of device
                             * memory each; all meshes are drawn into it twice whenever the camera has gone 32 to 64 of
                             * its cells. 0: there is none, and no cover for cells that come into the window. Default
                             * 512: 205 m at cells of 5 cm */
    uint32_t ripple_texels; /* [64; 4096] along the side of the map of ripples around the camera. Default 1024 */
    float ripple_texel_m;   /* [0.002; 0.05] its texel; shorter waves than about three texels are smoothed away. Default
                             * 0.005 */
    double tick_s;          /* [1/1000; 1/20] the same as rain's. Default 1/60 */
    uint32_t flow_ticks;    /* [1; 60] in so many ticks water flows through all sides of each cell, sinks and dries, a
                             * quarter of that at a time. Default 4: one pass a tick. More is cheaper, but the faster
                             * sheets (5 mm on a slope of 1 %) then lag behind Manning's speed */
    uint32_t max_impacts;   /* [256; 4194240] the same as rain's. Default 65536 */
    uint32_t max_spawns;    /* [0; 1048576] drops of one step that may splash, 76 bytes each. Default 65536 */
    uint32_t max_returns;   /* [0; 4194240] entries of the returns that a step may be given. Default 131072 */
    uint32_t max_ticks_per_step;  /* [1; 64] the same as rain's. Default 16 */
    uint32_t occluder_strides[4]; /* vertex strides of meshes, see virga_rain_def. Default 12, 32, 0, 0 */
} virga_ground_def;

VIRGA_API virga_ground_def virga_default_ground_def(void);

/* What a material does with water. */
typedef struct virga_ground_material {
    float capacity_mm;       /* [0; 100] water that its pores take before it is saturated */
    float retention_mm;      /* [0; 50] depth that its roughness holds back when the rest runs off */
    float infiltration_mm_h; /* [0; 10000] speed at which water sinks out of a wet cell */
    float drying;            /* [0; 10] times the settings' evaporation */
    float manning_n;         /* [0.005; 1] s m^(-1/3), roughness to flow */
    float bumps_mm;          /* [0; 50] standard deviation of its unevenness: decides where puddles gather */
    float bump_m;            /* [0.2; 50] width of its bumps */
    bool drain;              /* takes away all water that comes to it */
} virga_ground_material;

typedef struct virga_ground_settings {
    uint32_t size, cookie;
    virga_ground_material materials[VIRGA_GROUND_MATERIALS]; /* by the number in virga_occluder.material (31 at most;
                              * higher numbers count as 31). Heights of bumps are taken when a tile comes into the
                              * window; the rest is live */
    float evaporation_mm_h; /* [0; 100] from a free surface. 0.1 in rain, 0.5 on a mild day, 5 in sun and wind.
                              * Default 0.2 */
    float start_wetness;    /* [0; 1] share of their capacity that pores held when the ground was made: of the cells
                             * that are there then, and of what comes into the window later as it would be by now.
                             * Other values of this or the next set anew what comes from then on. Default 0 */
    float start_water_mm;   /* [0; 50] rain of that depth had gathered in the hollows of their bumps, all pores were
                             * full and half of what roughness holds back was on the humps. Default 0: dry */
    bool measure;           /* sums the water of all cells in each step, for the statistics: one pass over all cells.
                              * Default true */
} virga_ground_settings;

/* Settings in the open, dry: the first drops soak in, and dry ground makes no splashes. Who wants puddles and splashes
 * from the first second on sets start_wetness and start_water_mm. Materials are those of virga/material.h; their
 * sources: engine/ground/materials.c. */
VIRGA_API virga_ground_settings virga_default_ground_settings(void);

/* Allocates, and builds pipelines when virga_context_def.pipelines says. VIRGA_DEGRADED: made with smaller pools
 * (cells, kept_tiles, ripple_texels) to fit the context's memory_budget; the log says how small. Errors as
 * virga_context_create; *ground is NULL then. */
VIRGA_API virga_result virga_ground_create(virga_context *context, const virga_ground_def *def, virga_ground **ground);

/* Destroys it and sets *ground to NULL; accepts NULL. Frames in flight may still use it: what they need goes when they
 * have completed. */
VIRGA_API void virga_ground_destroy(virga_ground **ground);

/* Whether its pipelines for stepping and preparing are there, see virga_pipelines_build: VIRGA_OK, VIRGA_NOT_READY, or
 * why one could not be built. Without VIRGA_PIPELINES_IN_STEPS or _AS_JOBS always VIRGA_OK. Costs nothing. */
VIRGA_API virga_result virga_ground_ready(const virga_ground *ground);

/* Takes new settings at once. Out of range: clamped, logged, VIRGA_DEGRADED. NaN, infinite or wrong cookie:
 * VIRGA_ERROR_INVALID and nothing changes. */
VIRGA_API virga_result virga_ground_set(virga_ground *ground, const virga_ground_settings *settings);

/* The settings in force. Nothing for NULL. */
VIRGA_API void virga_ground_get(const virga_ground *ground, virga_ground_settings *settings);

/* Device memory in bytes that virga_ground_create will take. */
VIRGA_API VkDeviceSize virga_ground_estimate(const virga_ground_def *def);

/* Materials from a picture, over those of meshes. */
typedef struct virga_ground_material_map {
    virga_image image; /* 2D, any format of one unsigned integer (R8_UINT): a material a texel, below
                        * VIRGA_GROUND_MATERIALS; above: the mesh's own. Read in the stages of compute, in the layout of
                        * `before`. view VK_NULL_HANDLE: no map, the default */
    double low_m[2], high_m[2]; /* corners in x and z of the place that it covers in the world: its first texel lies at
                                 * low_m, its rows go along x. Outside of it meshes decide; high_m not above low_m: no
                                 * map */
} virga_ground_material_map;

/* One step. */
typedef struct virga_ground_step_info {
    double camera_m[3];           /* middle of the window, which follows in whole tiles. Ground is found within 256 m
                                   * of its height at the first step, up and down */
    double focus_m[3];            /* middle of the map of ripples: on the ground some metres ahead of the camera, where
                                   * they can be seen */
    const virga_occluder *meshes; /* all of the host's; those with `ground` are surveyed where the window moves, and all
                                   * that stand still where the far map does, for what they keep dry */
    uint32_t mesh_count;
    virga_ground_material_map materials; /* (optional) looked at where the window moves, see virga_ground_survey */
    VkBuffer impacts; /* as virga_rain_impacts tells: virga_impacts_gpu and what follows */
    VkDeviceSize impacts_offset; /* a multiple of the device's minStorageBufferOffsetAlignment and of 4 */
    VkDeviceSize impacts_size;   /* bytes from there: the head and the entries that there is room for. 0: all of the
                                  * buffer, which then must not be larger than the device's maxStorageBufferRange */
    uint32_t first_tick, ticks; /* that the impacts are of, see virga_rain_ticks. Ticks that do not come after those
                                 * of the steps before are refused (VIRGA_LOG_FRAME_ORDER) */
    VkBuffer splash_rules; /* (optional) a virga_splash_rules_gpu in a uniform buffer: drops splash by it. NULL: none
                            * do */
    VkDeviceSize splash_rules_offset; /* a multiple of the device's minUniformBufferOffsetAlignment */
    VkBuffer returns; /* (optional) water that splashes gave back: laid out as impacts, with is_return. It lands in the
                       * first tick of the step; give each return to one step with ticks only */
    VkDeviceSize returns_offset, returns_size; /* as of the impacts */
    float open_rain_mm_h; /* [0; 1000] rain that lands on level open ground during the step, for ground that no impacts
                           * are counted on: what comes into the window, and the far map. See virga_rain_fall_get. 0:
                           * it stays as at the start, and dries */
    float open_drop_m;    /* [0; 0.01] the mean diameter of its drops, by surface: their spots and how much they stir
                           * puddles. 0: neither */
    float impacts_reach_m; /* (optional) as far from the camera impacts land; what lies farther in the window is not
                            * rained on, see virga_ground_maps.reach_m. 0: all over the window */
} virga_ground_step_info;

/* Takes in the impacts and runs the ticks, then writes the maps. Outside rendering. Impacts must be ready to be read
 * by compute (virga_rain_step leaves them so); maps and landings are left ready for compute, vertex and fragment
 * shaders. */
VIRGA_API virga_result virga_ground_step(virga_ground *ground, VkCommandBuffer cmd, const virga_ground_step_info *info);

/* Surveys all of the window anew in the next step: after meshes were changed. Water stays. */
VIRGA_API void virga_ground_survey(virga_ground *ground);

/* What materials read. Wet and spots are cells x cells (spots: twice as wide), and wrap around: the texel of a place is
 * its cell's number, floor(x / cell_m), modulo cells. They stay in VK_IMAGE_LAYOUT_GENERAL, and the same as long as the
 * ground lives: bind them once. Where they lie (low_m, ripple_low_m) changes every frame. `wet`, `spots` and `far_wet`
 * are fetched by texel, so any sampler will do; ripples may be filtered. All zero for NULL. */
typedef struct virga_ground_maps {
    VkImageView wet;     /* R16G16B16A16_SFLOAT: r wetness [0; 1], g depth of water (mm), b slope variance of
                        * ripples, a height of the floor above base_m (m). Water that is hidden between blades of grass
                        * and clods has no depth here: what materials hold back, where that is 1 mm and more (none of it
                        * up to 0.35 mm) */
    VkImageView spots;   /* R32_UINT: two texels a cell, 8 x 8 bits of dark spots, row by row */
    VkImageView ripples; /* R16G16_SFLOAT: slope of the water's surface in x and z at the newest tick, where there is
                          * water (it goes on under what is dry: use it where the depth is not zero). Does not wrap */
    uint32_t ripple_texels;
    float ripple_texel_m;
    double ripple_low_m[2]; /* its low corner in x and z */
    uint32_t cells;
    float cell_m;
    float base_m;       /* height in the world: the camera's at the first step, in whole metres (as far as a float has
                         * them) */
    double low_m[2], high_m[2]; /* corners of the window in x and z; outside there is nothing */
    float reach_m;      /* as far from the step's camera, in x and in z, there is window all around and impacts land:
                         * blend into the far map before that. 0: nowhere (def.cells 128), and nothing to blend in */
    VkImageView far_wet; /* R16G16B16A16_SFLOAT, like `wet` but for b: where no water lies it is minus the share of dark
                         * spots. Texel (0, 0) lies at far_low_m; it does not wrap. A row of VIRGA_GROUND_MATERIALS
                         * texels more, y = far_cells, has level open ground by material, for what is beyond */
    uint32_t far_cells; /* along its side; 0: only that row, y = 0 */
    float far_cell_m;
    double far_low_m[2]; /* its low corner in x and z; changes every frame */
} virga_ground_maps;

VIRGA_API void virga_ground_maps_get(const virga_ground *ground, virga_ground_maps *maps);

/* The cells themselves (virga/shared/ground_cell.h), for whoever shows or checks them. Each buffer has an entry for
 * each cell of the window, tile by tile: the cell (x, z), counted from the world's origin, lies at
 *     ((z / 64 mod tiles) x tiles + (x / 64 mod tiles)) x 4096 + (z mod 64) x 64 + x mod 64
 * with divisions and remainders rounded down, also of negative numbers. */
typedef struct virga_ground_cells {
    VkBuffer floors;      /* virga_floor_gpu: material and height */
    VkBuffer cells;       /* virga_cell_gpu: water. May be another buffer after each step */
    VkDeviceSize size;    /* bytes of each, from its start */
    uint32_t tiles;       /* of 64 x 64 cells along the window's side, a power of two */
    int32_t low_tile[2];  /* in x and z: the window begins with it */
    uint32_t nl_per_um;   /* nanolitres that make a micrometre of depth on a cell */
    float base_m;         /* height in the world that those of floors count from, as in virga_ground_maps */
} virga_ground_cells;

/* Tells where the cells of the newest step are; all zero for NULL. virga_ground_step leaves them to compute shaders,
 * which wrote them: for readers in other stages the host records a barrier, from the stage of compute shaders and their
 * writes. Not to be written. Costs nothing. Thread-safety: as the ground. */
VIRGA_API void virga_ground_cells_get(const virga_ground *ground, virga_ground_cells *cells);

/* What the impacts of the newest step met: virga_landing_gpu by index of impact. */
VIRGA_API void virga_ground_landings(const virga_ground *ground, VkBuffer *buffer, VkDeviceSize *size);

/* The splashes of the newest step: a virga_spawns_gpu, then def.max_spawns x virga_spawn_gpu. Ready to be read by
 * compute and as indirect arguments. */
VIRGA_API void virga_ground_spawns(const virga_ground *ground, VkBuffer *buffer, VkDeviceSize *size);

/* Newest statistics of completed frames. Water in nanolitres since creation. While `measure` is on, and nothing is
 * dropped by rain for want of room:
 *     start + landed = film + puddles + held + kept + infiltrated + run_off + evaporated + forgotten */
typedef struct virga_ground_stats {
    uint64_t frame_index;             /* 0: none yet */
    uint64_t start_nl;                /* that cells came with when they were first in the window */
    uint64_t landed_nl, elsewhere_nl; /* on cells; on what is not ground, or outside of the window. Without what flew up
                                       * again and has not fallen back */
    uint64_t flown_nl, returned_nl;   /* up in splashes; fallen back: flown - returned is in the air */
    uint64_t infiltrated_nl, run_off_nl, evaporated_nl, forgotten_nl;
    uint64_t film_nl, puddles_nl, held_nl, kept_nl;
    uint32_t cells[VIRGA_GROUND_STATES]; /* by state */
    uint32_t tiles_kept;
} virga_ground_stats;

VIRGA_API void virga_ground_stats_get(virga_ground *ground, virga_ground_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
