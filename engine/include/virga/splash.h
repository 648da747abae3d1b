/* virga/splash.h - splashes that depend on what drops fall on: piles, crowns, cones, disks, and flying droplets.
 *
 * The three models are those of Mizukami et al., "Rendering of water splash". Which one a drop makes, and how large,
 * depends on the material and on the water that it falls on (virga_splash_rule, table 1 of the paper).
 *
 *  - Scattering: piles rise from a circle. Each has a droplet for its tip, which leaves it in the end.
 *  - Crown-cone, on deep water: a crown rises and falls. A cone rises in its middle, and one droplet leaves it at its
 *    peak.
 *  - Disk, on dry steel: the drop flattens and stays.
 *
 * Droplets fly by the paper's drag (equations 2 to 5), gravity and wind. They carry water of their drop, and give it
 * back where they fall.
 *
 * A frame: after virga_ground_step (or with the host's own list of spawns) and outside rendering,
 *
 *     virga_splash_step(splash, cmd, &info);
 *     virga_splash_prepare(splash, cmd, &view, time_s);
 *
 * and inside rendering, after the opaque scene and before the rain, virga_splash_draw. The ground needs the rules that
 * say what splashes (virga_splash_rules) and, one step later, the water that fell back
 * (virga_splash_returned_droplets). virga/scene.h does all of that.
 *
 * Deterministic: the same spawns in the same ticks give the same bits.
 * Thread-safety: as virga/vulkan.h says. */
#ifndef VIRGA_SPLASH_H
#define VIRGA_SPLASH_H

#include <virga/light.h>
#include <virga/shared/droplet.h>
#include <virga/shared/ground_cell.h>
#include <virga/shared/ground_limits.h>
#include <virga/shared/handed_droplet.h>
#include <virga/shared/impact.h>
#include <virga/shared/leaver.h>
#include <virga/shared/spawn.h>
#include <virga/shared/splash_rule.h>
#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_splash virga_splash; /* opaque */

#define VIRGA_SPLASH_MAX_VIEWS 8 /* prepares in a frame */
#define VIRGA_SPLASH_MAX_PANES 8 /* that spray may hit */

typedef struct virga_splash_def {
    uint32_t size, cookie;

    /* [256; 1048576] splashes alive at once, raised to a power of two; 64 bytes each. When it is full, the oldest are
     * replaced. Default 65536. */
    uint32_t max_splashes;

    /* [256; 4194304] droplets in the air at once, raised to a multiple of 256. 128 bytes each, 64 for the sprites of a
     * view and 72 for their indices. Lowered to what a storage buffer of the device can hold. When it is full, the
     * water of further droplets falls back at once. Default 131072. */
    uint32_t max_droplets;

    /* [256; 1048576] spawns of one step, the same as the ground's. Default 65536. */
    uint32_t max_spawns;

    /* [max_spawns; 4194240] droplets that may fall back in one step, 64 bytes each; further ones wait in the air for
     * the next step, and hold their slots until then (virga_splash_stats.droplets_held). Droplets of rain fly for about
     * 0.12 s: in a step of dt_s up to max_droplets x dt_s / 0.12 s come down, so a host with long steps needs more. The
     * ground's must be as large. Default 131072. */
    uint32_t max_returned_droplets;

    /* [0; 1048576] droplets that water may hand over in a step, 48 bytes each. 0: there is no list for them. Default
     * 0. */
    uint32_t max_handed;

    /* [0; 65536] places from which rain water drips, see virga_splash_set_drips; 64 bytes each and 48 for each frame in
     * flight. Above 0, max_handed is raised to 4096 where it is 0. Default 0. */
    uint32_t max_drips;

    /* [1; VIRGA_MAX_VIEWS] views that live in a frame at the same time, see virga_prepared. Each further one costs
     * 85 bytes per droplet. Default 1. */
    uint32_t max_views;

    /* [1; 64] the same as the rain's. Default 16. */
    uint32_t max_ticks_per_step;

    /* [1/1000; 1/20] the same as the rain's (s). Default 1/60. */
    double tick_s;
} virga_splash_def;

VIRGA_API virga_splash_def virga_default_splash_def(void);

/* Where counts, sizes and speeds come from. */
typedef enum virga_splash_mode {
    /* The ranges of the rows, whatever the drop is. */
    VIRGA_SPLASH_MODE_PAPER = VIRGA_SPLASH_PAPER,

    /* The drop's Weber number, after Bai, Rusche and Gosman 2002. Crowns widen as the square root of time (Yarin and
     * Weiss 1995). */
    VIRGA_SPLASH_MODE_PHYSICAL = VIRGA_SPLASH_PHYSICAL,
} virga_splash_mode;

typedef enum virga_splash_style {
    VIRGA_SPLASH_STYLE_PAPER = 0, /* pyramids and spheres, as the paper draws them */
    VIRGA_SPLASH_STYLE_FILM = 1,  /* sheets, piles with round necks, refraction, reflection, motion blur */
} virga_splash_style;

/* What a drop makes on a material in a state. Ranges are {minimum, maximum}; values in between are random. Counts are
 * uniform. Angle and speed follow a normal distribution that has the ends of the range at two standard deviations, and
 * is cut there. */
typedef struct virga_splash_rule {
    uint32_t model;        /* VIRGA_SPLASH_NONE to _DISK, virga/shared/splash_rule.h */
    float min_diameter_mm; /* [0; 10] smaller drops make no splash */
    float min_depth_mm;    /* [0; 100] drops on less water than that make no splash */
    float share[2];        /* [0; 1] of the drop's water that flies up (paper) */
    float count[2];        /* [0; 64] droplets (paper) */
    float angle_deg[2];    /* [0; 90] above the surface */
    float speed_m_s[2];    /* [0; 10] */
    float strength;        /* [0; 4] factor of the number of droplets (physical) */
    float circle_radius;   /* [0; 10] radius of the circle on which piles stand, in diameters of the drop */
} virga_splash_rule;

typedef struct virga_splash_settings {
    uint32_t size, cookie;

    /* Default physical. */
    virga_splash_mode mode;

    /* Default film. */
    virga_splash_style style;

    /* By material and state of the cell. State VIRGA_GROUND_NONE is for what is not ground. Defaults and their sources:
     * engine/splash/splash_table.c. */
    virga_splash_rule rules[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES];

    /* [0.001; 0.2] s and [0.001; 0.2] m, the paper's unit time and unit distance: a pile that exceeds one of them
     * releases its droplet (section 4.1, step 5). Default 0.012 and 0.008. */
    float pile_max_s, pile_max_m;

    /* [0; 1] share of the drop's velocity along the surface that its droplets keep (section 4.5). Default 0.25. */
    float bounce;

    /* [0; 2] share of the step's wind that blows where droplets fly. By the logarithmic law, 0.4 of the wind at 10 m
     * blows at a height of 0.1 m over a street (roughness length 3 mm). The paper uses the rain's wind as it is: 1.
     * Default 0.4. */
    float wind_share;

    /* [0; 1000] distance from the camera (m) up to which splashes have droplets. Farther ones are drawn as a whole:
     * beyond a few metres a droplet is a hundredth of a pixel wide. Default 2.5. */
    float droplet_range_m;

    /* [0.05; 5] droplets of at least this diameter (mm) make a dot where they fall. Default 0.5. */
    float dot_min_mm;

    /* [1; 7] diameters (mm) of the drops that fall from edges, see virga_splash_set_drips: as often one size as another
     * between the two. Default 3 and 5. */
    float drip_min_mm, drip_max_mm;

    /* true: where water drips it has rained for long before the first step, at that step's rate: the film that this
     * rain keeps up is there. false: surfaces are dry, and it may take a minute until they drip. Default true. */
    bool drip_wet;

    /* [0.3; 2] kg/m^3. Default 1.204. */
    float air_density;

    virga_lighting lighting;

    /* [0; 100] multiplies coverage. 1 is physical. Default 1. */
    float gain;

    /* [0; 100] multiplies the light of lamps. Default 1. */
    float light_gain;

    /* [0.5; 4] narrower things are drawn this wide (pixels), with less coverage. Default 1. */
    float min_width_px;

    /* [0; 1] things fade over this depth (m) where they meet geometry. Default 0.002. */
    float soft_m;

    /* [0; 5] things nearer to the camera than this fade out (m). Default 0.05. */
    float near_fade_m;

    /* (film) [0.5; 10000] half width (pixels) from which on a splash that is too small for a sheet shows its parts: the
     * ring of its foot, and droplets as streaks of the time for which the shutter is open. Smaller ones are spots; all
     * are with a large value. The water covered is the same. Default 1.3. */
    float parts_px;

    /* (film) [0; 200] um: where the wall of a crown gets thinner than about this, holes open in it, grow, and leave
     * rods and drops. Walls are as thick as their water gives; at their thinnest some 25 um. 0: they stay whole.
     * Default 25. */
    float hole_um;
} virga_splash_settings;

VIRGA_API virga_splash_settings virga_default_splash_settings(void);

/* Allocates, and builds pipelines when virga_context_def.pipeline_build_mode says so. VIRGA_DEGRADED: pools
 * (max_splashes, max_droplets, max_returned_droplets) were made smaller to fit the context's memory_budget; the log
 * says how small. Errors as virga_context_create; *splash is NULL then. */
VIRGA_API virga_result virga_splash_create(virga_context *context, const virga_splash_def *def, virga_splash **splash);

/* Destroys it and sets *splash to NULL. Accepts NULL. Frames in flight may still use it: their resources are freed when
 * they have completed. */
VIRGA_API void virga_splash_destroy(virga_splash **splash);

/* Returns VIRGA_OK if its pipelines for stepping and preparing are built, VIRGA_NOT_READY if some are missing, or the
 * error of one that could not be built. See virga_pipelines_build. Without VIRGA_PIPELINES_DEFERRED or _AS_JOBS it is
 * always VIRGA_OK. Costs nothing. */
VIRGA_API virga_result virga_splash_ready(const virga_splash *splash);

/* Applies new settings at once. What is in the air keeps what it started with; wind, air density, pile_max_s and
 * pile_max_m apply to it too. Out of range: clamped, logged, VIRGA_DEGRADED. NaN, infinity or a wrong cookie:
 * VIRGA_ERROR_INVALID, and nothing changes. */
VIRGA_API virga_result virga_splash_set(virga_splash *splash, const virga_splash_settings *settings);

/* Reads the current settings. */
VIRGA_API void virga_splash_get(const virga_splash *splash, virga_splash_settings *settings);

/* Returns the device memory in bytes that virga_splash_create will allocate at most, with eight frames in flight. */
VIRGA_API VkDeviceSize virga_splash_estimate(const virga_splash_def *def);

/* A range of a buffer, in bytes. */
typedef struct virga_splash_buffer {
    VkBuffer buffer;
    VkDeviceSize offset, size;
} virga_splash_buffer;

/* Reads the rules for virga_ground_step_info.splash_rules: a virga_splash_rules_gpu in a uniform buffer, as the
 * settings were at the first call in a frame. Call it after virga_frame_begin; it is valid for that frame. Before the
 * first frame there is nothing. */
VIRGA_API void virga_splash_rules(virga_splash *splash, virga_splash_buffer *rules);

/* Reads the water that fell back in the newest step, for virga_ground_step_info.returns of the next one: a
 * virga_impacts_gpu with is_return, then def.max_returned_droplets x virga_impact_gpu. `buffer` is VK_NULL_HANDLE
 * before the first step. */
VIRGA_API void virga_splash_returned_droplets(const virga_splash *splash, virga_splash_buffer *returned_droplets);

/* Reads where droplets are taken over from simulated water (virga_water_step_info.handed), from wheels and feet
 * (virga_ground_step_info.handed), or from a host's own spray: a virga_handed_droplets_gpu, then def.max_handed x
 * virga_handed_droplet_gpu. Splash takes and empties the list in each step, also in one without ticks. `buffer` is
 * VK_NULL_HANDLE without def.max_handed. Costs nothing. */
VIRGA_API void virga_splash_handed(const virga_splash *splash, virga_splash_buffer *handed);

/* A place from which rain water drips: a piece of the lower edge of a roof, an awning, a balcony, a sill, a leaf. */
typedef struct virga_drip_site {
    double position_m[3]; /* [-1e9; 1e9] in the world, at the edge or a centimetre beside it, outside of the mesh */
    float catch_m2;       /* (0; 4] level area of the surface whose rain drains to it */
    float width_m;        /* [0.005; 1] length of the piece of edge. Drops hang 24 mm apart */
    float slope;          /* [0.005; 1] sine of the surface's angle. What is level is 0.02 steep */

    /* [-20; 20] velocity (m/s) with which the water leaves: that of a spout, or of the end of a downpipe, which has the
     * roof's film between them. 0: it hangs and falls, as from an edge. Default 0. */
    float velocity_m_s[3];

    /* [0; 64] drops that fly as one, and land in one place: for pipes, which pour thousands in a second. 0 counts as 1.
     * In a tick four leave a place at most, and what waits is counted as hanging. So it is with drops that find no
     * room. Later such a place drips a quarter faster, at random times, until none is late. Default 0. */
    float drops;

    /* [0; 1] share of the rain that does not reach its surface, as something above keeps it off: a car below a bridge.
     * What is on the surface still runs off. Default 0. */
    float shelter;

    /* [0; 4294967294] number of the place. Water belongs to an index as long as the same place has it. When another
     * number comes there, what the old place had is gone (virga_splash_stats.drip_left_nl), and the new one begins as
     * at the first step: see settings.drip_wet. So a host with more places than def.max_drips numbers them, and gives
     * the indices to those near the camera. Where all have the same number, water stays with its index. Costs nothing.
     * Default 0. */
    uint32_t place;

    /* true: the place itself moves with velocity_m_s, as the edge of a car or an umbrella, and position_m is where it
     * is at the end of the frame. Its drops have its velocity, which may be -100 to 100 then, and fall from where it
     * was when they left it. false: it stands. Default false. */
    bool moves;
} virga_drip_site;

/* Says where rain water drips; NULL and 0: nowhere. Rain (step_info.rain_mm_h) runs over each surface as a film,
 * gathers at the edge, and falls as drops of drip_min_mm to drip_max_mm. They fly like spray, splash where they land,
 * and give their water to the ground: rain that drains = film + drops that hang + drops that fell + what is gone with
 * places whose index another place got, to the nanolitre. The rain that the surface gets is the mean for its area,
 * while the rain's own drops still land on it.
 *
 * `sites` is copied. Takes effect in the next step. A site keeps the water of the site that had its index before, if
 * both are the same place (virga_drip_site.place). Call it again after a state was loaded, as sites are not part of it.
 * Where something moves, call it before each step with its places behind those that stand: they keep their water by
 * their index. `count`: at most def.max_drips, else VIRGA_ERROR_INVALID, as with values out of range; nothing changes
 * then. Costs some ns a site here and a copy of 48 bytes a site in the next step, and in each tick about 0.3 us a site
 * on software Vulkan, which computes them one after the other. Thread-safety: as the splashes. */
VIRGA_API virga_result virga_splash_set_drips(virga_splash *splash, const virga_drip_site *sites, uint32_t count);

/* The ground that spray falls on: what virga_ground_cells_get and virga_ground_maps_get say, after the ground's step.
 */
typedef struct virga_splash_floors {
    VkBuffer floors;     /* virga_floor_gpu of all cells. VK_NULL_HANDLE: there is no ground */
    uint32_t tiles;      /* of 64 x 64 cells along a side of the window, a power of two */
    int32_t low_tile[2]; /* first tile of the window in x and z */
    float cell_m;        /* [0.01; 0.1] side of a cell */
    float base_m;        /* height in the world of height 0 of floors */
} virga_splash_floors;

/* A pane that spray may hit: a rectangle, as it is at the end of the step. */
typedef struct virga_splash_pane {
    double corner_m[3];           /* [-1e9; 1e9] in the world */
    float along_u[3], along_v[3]; /* unit vectors along its sides */
    float width_m, height_m;      /* lengths of the sides */
    float velocity_m_s[3];        /* [-1000; 1000] */
} virga_splash_pane;

/* Arguments of one step. */
typedef struct virga_splash_step_info {
    /* Positions are kept relative to an anchor near it. */
    double camera_m[3];

    /* virga_spawns_gpu and the spawns after it, in a buffer with the usages STORAGE and INDIRECT. Ready to be read by
     * compute shaders and as indirect arguments, as virga_ground_step leaves them. */
    VkBuffer spawns;

    /* A multiple of the device's minStorageBufferOffsetAlignment and of 4. */
    VkDeviceSize spawns_offset;

    /* Bytes from there: the head, and the entries that fit. 0: all of the buffer, which must then not be larger than
     * the device's maxStorageBufferRange. */
    VkDeviceSize spawns_size;

    /* See virga_rain_ticks. They must follow those of earlier steps, else the step is refused
     * (VIRGA_LOG_FRAME_ORDER). */
    uint32_t first_tick, ticks;

    /* [-1000; 1000] wind where the splashes are. Clamped, logged, VIRGA_DEGRADED. */
    float wind_m_s[3];

    /* [0; 1000] rain on level open ground (mm/h), for virga_splash_set_drips. Default 0. */
    float rain_mm_h;

    /* (optional) The rest is for droplets that water hands over, see virga_splash_handed. [-1e9; 1e9] position in the
     * world that theirs are relative to. */
    double handed_origin_m[3];

    /* [0; 1] how much later than the end of the newest tick they are where the list says (s): the part of a tick that
     * has not run yet. */
    float handed_late_s;

    /* (optional) As virga_water_leavers_get returns them. The droplets of those that have fallen back into the water
     * end. VK_NULL_HANDLE: none have. */
    VkBuffer leavers, leaver_table;

    /* (optional) Without ground they fall for three seconds, and are then off the ground. */
    virga_splash_floors floors;

    /* (optional) At most VIRGA_SPLASH_MAX_PANES. What hits them is given to them by virga_splash_give_hits. */
    const virga_splash_pane *panes;
    uint32_t pane_count;
} virga_splash_step_info;

/* Starts the splashes of the spawns, moves droplets, and collects the water of those that fell. Outside rendering. The
 * first tick of the first step must be number 1, as the rain's is, else times do not match. A frame with 0 ticks costs
 * next to nothing. */
VIRGA_API virga_result virga_splash_step(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info);

/* Gives spray that has hit a pane in this frame's step to the pane's list of impacts, behind those that are there: a
 * virga_impacts_gpu and its entries, as virga_rain_find_hits returns it and virga_glass_step reads it. Outside
 * rendering, after the step, at most once for each pane; not in a frame without ticks. `pane`: its index in
 * step_info.panes. `hits`: a storage buffer, ready to be read and written by compute shaders, as it is afterwards.
 * `offset`: as step_info.spawns_offset. `size`: in bytes. What hits a pane and is not given to it is lost. */
VIRGA_API virga_result virga_splash_give_hits(virga_splash *splash, VkCommandBuffer cmd, uint32_t pane, VkBuffer hits,
                                              VkDeviceSize offset, VkDeviceSize size);

/* Returns the simulated time (s) that draw times count from: the end of the newest tick. The first tick of the first
 * step began at 0. */
VIRGA_API double virga_splash_time(const virga_splash *splash);

/* Selects and shades what a view sees at `time_s`: normally virga_splash_time, or a part of a tick before or after.
 * Outside rendering, after the step. Call it once per view, at most VIRGA_SPLASH_MAX_VIEWS times per frame. With
 * def.max_views 1 the draw of a view comes before the next prepare. Costs passes over all live splashes and droplets,
 * and one over the visible ones. */
VIRGA_API virga_result virga_splash_prepare(virga_splash *splash, VkCommandBuffer cmd, const virga_view *view,
                                            double time_s);

/* The same, and *prepared (may be NULL) gets the view's handle for virga_splash_draw_view; 0 if nothing was prepared.
 * Up to def.max_views of them live at the same time. */
VIRGA_API virga_result virga_splash_prepare_view(virga_splash *splash, VkCommandBuffer cmd, const virga_view *view,
                                                 double time_s, virga_prepared *prepared);

/* Builds the pipelines for a target, any number of targets. Do not call it in a frame that must be on time. */
VIRGA_API virga_result virga_splash_attach(virga_splash *splash, const virga_target *target);

/* Draws what the newest prepare of this frame selected: premultiplied, blended with ONE and ONE_MINUS_SRC_ALPHA. Inside
 * rendering of `target`; virga/vulkan.h says what it changes in the command buffer. Returns VIRGA_NOT_READY, and draws
 * nothing, if the target was not attached or nothing was prepared in this frame. */
VIRGA_API virga_result virga_splash_draw(virga_splash *splash, VkCommandBuffer cmd, const virga_target *target);

/* The same for any view that was prepared in this frame, see virga_prepared. VIRGA_ERROR_INVALID for one that was not,
 * or that a later prepare or step has replaced. */
VIRGA_API virga_result virga_splash_draw_view(virga_splash *splash, VkCommandBuffer cmd, const virga_target *target,
                                              virga_prepared prepared);

/* Reads where the droplets of the newest tick are: def.max_droplets (as raised) x virga_droplet_gpu, the live ones
 * first, with VIRGA_DROPLET_ALIVE; positions are relative to `anchor_m`. It may be another buffer after each step.
 * Ready to be read by transfers and compute shaders. */
VIRGA_API void virga_splash_droplets(const virga_splash *splash, virga_splash_buffer *droplets, uint32_t *count,
                                     double anchor_m[3]);

/* The newest statistics of completed frames. Counts are since creation, unless the comment says otherwise. */
typedef struct virga_splash_stats {
    /* 0: none yet. */
    uint64_t frame_index;

    /* By model and material. */
    uint64_t splashes[VIRGA_SPLASH_MODELS][VIRGA_GROUND_MATERIALS];

    /* That flew up; that fell back. */
    uint64_t droplets, fallen;

    /* Water that flew up and that fell back. The difference is in the air. */
    uint64_t flown_nl, returned_nl;

    /* Spray, which is not part of those two: water that was taken over, that was the water's again because its particle
     * fell back, that fell on the ground or beside it, and that hit panes. What is left is in the air. */
    uint64_t spray_nl, spray_back_nl, spray_returned_nl, spray_panes_nl;

    /* Drops that fell from edges, their water, the rain that drained to edges, and the water of places whose index
     * another place got (virga_drip_site.place). drip_rain_nl - drip_nl - drip_left_nl is on surfaces and edges, see
     * virga_splash_set_drips. What fell is part of spray_nl. */
    uint64_t drips, drip_nl, drip_rain_nl, drip_left_nl;

    /* At the end of the newest tick: splashes that have begun and are not over, and droplets in the air. */
    uint32_t splashes_alive, droplets_alive;

    /* Splashes that found no room for their droplets (or had none, behind one that found no room). */
    uint64_t splashes_without_droplets;

    /* Splashes that newer ones replaced before their end, because def.max_splashes was full. */
    uint64_t splashes_cut_short;

    /* Of edges: drops that were to fall and found no room, because def.max_handed or def.max_droplets was full. One
     * that waits is counted again whenever it was to fall; those that fly as one (virga_drip_site.drops) count once. */
    uint64_t drips_held;

    /* Droplets that had landed and stayed in the air, because def.max_returned_droplets was full. One that waits is
     * counted in each tick, and holds a slot of def.max_droplets all that time. */
    uint64_t droplets_held;

    /* Of the newest prepare. */
    uint32_t sprites;

    /* Of the newest prepare: those that found no room. There is room for max_droplets sprites, and for a tenth as many
     * sheets. */
    uint32_t sprites_dropped, sheets_dropped;

    /* Prepares of that frame (at most VIRGA_MAX_VIEWS are listed), and the sprites of each, in their order. */
    uint32_t views, view_sprites[VIRGA_MAX_VIEWS];
} virga_splash_stats;

VIRGA_API void virga_splash_stats_get(virga_splash *splash, virga_splash_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
