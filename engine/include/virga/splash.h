/* virga/splash.h - splashes that know what they fall on: piles, crowns, cones, disks, and droplets on their orbits.
 *
 * The three models are those of Mizukami et al., "Rendering of water splash": which one a drop makes, and how large,
 * follows from the material and the water that it falls on (virga_splash_row, table 1 of the paper). Scattering: piles
 * rise from a circle, each with a droplet for its tip, which it lets go. Crown-cone, on deep water: a crown rises and
 * falls, a cone rises in its middle and lets one droplet go at its peak. Disk: the drop flattens and stays, on dry
 * steel. Droplets fly by the paper's drag (equations 2 to 5), gravity and wind, carry water that is their drop's, and
 * give it back where they fall.
 *
 * A frame: after virga_ground_step (or a host's own list of spawns) and outside rendering,
 *
 *     virga_splash_step(splash, cmd, &info);
 *     virga_splash_prepare(splash, cmd, &view, time_s);
 *
 * and inside rendering, after the opaque scene and before the rain, virga_splash_draw. The ground gets the rules that
 * say what splashes (virga_splash_rules) and, a step later, the water that fell back (virga_splash_returns).
 * virga/scene.h does all of that.
 *
 * Deterministic: the same spawns in the same ticks give the same bits.
 * Thread-safety: as virga/vulkan.h says. */
#ifndef VIRGA_SPLASH_H
#define VIRGA_SPLASH_H

#include <virga/light.h>
#include <virga/shared/droplet.h>
#include <virga/shared/ground_limits.h>
#include <virga/shared/impact.h>
#include <virga/shared/spawn.h>
#include <virga/shared/splash_rule.h>
#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_splash virga_splash; /* opaque */

#define VIRGA_SPLASH_MAX_VIEWS 4 /* prepares in a frame */

typedef struct virga_splash_def {
    uint32_t size, cookie;
    uint32_t max_splashes; /* [256; 1048576] alive at once, raised to a power of two; 64 bytes each. The oldest make
                            * room. Default 65536 */
    uint32_t max_droplets; /* [256; 4194304] in the air at once, raised to a multiple of 256; 128 bytes each, 64 for the
                            * sprites that a view needs and 72 for their indices. Where there is no room the water
                            * falls back at once. At most what a storage buffer of the device holds. Default 131072 */
    uint32_t max_spawns;   /* [256; 1048576] of one step, the same as the ground's. Default 65536 */
    uint32_t max_returns;  /* [max_spawns; 4194240] droplets that fall in one step, 64 bytes each; more wait in the air
                            * for the next. The ground's must be as large. Default 131072 */
    uint32_t max_ticks_per_step; /* [1; 64] the same as rain's. Default 16 */
    double tick_s;         /* [1/1000; 1/20] the same as rain's. Default 1/60 */
} virga_splash_def;

VIRGA_API virga_splash_def virga_default_splash_def(void);

/* Where counts, sizes and speeds come from. */
typedef enum virga_splash_mode {
    VIRGA_SPLASH_MODE_PAPER = VIRGA_SPLASH_PAPER,       /* the ranges of the rows, whatever the drop */
    VIRGA_SPLASH_MODE_PHYSICAL = VIRGA_SPLASH_PHYSICAL, /* the drop's Weber number: Bai, Rusche and Gosman 2002; crowns
                                                         * widen as the square root of time (Yarin and Weiss 1995) */
} virga_splash_mode;

typedef enum virga_splash_style {
    VIRGA_SPLASH_STYLE_PAPER = 0, /* pyramids and spheres, as the paper draws them */
    VIRGA_SPLASH_STYLE_FILM = 1,  /* sheets, piles with round necks, refraction, reflection, motion blur */
} virga_splash_style;

/* What a drop makes on a material in a state. Ranges are lowest and highest; what lies between is drawn by lot: counts
 * evenly, elevation and speed from the normal distribution whose two deviations are the range's ends, cut there. */
typedef struct virga_splash_row {
    uint32_t model;           /* VIRGA_SPLASH_NONE to _DISK, virga/shared/splash_rule.h */
    float least_diameter_mm;  /* [0; 10] smaller drops make no splash */
    float least_depth_mm;     /* [0; 100] nor do drops on less water than that */
    float share[2];           /* [0; 1] of the drop's water that flies up, (paper) */
    float count[2];           /* [0; 64] droplets, (paper) */
    float angle_deg[2];       /* [0; 90] above the surface */
    float speed_m_s[2];       /* [0; 10] */
    float strength;           /* [0; 4] times the number of droplets, (physical) */
    float circle;             /* [0; 10] radius of the circle that piles stand on, times the drop's diameter */
} virga_splash_row;

typedef struct virga_splash_settings {
    uint32_t size, cookie;
    virga_splash_mode mode;   /* default physical: see below */
    virga_splash_style style; /* default film */
    virga_splash_row rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES]; /* by material and state of the cell; state
                               * VIRGA_GROUND_NONE is for what is not ground. Defaults with their sources:
                               * engine/splash/splash_table.c */
    float pile_s, pile_m;     /* [0.001; 0.2], [0.001; 0.2] unit time and unit distance: a pile that exceeds either lets
                               * its droplet go (section 4.1, step 5). Default 0.012 and 0.008 */
    float bounce;             /* [0; 1] share of the drop's velocity along the surface that its droplets take over
                               * (section 4.5). Default 0.25 */
    float wind_share;         /* [0; 2] of the wind in the step's info that blows where droplets fly. The logarithmic
                               * law has 0.4 of the wind at 10 m at a height of 0.1 m over a street (roughness length 3
                               * mm). The paper takes the rain's wind as it is: 1. Default 0.4 */
    float droplets_m;         /* [0; 1000] nearer splashes have droplets; farther ones show as a whole: beyond some
                               * metres a droplet is a hundredth of a pixel wide. Default 2.5 */
    float dot_mm;             /* [0.05; 5] droplets that are at least as large make a dot where they fall. Default
                               * 0.5 */
    float air_density;        /* [0.3; 2] kg/m^3. Default 1.204 */

    virga_lighting lighting;
    float gain;               /* [0; 100] multiplies coverage; 1 is physical. Default 1 */
    float light_gain;         /* [0; 100] multiplies light from lamps. Default 1 */
    float min_width_px;       /* [0.5; 4] narrower things are drawn this wide with less coverage. Default 1 */
    float soft_m;             /* [0; 1] distance over which things fade where they meet geometry. Default 0.002 */
    float near_m;             /* [0; 5] what is nearer to the camera fades out. Default 0.05 */
} virga_splash_settings;

VIRGA_API virga_splash_settings virga_default_splash_settings(void);

/* Allocates, and builds pipelines when virga_context_def.pipelines says. VIRGA_DEGRADED: made with smaller pools
 * (max_splashes, max_droplets) to fit the context's memory_budget; the log says how small. Errors as
 * virga_context_create; *splash is NULL then. */
VIRGA_API virga_result virga_splash_create(virga_context *context, const virga_splash_def *def, virga_splash **splash);

/* Destroys it and sets *splash to NULL; accepts NULL. Frames in flight may still use it: what they need goes when they
 * have completed. */
VIRGA_API void virga_splash_destroy(virga_splash **splash);

/* Whether its pipelines for stepping and preparing are there, see virga_pipelines_build: VIRGA_OK, VIRGA_NOT_READY, or
 * why one could not be built. Without VIRGA_PIPELINES_IN_STEPS or _AS_JOBS always VIRGA_OK. Costs nothing. */
VIRGA_API virga_result virga_splash_ready(const virga_splash *splash);

/* Takes new settings at once; what is in the air keeps what it started with, but wind, air and piles' ends are live.
 * Out of range: clamped, logged, VIRGA_DEGRADED. NaN, infinite or wrong cookie: VIRGA_ERROR_INVALID and nothing
 * changes. */
VIRGA_API virga_result virga_splash_set(virga_splash *splash, const virga_splash_settings *settings);
VIRGA_API void virga_splash_get(const virga_splash *splash, virga_splash_settings *settings);

/* Device memory in bytes that virga_splash_create will take at most, with eight frames in flight. */
VIRGA_API VkDeviceSize virga_splash_estimate(const virga_splash_def *def);

/* A part of a buffer. */
typedef struct virga_splash_buffer {
    VkBuffer buffer;
    VkDeviceSize offset, size;
} virga_splash_buffer;

/* The rules for virga_ground_step_info.splash_rules: a virga_splash_rules_gpu in a uniform buffer, as settings were at
 * the first call in a frame. Call it after virga_frame_begin (before the first: nothing); good for that frame. */
VIRGA_API void virga_splash_rules(virga_splash *splash, virga_splash_buffer *rules);

/* Water that fell back in the newest step, for virga_ground_step_info.returns of the next: a virga_impacts_gpu with
 * is_return, then def.max_returns x virga_impact_gpu. Buffer VK_NULL_HANDLE before the first step. */
VIRGA_API void virga_splash_returns(const virga_splash *splash, virga_splash_buffer *returns);

/* One step. */
typedef struct virga_splash_step_info {
    double camera_m[3];         /* positions are kept relative to an anchor near it */
    VkBuffer spawns;            /* virga_spawns_gpu and what follows; ready to be read by compute and as indirect
                                 * arguments, as virga_ground_step leaves them */
    VkDeviceSize spawns_offset; /* a multiple of the device's minStorageBufferOffsetAlignment and of 4 */
    VkDeviceSize spawns_size;   /* bytes from there: the head and the entries that there is room for. 0: all of the
                                 * buffer, which then must not be larger than the device's maxStorageBufferRange */
    uint32_t first_tick, ticks; /* see virga_rain_ticks. Ticks that do not come after those of the steps before are
                                 * refused (VIRGA_LOG_FRAME_ORDER) */
    float wind_m_s[3];          /* [-1000; 1000] where the splashes are. Clamped, logged, VIRGA_DEGRADED */
} virga_splash_step_info;

/* Starts the splashes of the spawns, moves droplets, and gives back the water of those that fell. Outside rendering.
 * The first step's first tick is number 1, as rain's is, or times do not agree. A frame with 0 ticks costs next to
 * nothing. */
VIRGA_API virga_result virga_splash_step(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info);

/* Simulated time (s) that draw times count from: that of the newest tick, as the first step's first tick began at 0. */
VIRGA_API double virga_splash_time(const virga_splash *splash);

/* Chooses and shades what a view sees at `time_s`; at most VIRGA_SPLASH_MAX_VIEWS a frame; normally virga_splash_time,
 * or a part of a tick before or after. Outside rendering, after the step; once for each view,
 * directly before its draw. */
VIRGA_API virga_result virga_splash_prepare(virga_splash *splash, VkCommandBuffer cmd, const virga_view *view,
                                            double time_s);

/* Builds the pipelines for a target; at most 8 targets. Where compiling is fine. */
VIRGA_API virga_result virga_splash_attach(virga_splash *splash, const virga_target *target);

/* Draws what the newest prepare of this frame chose, premultiplied, blended ONE and ONE_MINUS_SRC_ALPHA. Inside
 * rendering of `target`; sets pipeline, descriptors, viewport and scissor. VIRGA_NOT_READY (and nothing drawn) for a
 * target that was not attached, or without a prepare in this frame. */
VIRGA_API virga_result virga_splash_draw(virga_splash *splash, VkCommandBuffer cmd, const virga_target *target);

/* The droplets of the newest tick: def.max_droplets (as raised) x virga_droplet_gpu, those alive first, with
 * VIRGA_DROPLET_ALIVE; positions relative to `anchor_m`. It may be another buffer after each
 * step. Ready to be read by transfers and
 * compute. */
VIRGA_API void virga_splash_droplets(const virga_splash *splash, virga_splash_buffer *droplets, uint32_t *count,
                                     double anchor_m[3]);

/* Newest statistics of completed frames. Counts are since creation where not said otherwise. */
typedef struct virga_splash_stats {
    uint64_t frame_index;     /* 0: none yet */
    uint64_t splashes[VIRGA_SPLASH_MODELS][VIRGA_GROUND_MATERIALS]; /* by model and material */
    uint64_t droplets, fallen; /* that ever flew; that fell back */
    uint64_t flown_nl, returned_nl; /* water: taken up, and given back. The difference is in the air */
    uint32_t splashes_alive, droplets_alive; /* of the newest tick; splashes: places in use from the oldest alive on */
    uint64_t crowded;         /* splashes that found no room for their droplets (or had none, behind one that did
                               * not) */
    uint32_t sprites;         /* of the newest prepare */
    uint32_t sprites_cut, sheets_cut; /* that it had no room for: max_droplets sprites, a tenth as many sheets */
} virga_splash_stats;

VIRGA_API void virga_splash_stats_get(virga_splash *splash, virga_splash_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
