/* virga/rain.h - falling rain: a field of drops, wind, occlusion, impacts, streaks and haze.
 *
 * Model. The field is a set of slots. A slot has a drop size and a position in a lattice, which moves with the drops of
 * that size. Under a uniform wind, the drops at a position and time therefore follow from seed, position and time
 * alone; the camera only chooses which part is looked at.
 *
 * Slots are shared out among levels: boxes around the camera, each twice as wide as the one before, with equally many
 * slots in each. In the innermost box a slot is one real drop (weight 1), where the budget allows that. Farther out it
 * stands for several drops (weight above 1), so that the water that falls always matches the rate. Levels cross-fade.
 *
 * Order in a frame: occlusion (when the camera or an occluder has moved), step, prepare, draw. All state is on the
 * device; statistics come back late. Thread-safety: as the context.
 */
#ifndef VIRGA_RAIN_H
#define VIRGA_RAIN_H

#include <virga/drops.h>
#include <virga/light.h>
#include <virga/mesh.h>
#include <virga/shared/impact.h>
#include <virga/shared/point.h>
#include <virga/shared/rain_limits.h>
#include <virga/vulkan.h>
#include <virga/walls.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_rain virga_rain; /* opaque */

/* ---- fixed at creation ---------------------------------------------------------------------------------------- */

typedef struct virga_rain_def {
    uint32_t size, cookie;

    /* Another seed gives other drops with the same statistics. Default 1. */
    uint32_t seed;

    /* [1024; 4194304] slots, rounded up to whole workgroups per level. Fewer slots lower the quality, never the rate.
     * Costs 32 bytes of device memory each, 40 more with wind_texture. Default 131072. */
    uint32_t max_drops;

    /* [4; 512] drops are drawn and land up to this distance from the camera (m). Beyond it there is haze only.
     * Default 32. */
    float range_m;

    /* [256; 4194240] impacts of one step, 64 bytes each. Further impacts are counted and logged. Default 65536. */
    uint32_t max_impacts;

    /* [256; 4194304] streaks of one prepare, 108 bytes each. 0: as many as max_drops. Default 0. */
    uint32_t max_streaks;

    /* [1; 64] ticks of one step. A longer step drops the rest of its time. Default 16. */
    uint32_t max_ticks_per_step;

    /* [1/1000; 1/20] length of a simulation tick (s). Default 1/60. */
    double tick_s;

    /* [64; 8192] texels along a side of an occlusion map. 0: no occlusion. Default 1024. */
    uint32_t occlusion_size;

    /* [1; 4] cascades of maps, one around the other. The widest covers range_m. Default 2. */
    uint32_t occlusion_cascades;

    /* [1; 4] maps per cascade for drops of different slant; in wind, small drops fall flatter. All maps together cost
     * 8 bytes x size^2 x cascades x slants. Default 2. */
    uint32_t occlusion_slants;

    /* What stands still is kept. Maps of it are drawn again only when the camera has gone a tenth of their side, when
     * the wind has turned them by settings.occlusion_tolerance, or when the list of such meshes has changed: another
     * mesh, place or material. A call otherwise copies them, and draws what moves over the copies. So meshes whose
     * vertices change in their buffers must be marked as is_dynamic, as those that move. Costs as much memory again as
     * all maps. Default false: all meshes are drawn in each call. */
    bool occlusion_keeps;

    /* Vertex strides (bytes) of the occluders. Vulkan 1.2 fixes the stride in the pipeline, so there is one pipeline
     * per stride. 0: unused. Default 12, 32, 0, 0. */
    uint32_t occluder_strides[4];

    /* [0; 8] panes per frame that virga_rain_find_hits can be called for. Costs 512 KiB each, and 4 bytes per slot for
     * all. Default 0. */
    uint32_t max_panes;

    /* [1; VIRGA_MAX_VIEWS] views that live in a frame at the same time, see virga_prepared. Each further one costs
     * 108 bytes per streak. Default 1. */
    uint32_t max_views;

    /* Allocates the buffer of virga_rain_write_points: 48 bytes per slot. Default false. */
    bool points;

    /* Allocates what it takes to move drops in a host's 3D wind (settings.wind_texture). Default false. */
    bool wind_texture;
} virga_rain_def;

VIRGA_API virga_rain_def virga_default_rain_def(void);

/* ---- live settings -------------------------------------------------------------------------------------------- */

/* All settings may change at any time. Those that would jump visibly ease in over transition_s. Fill with
 * virga_default_rain_settings. */
typedef struct virga_rain_settings {
    uint32_t size, cookie;

    /* [0; 200] rain that lands on level ground (mm/h): 0.5 drizzle, 2 light, 10 shower, 25 heavy, 50 storm, 150
     * cloudburst. Default 10. */
    float rate_mm_h;

    /* Distribution of drop sizes. Default Marshall-Palmer. */
    virga_sizes sizes;

    /* [0.3; 2] kg/m^3. It is lower at altitude, where drops fall faster. Default 1.204. */
    float air_density;

    /* [0; 60] time in which rate and sizes ease into new values (s). Default 0.5. */
    float transition_s;

    /* [-60; 60] mean wind; y is an updraught. Default 0. */
    float wind_m_s[3];

    /* [0; 30] standard deviation of each horizontal component of the wind. The vertical one has 0.4 of it. Default
     * 0. */
    float gust_m_s;

    /* [0.1; 600] time scale of gusts (s): the distance of the knots of a smooth noise. Default 4. */
    float gust_time_s;

    /* (optional) 3D image of the wind: any float RGBA format with linear filtering; xyz is a velocity in m/s, which is
     * added to the wind above. Needs def.wind_texture. It is read in compute shaders. The pointer is read in
     * virga_rain_set; the image must live as long as the setting. */
    const virga_image *wind_texture;

    /* Corners of the box in the world that the texture fills. Outside of it, the texture's edge continues. */
    double wind_min_m[3], wind_max_m[3];

    /* Light that drops show. Default virga_default_lighting. */
    virga_lighting lighting;

    /* Appearance. At their defaults, gains of 1, the picture is physical. */

    /* [0; 100] multiplies the coverage of streaks. 1 is physical: a 2 mm drop covers 1.5 % of what is behind its streak
     * at 1/48 s. The eye can see that; a film often wants more. Default 1. */
    float streak_gain;

    /* [0; 100] multiplies the light of lighting.lights in drops. Default 1. */
    float light_gain;

    /* [0.5; 4] narrower streaks are drawn this wide (pixels), with less coverage. Default 1. */
    float min_width_px;

    /* [0; 1] streaks fade over this depth (m) where they meet geometry. Default 0.05. */
    float soft_m;

    /* [0; 5] drops nearer to the camera than this fade out (m). Default 0.15. */
    float near_fade_m;

    /* [0; 4] amplitude of the shape oscillation of large drops. 1 is physical. Default 1. */
    float oscillation;

    /* [0; 8] multiplies the rain's own haze. 1 is physical: half of virga_rain_extinction, as the other half is light
     * that drops diffract by less than a pixel. Default 1. */
    float haze;

    /* [0; 100000] length of haze (m) in front of the sky, where the depth buffer is empty: the distance of what a
     * panorama shows, such as houses and clouds. Without it, distant geometry looks paler than the panorama behind it.
     * 0: the panorama already has such haze. Default 400. */
    float haze_sky_m;

    /* [0; 100] multiplies the light of lighting.lights that the haze scatters, on top of light_gain: the glow around
     * lamps in the rain. 1 is physical. Needs the depth of the scene to find hidden lamps. Costs one pass over the
     * pixels around each lamp: at night, for near lamps, the whole picture. 0: no glow, no cost. Default 1. */
    float glow;

    /* [0.2; 2] drops of a smaller diameter (mm) are drawn as haze only, never as streaks. They land all the same.
     * Default 0.4. */
    float streak_min_mm;

    /* [0.2; 100] farther away one streak stands for many drops. It covers at most as much as one drop of this diameter
     * (mm) would there; what is left is haze, so that the rain stays as dense. Small, as 3 to 5: far rain is a fine
     * grain before a veil, as a camera records it; this needs max_drops of 250000 or more, as with fewer there are too
     * few streaks to be seen. Large: fewer, clearer streaks and less haze; from about 20 on the limit is a coverage of
     * 0.25. Default 100. */
    float streak_group_mm;

    /* [0; 255] material of surfaces that have none (depth maps of the host). Default 0. */
    uint32_t default_material;

    /* [1; 16] calls of virga_rain_draw_occlusion in which all occlusion maps are redrawn once; each call draws an equal
     * part of them. Divides the cost, and delays the effect of moving things and of wind by as many calls. All maps are
     * drawn at once where one would no longer reach around the camera. With def.occlusion_keeps only what stands still
     * waits. Default 1: all maps in each call. */
    uint32_t occlusion_interval;

    /* [0; 16] with def.occlusion_keeps: texels by which the edge of the dry ground below a roof of 10 m may be off,
     * because the wind has changed since its map was drawn. 4 texels are some 0.1 m near the camera. In a wind of 3 m/s
     * the drops of 1.1 and 1.5 mm that share a map already land 1.2 m apart below that roof. 0: maps are drawn again
     * whenever the wind changes. Default 4. */
    float occlusion_tolerance;

    /* Upright surfaces that driving rain wets, see virga/walls.h. */
    virga_walls_settings walls;
} virga_rain_settings;

VIRGA_API virga_rain_settings virga_default_rain_settings(void);

/* Allocates, and builds pipelines when virga_context_def.pipeline_build_mode says so. VIRGA_DEGRADED: pools (max_drops,
 * max_streaks, max_impacts, occlusion_size) were made smaller to fit the context's memory_budget; the log says how
 * small. Errors as virga_context_create; *rain is NULL then. */
VIRGA_API virga_result virga_rain_create(virga_context *context, const virga_rain_def *def, virga_rain **rain);

/* Destroys it and sets *rain to NULL. Accepts NULL. Frames in flight may still use it: their resources are freed when
 * they have completed. */
VIRGA_API void virga_rain_destroy(virga_rain **rain);

/* Returns VIRGA_OK if its pipelines for stepping and preparing are built, VIRGA_NOT_READY if some are missing, or the
 * error of one that could not be built. See virga_pipelines_build. Without VIRGA_PIPELINES_DEFERRED or _AS_JOBS it is
 * always VIRGA_OK. Costs nothing. */
VIRGA_API virga_result virga_rain_ready(const virga_rain *rain);

/* Applies new settings, at once or eased. Values out of range are clamped and logged; the call then returns
 * VIRGA_DEGRADED. NaN, infinity or a wrong cookie: VIRGA_ERROR_INVALID, and nothing changes. Costs about 0.2 ms when
 * rate or sizes change. */
VIRGA_API virga_result virga_rain_set(virga_rain *rain, const virga_rain_settings *settings);

/* Reads the current settings. */
VIRGA_API void virga_rain_get(const virga_rain *rain, virga_rain_settings *settings);

/* Returns the device memory in bytes that virga_rain_create will allocate for `def`. */
VIRGA_API VkDeviceSize virga_rain_estimate(const virga_rain_def *def);

/* ---- occlusion: where no rain falls --------------------------------------------------------------------------- */

/* Draws the meshes into the occlusion maps around the camera position. Outside rendering. Call it every frame if
 * occluders move, else when the camera has moved. Without a call the last maps stay in use, as far as they reach.
 *
 * Costs one draw of depth and normal per mesh and map; more where a mesh has holes (cover). settings.occlusion_interval
 * spreads that over several calls. VIRGA_NOT_READY if the rain was created without occlusion.
 *
 * In a frame that is lost the maps are lost too, as Virga does not keep your meshes: rain then falls everywhere until
 * the next call. If you draw maps once, draw them again when virga_frames_lost has risen, and tell of lost frames by
 * virga_frame_dropped: until a loss is known, steps read maps that were never drawn. */
VIRGA_API virga_result virga_rain_draw_occlusion(virga_rain *rain, VkCommandBuffer cmd, const double camera_m[3],
                                                 const virga_occluder *occluders, uint32_t count);

/* One map that the host draws itself: an orthographic view, sheared along the fall of the drops. */
typedef struct virga_occlusion_view {
    float clip_from_world[16]; /* depth 0 at the top, 1 at the bottom */
    double origin_m[3];        /* subtract it from world positions before the matrix, to keep precision */
    uint32_t layer;            /* of the image that is given to virga_rain_import_occlusion */
} virga_occlusion_view;

/* Plans the maps for a camera position and fills their views. `views` has room for VIRGA_RAIN_MAX_MAPS. Returns the
 * number of views. */
VIRGA_API uint32_t virga_rain_plan_occlusion(virga_rain *rain, const double camera_m[3], virga_occlusion_view *views);

/* Uses depth that the host has drawn with the views that were planned last. `depth` is a square 2D array image of a
 * depth format or R32, with one layer per view. It is sampled in place of the rain's own maps until
 * virga_rain_draw_occlusion is called. `before` must be a layout that compute shaders can sample. Surfaces get
 * settings.default_material, and a normal from the slope of the depth. */
VIRGA_API virga_result virga_rain_import_occlusion(virga_rain *rain, VkCommandBuffer cmd, const virga_image *depth);

/* The maps in use, for display and checks. */
typedef struct virga_rain_occlusion_map {
    VkImageView depth;         /* 2D array: 0 at the top, 1 at the bottom or where nothing is; null: no maps yet */
    VkImageLayout layout;      /* for sampling */
    uint32_t size;             /* texels along a side */
    uint32_t cascades, slants; /* the layer is cascade x slants + slant; the narrowest cascade comes first */
    float half_m[4];           /* half of the side, by cascade */
    double top_m;              /* height of depth 0 in the world */
    float height_m;            /* from depth 0 down to depth 1 */
} virga_rain_occlusion_map;

/* Reads which maps virga_rain_draw_occlusion drew last, or the host has given. The rain's own maps are ready to be read
 * by compute shaders; for other stages the host records a barrier. Costs nothing. Thread-safety: as the rain. */
VIRGA_API void virga_rain_occlusion_map_get(const virga_rain *rain, virga_rain_occlusion_map *map);

/* ---- time ----------------------------------------------------------------------------------------------------- */

typedef struct virga_rain_step_info {
    /* [0; 10] host time since the last step (s). Whole ticks of it are run; the rest is kept for the next step. */
    double dt_s;

    /* Position from which the field is looked at. May jump. */
    double camera_m[3];

    /* [0; 64] ticks that the step may run at most, e.g. as a frame is late already. Values above def.max_ticks_per_step
     * count as that. 0: max_ticks_per_step. Default 0. */
    uint32_t max_ticks;
} virga_rain_step_info;

/* Runs the ticks that dt_s completes, and writes their impacts. Outside rendering, at most once per frame. The first
 * step also initialises the state.
 *
 * Leaves the impact buffer ready to be read in the same command buffer: by compute and vertex shaders, as indirect
 * arguments (group_count), and by transfers.
 *
 * VIRGA_DEGRADED and one log line: dt_s has more ticks than max_ticks_per_step or max_ticks. The rest of the time is
 * dropped: rain then falls slower than the clock, and the time is not made up for. stats.ticks_dropped counts. A dt_s
 * that is out of range is refused, and no time passes. */
VIRGA_API virga_result virga_rain_step(virga_rain *rain, VkCommandBuffer cmd, const virga_rain_step_info *info);

/* Returns the simulated time (s) that draw times count from: whole ticks, plus what dt_s left over. */
VIRGA_API double virga_rain_time(const virga_rain *rain);

/* Reads which ticks the newest step ran, as counted by virga_impact_gpu.tick: `*count` ticks from `*first` on. */
VIRGA_API void virga_rain_ticks(const virga_rain *rain, uint32_t *first, uint32_t *count);

/* Reads the uniform wind of the newest tick (m/s), including the gust. */
VIRGA_API void virga_rain_wind(const virga_rain *rain, float wind_m_s[3]);

/* The rain of the newest tick, as it falls on level open ground. */
typedef struct virga_rainfall {
    float rate_mm_h; /* eased while settings change */
    float drop_m;    /* mean diameter of the landing drops, by surface: sum of d^3 over sum of d^2. 0: no drops land */
    float reach_m;   /* distance from the camera up to which they land: def.range_m */
} virga_rainfall;

/* Reads it. Costs nothing. All zero for NULL. Thread-safety: as the rain. */
VIRGA_API void virga_rain_rainfall_get(const virga_rain *rain, virga_rainfall *fall);

/* Reads how wet walls are at the newest tick, for the host's materials. All zero for NULL, and before the first tick.
 * Costs about 10 us. Thread-safety: as the rain. */
VIRGA_API void virga_rain_walls_get(const virga_rain *rain, virga_walls *walls);

/* Reads where the water of a square metre of wall went. `row`: a side or VIRGA_WALL_LEVEL. All zero for NULL or another
 * row. Costs nothing. Thread-safety: as the rain. */
VIRGA_API void virga_rain_wall_water_get(const virga_rain *rain, uint32_t row, uint32_t material,
                                         virga_wall_water *water);

/* ---- picture -------------------------------------------------------------------------------------------------- */

/* Selects and shades what a view sees at `time_s`: normally virga_rain_time, but any time within a tick or two of it is
 * exact. Outside rendering, after the step or in a frame without one. Call it once per view, at most
 * VIRGA_RAIN_MAX_VIEWS times per frame. With def.max_views 1 the draw of a view comes before the next prepare. Costs
 * one pass over all slots, and one over the visible ones. */
VIRGA_API virga_result virga_rain_prepare(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view, double time_s);

/* The same, and *prepared (may be NULL) gets the view's handle for virga_rain_draw_view; 0 if nothing was prepared. Up
 * to def.max_views of them live at the same time. */
VIRGA_API virga_result virga_rain_prepare_view(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view,
                                               double time_s, virga_prepared *prepared);

/* Builds the pipelines for a target, any number of targets. On software Vulkan a pipeline that is not cached takes 20
 * to 75 ms, so do not call it in a frame that must be on time. */
VIRGA_API virga_result virga_rain_attach(virga_rain *rain, const virga_target *target);

/* Draws haze and streaks of the newest prepare of this frame: premultiplied, blended with ONE and ONE_MINUS_SRC_ALPHA.
 * Inside rendering of `target`; virga/vulkan.h says what it changes in the command buffer. Returns VIRGA_NOT_READY, and
 * draws nothing, if the target was not attached or nothing was prepared in this frame. */
VIRGA_API virga_result virga_rain_draw(virga_rain *rain, VkCommandBuffer cmd, const virga_target *target);

/* Bits of what virga_rain_draw draws, in its order. */
typedef enum virga_rain_parts {
    VIRGA_RAIN_HAZE = 1,    /* haze, and the glow of lamps in it: as deep as the scene behind it */
    VIRGA_RAIN_STREAKS = 2, /* each as wide as a lens blurs it, see virga_view.aperture_m */
} virga_rain_parts;

/* The same for some parts alone, e.g. for a layer of each that a lens blurs in its own way. VIRGA_ERROR_INVALID if
 * `parts` has no bit of them, or another one. */
VIRGA_API virga_result virga_rain_draw_parts(virga_rain *rain, VkCommandBuffer cmd, const virga_target *target,
                                             uint32_t parts);

/* The same two for any view that was prepared in this frame, see virga_prepared. VIRGA_ERROR_INVALID for one that was
 * not, or that a later prepare has replaced. */
VIRGA_API virga_result virga_rain_draw_view(virga_rain *rain, VkCommandBuffer cmd, const virga_target *target,
                                            virga_prepared prepared);
VIRGA_API virga_result virga_rain_draw_parts_view(virga_rain *rain, VkCommandBuffer cmd, const virga_target *target,
                                                  virga_prepared prepared, uint32_t parts);

/* Draws haze and the glow of lamps alone, as another view sees them: over the reflected world of puddles, mirrors and
 * probes, where it rains too. There are no streaks in it; haze stands for all of the rain.
 *
 * `view` is the view of the other picture; for a mirror it has a rotation that mirrors. It needs depth, and no prepare.
 * `begin` (optional) is a plane (x, y, z) . n = d in the world (m), as n and d. Haze begins where rays cross the plane.
 * A mirror gives its own plane: the way from the camera to the mirror already has haze where the mirror itself is
 * drawn. NULL: haze begins at the camera.
 *
 * Blended as virga_rain_draw, inside rendering of `target`; the host sets its own state after it. It needs a frame with
 * a step or a prepare, and counts as one of its views. Else, and for a target that was not attached, it returns
 * VIRGA_NOT_READY. Costs what haze and glow cost for the same number of pixels. */
VIRGA_API virga_result virga_rain_draw_haze(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view,
                                            const double begin[4], const virga_target *target);

/* ---- what others read ----------------------------------------------------------------------------------------- */

/* A range of a buffer, in bytes. */
typedef struct virga_rain_buffer {
    VkBuffer buffer;
    VkDeviceSize offset, size;
} virga_rain_buffer;

/* Reads where the impacts of the newest step are: a virga_impacts_gpu (virga/shared/impact.h), then max_impacts x
 * virga_impact_gpu. They are in the order of ticks and slots: the same for the same input. */
VIRGA_API void virga_rain_impacts(const virga_rain *rain, virga_rain_buffer *impacts);

/* A pane that drops fall on: a rectangle that moves at constant speed. */
typedef struct virga_rain_pane {
    /* A corner in the world, at the end of the newest step. */
    double corner_m[3];

    /* Unit vectors along its sides, from that corner. Their cross product points to the outside, which is where drops
     * come from. */
    float along_u[3], along_v[3];

    /* (0; 100] length along u and along v. */
    float width_m, height_m;

    /* [-1000; 1000] in the world. The faster it moves the more drops it meets. Out of range: clamped, logged,
     * VIRGA_DEGRADED. */
    float velocity_m_s[3];
} virga_rain_pane;

/* Finds the drops that hit a pane in the newest step. Outside rendering, after the step, in its frame. The result is
 * ready for compute and transfers: a virga_impacts_gpu, then up to VIRGA_RAIN_MAX_HITS x virga_impact_gpu with
 * positions (u, v, 0) on the pane in metres.
 *
 * Drops under a cover of the occlusion maps do not count. Where a slot stands for several drops, they are scattered
 * around it; the first of them has the id of the streak. The pane does not stop the drops: hide their streaks by depth.
 * VIRGA_NOT_READY before the first step of a frame. */
VIRGA_API virga_result virga_rain_find_hits(virga_rain *rain, VkCommandBuffer cmd, const virga_rain_pane *pane,
                                            virga_rain_buffer *hits);

/* Reads where the drops of the newest tick are: def.max_drops (rounded up; see `count`) x virga_drop_gpu
 * (virga/shared/drop.h), with positions relative to `origin_m`. */
VIRGA_API void virga_rain_drops(const virga_rain *rain, virga_rain_buffer *drops, uint32_t *count, double origin_m[3]);

/* Writes all that is known of the drop of each slot (virga/shared/point.h: velocity, size, weight, whether it is under
 * cover), relative to `origin_m`. Outside rendering, after a step, in the frame of that step. Leaves the buffer ready
 * to be read by transfers, compute and vertex shaders. VIRGA_NOT_READY without def.points, or before the first step. */
VIRGA_API virga_result virga_rain_write_points(virga_rain *rain, VkCommandBuffer cmd, virga_rain_buffer *points,
                                               uint32_t *count, double origin_m[3]);

/* The newest statistics of completed frames. They are late by the frames in flight, see virga_frame_completed. If a
 * view, by its place among those of a frame, shows no drop in 3 s of rain, the log says so once
 * (VIRGA_LOG_NOT_DRAWN). */
typedef struct virga_rain_stats {
    uint64_t frame_index;                   /* frame in which they were recorded; 0: none yet */
    double time_s;                          /* simulated time */
    uint32_t ticks;                         /* that this step ran */
    uint32_t slots;                         /* in all */
    uint32_t impacts;                       /* of this step, written */
    uint32_t impacts_dropped;               /* of this step, that found no room; impact_water_nl includes their water */
    uint32_t streaks;                       /* of the newest prepare of that frame */
    uint32_t views;                         /* prepares of that frame; at most VIRGA_MAX_VIEWS are listed */
    uint32_t view_streaks[VIRGA_MAX_VIEWS]; /* of each of them, in their order */
    uint64_t impact_water_nl;               /* water (1e-9 l) that landed in this step, with weights */
    uint64_t total_water_nl;                /* water that has landed since creation */
    /* within this distance of the camera each slot is one real drop, at the current rate */
    float real_drop_radius_m;
    float wind_m_s[3];      /* wind of the newest tick, including the gust */
    uint64_t ticks_dropped; /* since creation, see virga_rain_step; those of frames in flight are included */
} virga_rain_stats;

VIRGA_API void virga_rain_stats_get(virga_rain *rain, virga_rain_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
