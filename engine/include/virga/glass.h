/* virga/glass.h - drops on a pane: landing, sticking, running, merging, swept by wipers, and how the world looks
 * through them.
 *
 * One virga_glass is one pane: a windshield, a side window, a visor, the glass of a camera, or any other surface with
 * drops on it; several live at once. The methods are those of Goto, Tanaka and Sagawa 2009, "Real-time rendering of
 * flow of water drops on a windshield" (drops that run from cell to cell, particles beside the blades, metaballs summed
 * in a height map and compressed), and of Chen and Zhang, "The merging of water droplets based on metaball" (density
 * functions, weighted blend, bump maps). What they leave to the future is here too: curved panes, air flow and
 * acceleration.
 *
 * Places on a pane are (u, v) in metres: u to the right and v up, seen from outside, (0, 0) at its lower left corner.
 * The pane's own frame is right-handed, in metres: virga_glass_shape gives the points of the pane in it, a step's info
 * where it is in the world.
 *
 * A frame: outside rendering
 *
 *     virga_glass_step(glass, cmd, &info);
 *     virga_glass_prepare(glass, cmd, &view, time_s);
 *
 * then the host draws its scene, copies its colour where it wants to see it through the drops (virga_view.color), and
 * inside rendering, last of all but for what is nearer to the eye than the pane, calls virga_glass_draw.
 *
 * Water is counted in whole nanolitres: what landed is on the pane, run off its edges, wiped off or evaporated, to the
 * last one. Deterministic: the same steps give the same bits.
 * Thread-safety: as virga/vulkan.h says. */
#ifndef VIRGA_GLASS_H
#define VIRGA_GLASS_H

#include <virga/drops.h>
#include <virga/light.h>
#include <virga/shared/glass_drop.h>
#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_glass virga_glass; /* opaque */

#define VIRGA_GLASS_MAX_WIPERS 8
#define VIRGA_GLASS_MAX_VIEWS  4 /* prepares in a frame */

typedef struct virga_glass_def {
    uint32_t size, cookie;
    uint32_t seed;                /* of all that is left to chance. Default 1 */
    float width_m, height_m;      /* [0.01; 10] of the pane along u and v. Default 1.4 and 0.75 */
    float cell_m;                 /* [0.0005; 0.01] side of a cell, of which one drop has one. 16 bytes of device memory
                                   * a cell, 4,194,304 cells at most (else raised). Default 0.002, the paper's */
    uint32_t max_drops;           /* [256; 262144] drops and particles together, raised to whole workgroups of 256; 188
                                   * bytes each, and 208 for its picture. Where there is no place, water joins the film.
                                   * Default 32768 */
    float affinity_m;             /* [0.0005; 0.1] width of the spots that the glass is uneven in. Default 0.006 */
    uint32_t max_texels;          /* [64; 4096] of the height map along the pane's longer side; it is made as large as
                                   * the pane shows on the picture, up to this, in tiles of 8. 34 bytes each. Default
                                   * 1024 */
    bool height_map;              /* make what virga_glass_map_get tells of, also where there is only fine film: time
                                   * for every texel, not only where drops are. Default false */
    uint32_t max_ticks_per_step;  /* [1; 64] the same as rain's. Default 16 */
    double tick_s;                /* [1/1000; 1/20] the same as rain's. Default 1/60 */
} virga_glass_def;

VIRGA_API virga_glass_def virga_default_glass_def(void);

/* ---- the pane's shape ------------------------------------------------------------------------------------------ */

/* A pane in its own frame. Give it once (virga_glass_shape_set); all arrays are copied. */
typedef struct virga_glass_shape {
    uint32_t size, cookie;
    const float *positions; /* columns x rows x (x, y, z) in metres, row by row from v = 0 up, at even steps of u and v;
                             * NULL: flat, from (0, 0, 0) along x and y, facing z. Outside is where the cross product of
                             * the steps along u and v points. u and v should be ways along the surface in metres, or
                             * drops come out squeezed */
    uint32_t columns, rows; /* [2; 1025]. Positions are [-1000; 1000] */
    const uint8_t *mask;    /* (optional) mask_columns x mask_rows, row by row from v = 0 up: 0 where there is no glass;
                             * drops run off there. NULL: glass everywhere */
    uint32_t mask_columns, mask_rows; /* [1; 8192] */
    const float *bumps_m;   /* (optional) heights of the surface's structure over its shape in metres, bump_columns x
                             * bump_rows, row by row from v = 0 up, stretched over bump_width_m x bump_height_m and
                             * repeated. It steers drops (Chen and Zhang, equations 11 to 15): they run along its
                             * grooves */
    uint32_t bump_columns, bump_rows;      /* [2; 8192] */
    float bump_width_m, bump_height_m;     /* [0.0001; 100] */
    float bump_pull;        /* [0; 10] how much more affinity its low places have, in standard deviations of the glass's
                             * for one of the heights'. Default 1 */
} virga_glass_shape;

VIRGA_API virga_glass_shape virga_default_glass_shape(void);

/* Makes the positions of a windshield: a part of a cylinder's wall, `width_m` x `height_m` along the surface, leaning
 * back by `rake_deg` [0; 85] from upright, its middle bulging outward with a radius of `bend_m` (0: flat). x is to the
 * right seen from outside, y up, z where the car drives to. The middle of the lower edge lies at the frame's origin.
 * Writes columns x rows x 3 floats, as virga_glass_shape takes them; nothing where columns or rows are not [2; 1025] or
 * a number is not finite. */
VIRGA_API void virga_glass_windshield(float width_m, float height_m, float rake_deg, float bend_m, uint32_t columns,
                                      uint32_t rows, float *positions);

/* Makes positions and a mask from a mesh with texture coordinates in metres (0, 0 at the pane's lower left): each grid
 * point gets the point of the triangle that covers it, or of the nearest one. `mask` gets columns x rows bytes.
 * VIRGA_ERROR_INVALID where an index is out of range, or no triangle covers anything, or columns and rows are not
 * [2; 1025], or width_m and height_m not (0; 10]. The largest grid with hardly a triangle takes seconds. */
VIRGA_API virga_result virga_glass_from_mesh(const float *positions, const float *uvs_m, uint32_t vertex_count,
                                             const uint32_t *indices, uint32_t index_count, float width_m,
                                             float height_m, uint32_t columns, uint32_t rows, float *grid,
                                             uint8_t *mask);

/* The rectangle that stands for the pane where drops are caught on a plane (virga_rain_pane): of its width and height,
 * around the middle of its corners; in its own frame. along_u and along_v have unit length. */
VIRGA_API void virga_glass_rectangle(const virga_glass *glass, float corner[3], float along_u[3], float along_v[3],
                                     float *width_m, float *height_m);

/* ---- settings -------------------------------------------------------------------------------------------------- */

typedef enum virga_glass_drive {
    VIRGA_GLASS_PARKED = 0,       /* stands at low_deg */
    VIRGA_GLASS_CONTINUOUS = 1,   /* there and back without a pause */
    VIRGA_GLASS_INTERMITTENT = 2, /* there and back, then pause_s at low_deg */
    VIRGA_GLASS_HOST = 3,         /* stands where host_deg says in each step */
} virga_glass_drive;

/* A wiper. Angles are on the pane, from u towards v: 0 points to the right, 90 up. */
typedef struct virga_glass_wiper {
    float pivot_m[2];      /* place of the arm's axis, may be beyond the pane; [-20; 20] */
    float reach_m;         /* [0.01; 10] from the axis to the blade's far end */
    float blade_m;         /* [0.01; reach_m] length of the blade */
    float width_m;         /* [0.001; 0.1] of the blade where it touches. Default 0.008 */
    float low_deg, high_deg; /* [-720; 720] the arm's ends; the blade starts at low_deg, whichever is larger */
    float blade_deg;       /* [-180; 180] angle between arm and blade. Default 0 */
    float blade_turn;      /* [0; 1] how much the blade holds its own direction while the arm turns (a parallel
                            * linkage): 0 turns with the arm, 1 keeps the direction that it has at low_deg. Default 0 */
    virga_glass_drive drive; /* default continuous */
    float sweep_s;         /* [0.1; 60] from one end to the other. Default 0.6 */
    float pause_s;         /* [0; 3600] (intermittent). Default 3 */
    float phase_s;         /* [0; 3600] how far into its cycle it is at time 0. Two wipers with the same numbers move in
                            * tandem; mirrored angles make them opposed. Default 0 */
    float host_deg;        /* (host) at the end of the next step; moves evenly to it from the one before */
    float film_mm;         /* [0; 0.5] thickness of the film that a worn blade leaves behind. Default 0.004 */
    float wear;            /* [0; 1] 0 wipes evenly; worn blades leave streaks. Default 0.3 */
} virga_glass_wiper;

VIRGA_API virga_glass_wiper virga_default_glass_wiper(void);

/* Where a wiper is at a time: the angle of its arm. `host_deg` drives give just that. Pure. A sweep_s below 0.1
 * counts as 0.1, a time that is no number as 0. */
VIRGA_API double virga_glass_wiper_deg(const virga_glass_wiper *wiper, double time_s);

typedef enum virga_glass_density {
    VIRGA_GLASS_DENSITY_GOTO = 0,      /* 1 / (1 + (h / R)^4), Goto et al., equation 1; faded to 0 from 4/3 R to 2 R,
                                        * beyond where two drops that meet end (1.32 R) */
    VIRGA_GLASS_DENSITY_BLINN = 1,     /* exp(-ln 2 (h / R)^2), Chen and Zhang, equation 2; faded likewise */
    VIRGA_GLASS_DENSITY_MURAKAMI = 2,  /* equation 3 with its second branch for R / 3 to R (printed without the lower
                                        * end) */
    VIRGA_GLASS_DENSITY_WYVILL = 3,    /* equation 4 */
    VIRGA_GLASS_DENSITY_NISHIMURA = 4, /* equation 5 with the missing term: 1 - 22/9 x^2 + 17/9 x^4 - 4/9 x^6, Wyvill's
                                        * polynomial, which the printed one is without being 0 at R */
} virga_glass_density;

typedef enum virga_glass_blend {
    VIRGA_GLASS_BLEND_SUM = 0,      /* densities add up, then are compressed (Goto et al.) */
    VIRGA_GLASS_BLEND_WEIGHTED = 1, /* weighted by how deep a place lies in each (Chen and Zhang, equations 6 to 10) */
} virga_glass_blend;

typedef enum virga_glass_style {
    VIRGA_GLASS_STYLE_PAPER = 0,    /* the plate displaced by the normal's x and y, mirrored at its borders, from a copy
                                     * of 64 x 64 texels (Goto et al., section 5.4) */
    VIRGA_GLASS_STYLE_PHYSICAL = 1, /* Snell through glass and water, Fresnel. Beyond the picture's borders what is
                                     * within them, mirrored and drawn together to a fifth of the picture, from the
                                     * smaller copies the farther out; from half a picture beyond on more and more the
                                     * environment, from one and a half on it alone. Where the picture has what lies on
                                     * the eye's side of the pane or in it (a frame, pillars; view.depth tells), what
                                     * is beside that */
} virga_glass_style;

/* What drops sit on. */
typedef enum virga_glass_kind {
    VIRGA_GLASS_KIND_PAPER = 0,  /* the paper's: drops run from a radius of 2.2 mm on, on an upright pane */
    VIRGA_GLASS_KIND_CLEAN = 1,  /* 35 and 15 degrees: flat drops that spread */
    VIRGA_GLASS_KIND_DIRTY = 2,  /* 65 and 20: sticks */
    VIRGA_GLASS_KIND_COATED = 3, /* 112 and 98: round drops that run early and fast */
    VIRGA_GLASS_KIND_METAL = 4,  /* painted metal, 80 and 50 */
    VIRGA_GLASS_KIND_LEAF = 5,   /* a waxy leaf, 130 and 115 */
    VIRGA_GLASS_KINDS
} virga_glass_kind;

typedef struct virga_glass_settings {
    uint32_t size, cookie;

    /* What holds drops. A drop whose base has the radius a is held by up to 24 / pi^3 x surface tension x 2 a x
     * (cos receding - cos advancing) (Furmidge 1962; the factor: ElSherbini and Jacobi 2006). */
    float advancing_deg, receding_deg; /* [5; 175], [1; advancing] contact angles. Default those of _KIND_PAPER: 63 and
                                        * 38 */
    float drag;            /* [0.01; 100] multiplies the resistance of a running drop, which is that of its wedge and
                            * its bulk (Huh and Scriven 1971; Kim, Lee and Kang 2002). Default 1 */
    float run_hold;        /* [0; 1] share of what holds a resting drop that still holds a running one. Default 0.6 */
    float affinity;        /* [0; 2] standard deviation of the logarithm of the cells' affinity: unevenness of the
                            * glass. Default 0.5 */
    float meander;         /* [0; 1] share of steps to the side that even glass has. Default 0.1 */
    float path_ease;       /* [0; 1] share of what holds that a wet path takes off for those that follow. Default 0.6 */
    float path_s;          /* [0.1; 600] time in which a path dries. Default 8 */
    float touch;           /* [0; 2] drops flow together where their middles are nearer than this part of the sum of
                            * their bases' radii: 1 is where the bases meet; up to 1.3 pictures show a neck between
                            * them. 0: only in one cell, as Goto et al. have it. Default 1.2 */

    /* What drops leave behind. */
    float tail_m;          /* [0.001; 1] way between small drops that a running one leaves behind. Default 0.012 */
    float tail_mm;         /* [0; 2] their largest radius; 0: none. Default 0.5 */
    float tail_s;          /* [0.1; 3600] time in which one of them shrinks away. Default 12 */
    float film_um;         /* [0; 100] film that a running drop leaves, which breaks into fine drops. Default 6 */
    float film_break_s;    /* [0; 60] time after which a film has broken. Default 0.8 */
    float evaporation_mm_h; /* [0; 100] from what is wet. Default 0.5 */
    float mist_mm;         /* [0; 1] diameter below which landing drops join the film as mist. Default 0.6 */

    /* Air: of the flow against the pane, this share of its part along the surface pulls at drops. */
    float air_share;       /* [0; 2] default 0.4 */

    virga_glass_wiper wipers[VIRGA_GLASS_MAX_WIPERS];
    uint32_t wiper_count;  /* [0; VIRGA_GLASS_MAX_WIPERS]. Default 0 */
    float particle_mm;     /* [0.2; 5] radius of the particles beside blades, each with the water of a hemisphere.
                            * Default 1.5 */
    float penalty;         /* [0; 1] how much farther than apart particles push each other, times their overlap. Default
                            * 0.1 */
    float band;            /* [1; 16] width of their band on each side of a blade, in particles' diameters. Default 4 */
    float hold_back_mm;    /* [0; 20] a drop of that radius within hold_back_cells keeps particles from becoming drops;
                            * where drops of that size do not yet run, those do that just run. Default 2.2 */
    uint32_t hold_back_cells; /* [0; 8] on each side: 3 is the paper's 7 x 7. Default 3 */

    /* Shape. */
    virga_glass_density density; /* default Goto */
    virga_glass_blend blend;     /* default sum */
    bool compress;               /* equation 2. Default true */
    float compress_from;         /* [0; 2] V0. Default 0.5 */
    float compress_step;         /* [0; 1] of V0. Default 0.1 */
    float compress_k;            /* [0; 1] k. Default 0.3 */
    uint32_t compress_steps;     /* [0; 16] default 5 */
    float threshold;             /* [0.05; 0.95] density where a drop ends. Default 0.5 */
    float impact_s;              /* [0; 2] time in which a drop that landed draws its three sub-balls in. Default 0.25
                                  * */

    /* Picture. */
    virga_glass_style style;     /* default physical */
    float paper_shift;           /* [0; 4] (paper) the plate is displaced by the normal's x and y times this part of the
                                  * picture's height. Default 0.35 */
    float thickness_mm;          /* [0; 50] of the glass, (physical). Default 5 */
    float tint[3];               /* [0; 1] what the glass lets through, (physical); drops show it too. Default 1, 1, 1
                                  * */
    bool opaque;                 /* the surface is not glass: drops show what is under them, displaced. Default false */
    float gain;                  /* [0; 100] multiplies what drops reflect. Default 1 */
    virga_lighting lighting;
} virga_glass_settings;

VIRGA_API virga_glass_settings virga_default_glass_settings(void);

/* Sets the contact angles of a kind of surface, and what goes with them. */
VIRGA_API void virga_glass_settings_of(virga_glass_kind kind, virga_glass_settings *settings);

/* ---- life ------------------------------------------------------------------------------------------------------ */

/* Allocates, and builds pipelines when virga_context_def.pipelines says. VIRGA_DEGRADED: made with smaller pools
 * (max_drops, max_texels) to fit the context's memory_budget; the log says how small. Errors as
 * virga_context_create; *glass is NULL then. */
VIRGA_API virga_result virga_glass_create(virga_context *context, const virga_glass_def *def, virga_glass **glass);

/* Destroys it and sets *glass to NULL; accepts NULL. Frames in flight may still use it: what they need goes when they
 * have completed. */
VIRGA_API void virga_glass_destroy(virga_glass **glass);

/* Gives the pane its shape, at the next step; drops stay where they are in u and v. Errors: INVALID (with its line),
 * HOST_MEMORY, DEVICE_MEMORY; nothing changes then. Allocates: not while recording. */
VIRGA_API virga_result virga_glass_shape_set(virga_glass *glass, const virga_glass_shape *shape);

/* Whether its pipelines for stepping and preparing are there, see virga_pipelines_build: VIRGA_OK, VIRGA_NOT_READY, or
 * why one could not be built. Without VIRGA_PIPELINES_IN_STEPS or _AS_JOBS always VIRGA_OK. Costs nothing. */
VIRGA_API virga_result virga_glass_ready(const virga_glass *glass);

/* Takes new settings at once. Out of range: clamped, logged, VIRGA_DEGRADED. NaN, infinite or wrong cookie:
 * VIRGA_ERROR_INVALID and nothing changes. A density, blend or style, or more than five steps of compression, that this
 * pane has not had yet needs three more pipelines, built as virga_context_def.pipelines says; the pane is not drawn
 * until they are there. Errors of those as virga_glass_create, and nothing changes. */
VIRGA_API virga_result virga_glass_set(virga_glass *glass, const virga_glass_settings *settings);
VIRGA_API void virga_glass_get(const virga_glass *glass, virga_glass_settings *settings);

/* Device memory in bytes that virga_glass_create will take at most, with eight frames in flight. */
VIRGA_API VkDeviceSize virga_glass_estimate(const virga_glass_def *def);

/* ---- steps ----------------------------------------------------------------------------------------------------- */

/* One step. */
typedef struct virga_glass_step_info {
    uint32_t first_tick, ticks;    /* see virga_rain_ticks; the first step's first tick is number 1. Ticks that do not
                                    * come after those of the steps before are refused (VIRGA_LOG_FRAME_ORDER) */
    float world_from_pane[9];      /* rotation, column by column: the pane's axes in the world. All zero: none. What is
                                    * no rotation (to 2 %) is refused */
    /* Motion out of its range is clamped, logged, VIRGA_DEGRADED. */
    float velocity_m_s[3];         /* [-1000; 1000] of the pane in the world */
    float acceleration_m_s2[3];    /* [-1000; 1000] of the pane's origin, without gravity */
    float turn_rad_s[3];           /* [-100; 100] of the pane, about the world's axes */
    float wind_m_s[3];             /* [-1000; 1000] of the air in the world */
    float rate_mm_h;               /* [0; 200] of the rain that lands, on level ground; 0: none. A pane that moves meets
                                    * more of it */
    const virga_sizes *sizes;      /* (optional) of its drops; a wrong table is refused. NULL: Marshall and Palmer */
    float air_density;             /* [0; 100] kg/m^3; 0: VIRGA_AIR_DENSITY */
    VkBuffer impacts;              /* (optional) drops that hit this pane: virga_impacts_gpu and virga_impact_gpu,
                                    * positions (u, v, -) on the pane; they land beside those of the rate, as
                                    * virga_rain_hits gives them. Ready to be read by compute. At most 8192 */
    VkDeviceSize impacts_offset;
} virga_glass_step_info;

/* Lets drops land, run, be wiped and dry. Outside rendering; once a frame. A frame with 0 ticks costs next to nothing.
 * */
VIRGA_API virga_result virga_glass_step(virga_glass *glass, VkCommandBuffer cmd, const virga_glass_step_info *info);

/* Simulated time (s) that draw times count from: that of the newest tick, as the first step's first tick began at 0. */
VIRGA_API double virga_glass_time(const virga_glass *glass);

/* A part of a buffer. */
typedef struct virga_glass_buffer {
    VkBuffer buffer;
    VkDeviceSize offset, size;
} virga_glass_buffer;

/* The places of the newest tick: *count x virga_glass_drop_gpu, many of them VIRGA_GLASS_FREE. Ready to be read by
 * transfers and compute. */
VIRGA_API void virga_glass_drops(const virga_glass *glass, virga_glass_buffer *drops, uint32_t *count);

/* What the glass is like, for whoever shows or checks it: *columns x *rows words of 32 bits, row by row from v = 0 up,
 * each a square of def.cell_m: bits 0 to 7 the logarithm of its affinity in standard deviations, times 32, plus 128;
 * bits 8 to 15 and 16 to 23 the bump map's normal along u and v, times 128, plus 128; bit 24: there is glass. There
 * from the first step on; ready to be read by compute after a step. All zero for NULL. Costs nothing. */
VIRGA_API void virga_glass_surface(const virga_glass *glass, virga_glass_buffer *surface, uint32_t *columns,
                                   uint32_t *rows);

/* ---- pictures -------------------------------------------------------------------------------------------------- */

/* Where the pane is in the world when it is drawn. */
typedef struct virga_glass_pose {
    double position_m[3];     /* of the pane's origin */
    float world_from_pane[9]; /* as in virga_glass_step_info */
    double before_position_m[3]; /* the same in the previous frame, for motion vectors (virga_temporal) */
    float before_world_from_pane[9]; /* all zero: the pane has not moved since */
} virga_glass_pose;

/* Makes the height map of what a view sees of the pane at `time_s`, normally virga_glass_time or a part of a tick
 * before; at most VIRGA_GLASS_MAX_VIEWS a frame. Outside rendering, after the step; directly before its draw. Where
 * view.color is given it must hold the scene by then. */
VIRGA_API virga_result virga_glass_prepare(virga_glass *glass, VkCommandBuffer cmd, const virga_view *view,
                                           const virga_glass_pose *pose, double time_s);

/* Builds the pipelines for a target; at most 8 targets. Where compiling is fine. */
VIRGA_API virga_result virga_glass_attach(virga_glass *glass, const virga_target *target);

/* Draws the drops that the newest prepare of this frame found, premultiplied, blended ONE and ONE_MINUS_SRC_ALPHA: over
 * the plate it is the picture through the pane; over nothing, a layer with alpha and without the background. Inside
 * rendering of `target`; sets pipeline, descriptors, viewport and scissor. VIRGA_NOT_READY (and nothing drawn) for a
 * target that was not attached, or without a prepare in this frame. */
VIRGA_API virga_result virga_glass_draw(virga_glass *glass, VkCommandBuffer cmd, const virga_target *target);

/* The same, but draws where drops have the plate looked up: how far from a pixel, in pixels, as red (x, to the right)
 * and green (y, down), with the coverage as blue and alpha; not blended. For a layer that a compositor bends another
 * plate with. Places beyond the picture's borders are told as they are, for a plate that is larger. */
VIRGA_API virga_result virga_glass_draw_refraction(virga_glass *glass, VkCommandBuffer cmd, const virga_target *target);

/* The height map of the newest prepare of a pane that was made with virga_glass_def.height_map, else all zero, in
 * VK_IMAGE_LAYOUT_GENERAL: R32G32B32A32_SFLOAT, red the density (compressed), green the height of the water (m; where
 * red is below the threshold how deep the surface would lie if it went on), blue the share of the texel that water too
 * small for a shape covers, alpha the thickness of the sheet of film (m). The first row is at v = 0. */
typedef struct virga_glass_map {
    VkImageView view;
    VkImage image;
    uint32_t columns, rows; /* of the part in use, from the first texel on */
} virga_glass_map;

VIRGA_API void virga_glass_map_get(const virga_glass *glass, virga_glass_map *map);

/* ---- statistics ------------------------------------------------------------------------------------------------ */

/* Newest statistics of completed frames, since creation where not said otherwise. Water in nanolitres:
 *     landed = drops + particles + film + run_off + wiped + evaporated */
typedef struct virga_glass_stats {
    uint64_t frame_index;      /* 0: none yet */
    uint64_t landed_nl, run_off_nl, wiped_nl, evaporated_nl;
    uint64_t drops_nl, particles_nl, film_nl; /* on the pane now; what blades have gathered is film */
    uint64_t arrived, merged;  /* drops */
    uint64_t to_particles, to_drops; /* conversions (sections 4.4, 4.5) */
    uint64_t crowded;          /* drops that found no place: their water joined the film */
    uint32_t drops, particles, held; /* now; held: particles that wait to become drops (section 4.6) */
    uint32_t balls, balls_cut; /* metaballs of the newest prepare; and places in the lists of tiles
                                * that found no room: then tiles with more than an equal share of the places
                                * show no drops */
} virga_glass_stats;

VIRGA_API void virga_glass_stats_get(virga_glass *glass, virga_glass_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
