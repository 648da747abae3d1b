/* virga/rain.h - falling rain: a field of drops, wind, occlusion, impacts, streaks and haze.
 *
 * Model. The field is a set of slots. A slot has a size and a place in a lattice that moves with the drops of its
 * size, so under a uniform wind the drops in a place at a time follow from seed, place and time alone; the camera
 * only chooses which part is looked at. Boxes around the camera, each twice as wide as the one before, hold equally
 * many slots: in the innermost a slot is one real drop (weight 1) where the budget allows, farther out it stands for
 * several (weight above 1), so that the water that falls is always the rate asked for. Boxes cross-fade.
 *
 * Order in a frame: occlusion (when something moved or the camera did), step, prepare, draw. All state is on the
 * device; statistics come back late. Thread-safety: as the context.
 */
#ifndef VIRGA_RAIN_H
#define VIRGA_RAIN_H

#include <virga/drops.h>
#include <virga/light.h>
#include <virga/shared/impact.h>
#include <virga/shared/point.h>
#include <virga/mesh.h>
#include <virga/shared/rain_limits.h>
#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_rain virga_rain; /* opaque */

/* ---- fixed at creation ---------------------------------------------------------------------------------------- */

typedef struct virga_rain_def {
    uint32_t size, cookie;
    uint32_t seed;         /* another seed, other drops with the same statistics. Default 1 */
    uint32_t max_drops;    /* [1024; 4194304] slots, rounded up to whole workgroups a box. Quality falls with it, the
                            * rate never. 32 bytes of device memory each, 40 more with wind_texture. Default 131072 */
    float range_m;         /* [4; 512] drops are drawn and land up to here from the camera, haze takes over beyond.
                            * Default 32 */
    uint32_t max_impacts;  /* [256; 4194240] impacts that one step can hold, 64 bytes each; more are counted and
                            * logged. Default 65536 */
    uint32_t max_streaks;  /* [256; 4194304] streaks that one prepare can hold, 108 bytes each. 0 means max_drops, the
                            * default */
    uint32_t max_ticks_per_step; /* [1; 64] a step that asks for more drops the rest of its time. Default 16 */
    double tick_s;         /* [1/1000; 1/20] the fixed tick. Default 1/60 */
    uint32_t occlusion_size; /* [64; 8192] texels along a side of an occlusion map; 0: no occlusion. Default 1024 */
    uint32_t occlusion_cascades; /* [1; 4] maps around each other, the widest covers the range. Default 2 */
    uint32_t occlusion_slants; /* [1; 4] maps for drops of different slant (small ones lie flatter in the wind).
                                * Memory: 8 bytes x size^2 x cascades x slants. Default 2 */
    uint32_t occluder_strides[4]; /* the vertex strides (bytes) that occluders will have: a pipeline each, as Vulkan 1.2
                            * fixes strides there. 0: unused. Default 12, 32, 0, 0 */
    uint32_t max_panes;    /* [0; 8] panes that virga_rain_hits may be asked for in a frame, 512 KiB each, and
                            * 4 bytes a slot for all. Default 0 */
    bool points;           /* room for virga_rain_points: 48 bytes a slot. Default false */
    bool wind_texture;     /* room to integrate drops in a host's 3D wind. Default false */
} virga_rain_def;

VIRGA_API virga_rain_def virga_default_rain_def(void);

/* ---- live settings -------------------------------------------------------------------------------------------- */

/* All may change at any time; what would pop eases in over transition_s. Fill with virga_default_rain_settings. */
typedef struct virga_rain_settings {
    uint32_t size, cookie;

    float rate_mm_h;       /* [0; 200] rain that lands on level ground. 0.5 drizzle, 2 light, 10 shower, 25 heavy,
                            * 50 storm, 150 cloudburst. Default 10 */
    virga_sizes sizes;     /* default Marshall-Palmer */
    float air_density;     /* [0.3; 2] kg/m^3; default 1.204. Lower at height: drops fall faster */
    float transition_s;    /* [0; 60] time in which rate and sizes ease into new values. Default 0.5 */

    float wind_m_s[3];     /* [-60; 60] mean wind; y is an updraught. Default 0 */
    float gust_m_s;        /* [0; 30] standard deviation of each horizontal wind component (the vertical: 0.4 of it).
                            * Default 0 */
    float gust_time_s;     /* [0.1; 600] time scale of gusts: knots of smooth noise are this far apart. Default 4 */
    const virga_image *wind_texture; /* (optional) a 3D image, any float RGBA format with linear filtering: xyz is
                            * velocity in m/s that is added to the wind. Needs def.wind_texture. Read in the stages of
                            * compute. The pointer is read in virga_rain_set; the image must live while it is set */
    double wind_min_m[3], wind_max_m[3]; /* box that the texture fills in the world; outside, its edge counts */

    virga_lighting lighting; /* what drops show; default virga_default_lighting */

    /* Look. All neutral values are physics. */
    float streak_gain;     /* [0; 100] multiplies coverage of streaks. 1 is physical: a 2 mm drop covers 1.5 % of what
                            * is behind its streak at 1/48 s, which the eye sees and a film often wants more of.
                            * Default 1 */
    float light_gain;      /* [0; 100] multiplies light from lighting.lights in drops. Default 1 */
    float min_width_px;    /* [0.5; 4] narrower streaks are drawn this wide with less coverage. Default 1 */
    float soft_m;          /* [0; 1] streaks fade over this depth where they meet geometry. Default 0.05 */
    float near_m;          /* [0; 5] drops nearer to the camera than this fade out. Default 0.15 */
    float oscillation;     /* [0; 4] amplitude of shape oscillation of large drops; 1 is physical. Default 1 */
    float haze;            /* [0; 4] extinction of the rain's own haze; 1 is physical. Default 1 */
    float haze_sky_m;      /* [0; 100000] m of haze before the sky, where the depth has nothing: how far off it is what
                            * a panorama shows, houses and clouds. Without it what is far in the scene is paler than
                            * the panorama behind. 0: that was taken in such rain, or has its haze. Default 400 */
    float glow;            /* [0; 100] multiplies the light of lighting.lights that the haze scatters, beside
                            * light_gain: the glow around lamps in the rain. 1 is physical. Needs the scene's depth, by
                            * which lamps are found hidden. Costs a pass over the pixels around each lamp, at night and
                            * near ones all of the picture; 0: nothing. Default 1 */
    float bodies_min_mm;   /* [0.2; 2] smaller drops are never drawn one by one, only as haze. They land all the same.
                            * Default 0.4 */
    uint32_t default_material; /* of surfaces that come without (host depth). [0; 255] default 0 */
    uint32_t occlusion_turns; /* [1; 16] the occlusion maps are drawn by turns: each call draws an equal part of them,
                            * and as many calls all of them. Costs as much less; what moves, and wind, changes where
                            * rain falls as many calls late. All at once where a map would no longer reach around the
                            * camera. Default 1: all in each call */
} virga_rain_settings;

VIRGA_API virga_rain_settings virga_default_rain_settings(void);

/* Allocates, and builds pipelines when virga_context_def.pipelines says. VIRGA_DEGRADED: made with smaller pools
 * (max_drops, max_streaks, max_impacts, occlusion_size) to fit the context's memory_budget; the log says how small.
 * Errors as virga_context_create; *rain is NULL then. */
VIRGA_API virga_result virga_rain_create(virga_context *context, const virga_rain_def *def, virga_rain **rain);

/* Destroys it and sets *rain to NULL; accepts NULL. Frames in flight may still use it: what they need goes when they
 * have completed. */
VIRGA_API void virga_rain_destroy(virga_rain **rain);

/* Whether its pipelines for stepping and preparing are there, see virga_pipelines_build: VIRGA_OK, VIRGA_NOT_READY, or
 * why one could not be built. Without VIRGA_PIPELINES_IN_STEPS or _AS_JOBS always VIRGA_OK. Costs nothing. */
VIRGA_API virga_result virga_rain_ready(const virga_rain *rain);

/* Takes new settings, at once or eased. Out of range: clamped and logged, and the call returns VIRGA_DEGRADED. NaN,
 * infinite or wrong cookie: VIRGA_ERROR_INVALID and nothing changes. Costs about 0.2 ms when rate or sizes change. */
VIRGA_API virga_result virga_rain_set(virga_rain *rain, const virga_rain_settings *settings);

/* The settings in force. */
VIRGA_API void virga_rain_get(const virga_rain *rain, virga_rain_settings *settings);

/* Device memory in bytes that virga_rain_create will take for `def`. */
VIRGA_API VkDeviceSize virga_rain_estimate(const virga_rain_def *def);

/* ---- occlusion: where no rain falls --------------------------------------------------------------------------- */

/* Draws the meshes into the occlusion maps around the camera position. Outside rendering. Every frame for moving
 * things, or when the camera has moved; without a call the last maps stay in use, where they reach.
 * Costs a draw of depth and normal of each mesh per map, dearer where a mesh has holes (cover);
 * settings.occlusion_turns shares that among calls. VIRGA_NOT_READY if the rain was made without occlusion. */
VIRGA_API virga_result virga_rain_occlusion(virga_rain *rain, VkCommandBuffer cmd, const double camera_m[3],
                                            const virga_occluder *occluders, uint32_t count);

/* One map to be drawn by the host itself: an orthographic view sheared along the fall of the drops. */
typedef struct virga_occlusion_view {
    float clip_from_world[16]; /* depth 0 on top, 1 at the bottom */
    double origin_m[3];        /* subtract from world positions before the matrix (precision far from the origin) */
    uint32_t layer;            /* of the image given to virga_rain_occlusion_import */
} virga_occlusion_view;

/* Plans the maps for a camera and tells their views; `views` has room for VIRGA_RAIN_MAX_MAPS. Returns the count. */
VIRGA_API uint32_t virga_rain_occlusion_views(virga_rain *rain, const double camera_m[3], virga_occlusion_view *views);

/* Uses depth that the host has rendered with the newest planned views: a 2D array image of a depth format or R32,
 * one layer a view, square, sampled in place of the rain's own maps until virga_rain_occlusion is called.
 * `before` must be a layout that can be sampled by compute. Surfaces get settings.default_material and a normal from
 * the slope of the depth. */
VIRGA_API virga_result virga_rain_occlusion_import(virga_rain *rain, VkCommandBuffer cmd, const virga_image *depth);

/* The maps in use, for whoever shows or checks them. */
typedef struct virga_rain_occlusion_map {
    VkImageView depth;         /* 2D array: 0 on top, 1 at the bottom or where nothing is; VK_NULL_HANDLE: no maps
                                * yet */
    VkImageLayout layout;      /* for sampling */
    uint32_t size;             /* texels along a side */
    uint32_t cascades, slants; /* layer cascade x slants + slant; the narrowest cascade comes first */
    float half_m[4];           /* half of the side, by cascade */
    double top_m;              /* height of depth 0 in the world */
    float height_m;            /* from depth 0 down to depth 1 */
} virga_rain_occlusion_map;

/* Tells the maps that virga_rain_occlusion drew last, or that a host gave. Those of the rain are left ready to be read
 * by compute shaders; for other stages the host records a barrier. Costs nothing. Thread-safety: as the rain. */
VIRGA_API void virga_rain_occlusion_map_get(const virga_rain *rain, virga_rain_occlusion_map *map);

/* ---- time ----------------------------------------------------------------------------------------------------- */

typedef struct virga_rain_step_info {
    double dt_s;         /* [0; 10] host time since the last step; whole ticks of it are run, the rest is kept */
    double camera_m[3];  /* where the field is looked at; may jump */
} virga_rain_step_info;

/* Runs the ticks that dt_s completes, and writes impacts; VIRGA_DEGRADED and one log line where that is more than
 * max_ticks_per_step. A dt_s out of range is refused, and no time passes. Outside rendering. Leaves the impact buffer
 * ready to be read by compute and vertex shaders, as indirect arguments (group_count) and by transfers, in the same
 * command buffer. The first step also fills the state. */
VIRGA_API virga_result virga_rain_step(virga_rain *rain, VkCommandBuffer cmd, const virga_rain_step_info *info);

/* Simulated time (s) that draw times count from: whole ticks plus what dt_s left over. */
VIRGA_API double virga_rain_time(const virga_rain *rain);

/* The ticks that the newest step ran, as virga_impact_gpu.tick counts them: `*first` and those that follow. */
VIRGA_API void virga_rain_ticks(const virga_rain *rain, uint32_t *first, uint32_t *count);

/* The uniform wind of the newest tick (m/s), gust included. */
VIRGA_API void virga_rain_wind(const virga_rain *rain, float wind_m_s[3]);

/* The rain of the newest tick, as level open ground gets it. */
typedef struct virga_rain_fall {
    float rate_mm_h; /* eased where settings change */
    float drop_m;    /* mean diameter of the drops that land, by surface: the sum of d^3 over that of d^2. 0: none do */
    float reach_m;   /* as far from the camera they land: def.range_m */
} virga_rain_fall;

/* Costs nothing. All zero for NULL. Thread-safety: as the rain. */
VIRGA_API void virga_rain_fall_get(const virga_rain *rain, virga_rain_fall *fall);

/* ---- picture -------------------------------------------------------------------------------------------------- */

/* Selects and shades what a view sees at `time_s` (normally virga_rain_time; any time within a tick or two of it is
 * exact). Outside rendering, after the step, or in a frame without one; once for each view to be drawn, directly before
 * its draw.
 * At most VIRGA_RAIN_MAX_VIEWS a frame. Costs one pass over all slots and one over what is seen. */
VIRGA_API virga_result virga_rain_prepare(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view, double time_s);

/* Builds the pipelines for a target (20 to 75 ms each on software Vulkan where they are not cached); at most 8 targets
 * for a rain. Call it where compiling is fine, not while recording a frame that must be on time. */
VIRGA_API virga_result virga_rain_attach(virga_rain *rain, const virga_target *target);

/* Draws haze and streaks of the newest prepare of this frame, premultiplied, blended ONE and ONE_MINUS_SRC_ALPHA.
 * Inside rendering of `target`; sets pipeline, descriptors, viewport and scissor, so a host sets its own again
 * afterwards. VIRGA_NOT_READY (and nothing drawn) for a target that was not attached, or without a prepare in this
 * frame. */
VIRGA_API virga_result virga_rain_draw(virga_rain *rain, VkCommandBuffer cmd, const virga_target *target);

/* Draws haze and the glow of lamps alone, as another view sees them: over what puddles, mirrors and probes show, a
 * world in which it rains as well. There are no streaks in it, so haze is all of the rain. `view` is the other
 * picture's, that of a mirror with a rotation that mirrors; it needs depth and no prepare. `begin` (optional) is a
 * plane (x, y, z) . n = d of the world (m) as n and d: haze begins where rays cross it. For a mirror that is its own:
 * the way from the camera to it is hazed where the mirror itself is. NULL: at the camera. Blended as virga_rain_draw,
 * inside rendering of `target`; what comes after sets its own state. In a frame of a step or a prepare, of which it
 * counts as one view; else, and for a target that was not attached, VIRGA_NOT_READY. Costs what haze and glow do for as
 * many pixels. */
VIRGA_API virga_result virga_rain_draw_haze(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view,
                                            const double begin[4], const virga_target *target);

/* ---- what others read ----------------------------------------------------------------------------------------- */

/* The impacts of the newest step, on the device: a virga_impacts_gpu (virga/shared/impact.h) at `offset` of `buffer`,
 * then max_impacts x virga_impact_gpu. Ordered by tick and slot; the same for the same input. */
typedef struct virga_rain_buffer {
    VkBuffer buffer;
    VkDeviceSize offset, size;
} virga_rain_buffer;

VIRGA_API void virga_rain_impacts(const virga_rain *rain, virga_rain_buffer *impacts);

/* A pane that drops fall on: a rectangle, moving evenly. */
typedef struct virga_rain_pane {
    double corner_m[3];      /* in the world, at the end of the newest step */
    float along_u[3], along_v[3]; /* unit length: its sides from there; the cross product of both points to the outside,
                                   * which is
                              * where drops come from */
    float width_m, height_m; /* (0; 100] along u, along v */
    float velocity_m_s[3];   /* [-1000; 1000] in the world: the faster it goes the more drops it meets. Clamped, logged,
                              * VIRGA_DEGRADED */
} virga_rain_pane;

/* The drops that met a pane in the newest step, as impacts with positions (u, v, 0) in metres on it: a
 * virga_impacts_gpu, then up to VIRGA_RAIN_MAX_HITS x virga_impact_gpu. What falls under a cover of the occlusion maps
 * does not count; slots that stand for several drops have them scattered around. The first drop of a slot has the id of
 * its streak. Outside rendering, after the step, in its frame; ready for compute and transfers. The pane does not stop
 * the drops: hide their streaks by depth. VIRGA_NOT_READY before the first step of a frame. */
VIRGA_API virga_result virga_rain_hits(virga_rain *rain, VkCommandBuffer cmd, const virga_rain_pane *pane,
                                       virga_rain_buffer *hits);

/* The drops of the newest tick: def.max_drops (rounded, see count) x virga_drop_gpu (virga/shared/drop.h), positions
 * relative to `origin_m`. */
VIRGA_API void virga_rain_drops(const virga_rain *rain, virga_rain_buffer *drops, uint32_t *count, double origin_m[3]);

/* Writes every slot's drop in full (virga/shared/point.h: velocity, size, weight, whether it is under cover), relative
 * to `origin_m`, and leaves the buffer ready to be read by transfers, compute and vertex shaders. Outside rendering,
 * after a step, in the frame of that step. VIRGA_NOT_READY without def.points or before the first step. */
VIRGA_API virga_result virga_rain_points(virga_rain *rain, VkCommandBuffer cmd, virga_rain_buffer *points,
                                         uint32_t *count, double origin_m[3]);

/* Newest statistics of completed frames: late by the frames in flight, see virga_frame_completed. */
typedef struct virga_rain_stats {
    uint64_t frame_index;    /* frame they were recorded in; 0: none yet */
    double time_s;           /* simulated */
    uint32_t ticks;          /* run in that step */
    uint32_t slots;          /* all there are */
    uint32_t impacts;        /* of that step, written */
    uint32_t impacts_dropped; /* of that step, that found no room; their water is in impact_water_nl all the same */
    uint32_t streaks;        /* of the newest prepare of that frame */
    uint64_t impact_water_nl; /* water (1e-9 l) that landed in that step, weights counted */
    uint64_t total_water_nl; /* since creation */
    float bodies_radius_m;   /* within this of the camera every slot is one real drop at the current rate */
    float wind_m_s[3];       /* wind of the newest tick, gust included */
} virga_rain_stats;

VIRGA_API void virga_rain_stats_get(virga_rain *rain, virga_rain_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
