/* virga/glass.h - drops on a pane: they land, stick, run, merge and are swept by wipers, and refract the world.
 *
 * A virga_glass is one pane: a windshield, a side window, a visor, the glass of a camera, or any other surface with
 * drops on it. There may be several at once. The methods are those of
 *  - Goto, Tanaka and Sagawa 2009, "Real-time rendering of flow of water drops on a windshield": drops that run from
 *    cell to cell, particles beside the blades, metaballs summed in a height map and compressed;
 *  - Chen and Zhang, "The merging of water droplets based on metaball": density functions, weighted blend, bump maps;
 *  - Sato, Dobashi and Yamamoto 2002, "A method for real-time rendering of water droplets taking into account
 *    interactive depth of field effects": drops as textures.
 * Curved panes, air flow and acceleration, which these papers leave to the future, are here too.
 *
 * Positions on a pane are (u, v) in metres: u to the right and v up, seen from outside, with (0, 0) at the lower left
 * corner. The pane's own frame is right-handed, in metres. virga_glass_shape gives the points of the pane in that
 * frame; a step's info says where the frame is in the world.
 *
 * A frame: outside rendering
 *
 *     virga_glass_step(glass, cmd, &info);
 *     virga_glass_prepare(glass, cmd, &view, time_s);
 *
 * Then the host draws its scene, and copies its color if the drops are to show it (virga_view.color). Inside rendering,
 * last of all but for what is nearer to the eye than the pane, it calls virga_glass_draw.
 *
 * Water is counted in whole nanolitres. All that has landed, or was left by simulated water, is on the pane, has run
 * off its edges, was wiped off, has joined simulated water or has evaporated, to the last nanolitre. Deterministic: the
 * same steps give the same bits.
 * Thread-safety: as virga/vulkan.h says. */
#ifndef VIRGA_GLASS_H
#define VIRGA_GLASS_H

#include <virga/condensation.h>
#include <virga/drops.h>
#include <virga/light.h>
#include <virga/shared/glass_drop.h>
#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_glass virga_glass; /* opaque */

#define VIRGA_GLASS_MAX_WIPERS 8
#define VIRGA_GLASS_MAX_VIEWS  8 /* prepares in a frame */

typedef struct virga_glass_def {
    uint32_t size, cookie;

    /* Seed of everything random. Default 1. */
    uint32_t seed;

    /* [0.01; 10] size of the pane along u and v. Default 1.4 and 0.75. */
    float width_m, height_m;

    /* [0.0005; 0.01] side of a cell (m); a cell holds one drop at most. Costs 16 bytes of device memory per cell.
     * Raised where there would be more than 4,194,304 cells. Default 0.002, the paper's. */
    float cell_m;

    /* [256; 262144] drops and particles together, raised to whole workgroups of 256. 188 bytes each, and 312 for the
     * picture of each. Where no slot is free, water joins the film. Default 32768. */
    uint32_t max_drops;

    /* [0.0005; 0.1] width (m) of the spots in which the glass is uneven. Default 0.006. */
    float affinity_size_m;

    /* [64; 4096] texels of the height map along the longer side of the pane. The map is made as large as the pane
     * appears on the picture, in tiles of 8, up to this. 34 bytes per texel. Default 1024. */
    uint32_t max_texels;

    /* [2; 32] points of the mesh over the pane, along u and v, at which a drop's texture is made, for drops that are
     * drawn as textures. A drop blends the four textures around it; a large or near pane needs more of them. Default 11
     * and 11, the paper's. */
    uint32_t texture_columns, texture_rows;

    /* [8; 64] a side of a texture, made a power of two. 16 bytes per texel of all textures: 484 KiB by default, with
     * some 100 bytes for each of max_drops. Default 16. */
    uint32_t texture_texels;

    /* Fills the whole height map for virga_glass_map_get, also where there is only fine film. Costs time for every
     * texel instead of only those with drops. Default false. */
    bool height_map;

    /* Takes the particles of simulated water, see virga_glass_step_info.water. Costs 4 bytes of device memory per cell,
     * and 44 per drop that film may become in a tick: some 0.2 MB by default. Default false. */
    bool water;

    /* Lets the pane fog, see virga_glass_condensation. Costs 4 bytes of device memory per cell and 8 per cell and view,
     * and 44 per 256 cells. Default false. */
    bool condensation;

    /* [1; VIRGA_MAX_VIEWS] views that live in a frame at the same time, see virga_prepared. Each further one costs
     * 37 bytes per texel, and 0.8 MB. Default 1. */
    uint32_t max_views;

    /* [1; 64] the same as the rain's. Default 16. */
    uint32_t max_ticks_per_step;

    /* [1/1000; 1/20] the same as the rain's (s). Default 1/60. */
    double tick_s;
} virga_glass_def;

VIRGA_API virga_glass_def virga_default_glass_def(void);

/* ---- the pane's shape ------------------------------------------------------------------------------------------ */

/* The shape of a pane in its own frame. Give it once (virga_glass_shape_set); all arrays are copied. */
typedef struct virga_glass_shape {
    uint32_t size, cookie;

    /* columns x rows x (x, y, z) in metres [-1000; 1000], row by row from v = 0 up, at equal steps of u and v. The
     * cross product of the steps along u and v points to the outside. u and v should be lengths along the surface in
     * metres, else drops look squeezed. NULL: flat, from (0, 0, 0) along x and y, facing z. */
    const float *positions;

    /* [2; 1025]. */
    uint32_t columns, rows;

    /* (optional) mask_columns x mask_rows, row by row from v = 0 up. 0: there is no glass, and drops run off. NULL:
     * glass everywhere. */
    const uint8_t *mask;

    /* [1; 8192]. */
    uint32_t mask_columns, mask_rows;

    /* (optional) Heights of the surface's structure over its shape (m): bump_columns x bump_rows, row by row from v = 0
     * up, stretched over bump_width_m x bump_height_m and repeated. It steers drops (Chen and Zhang, equations 11 to
     * 15): they run along its grooves. */
    const float *bumps_m;

    /* [2; 8192]. */
    uint32_t bump_columns, bump_rows;

    /* [0.0001; 100]. */
    float bump_width_m, bump_height_m;

    /* [0; 10] how much more affinity the low parts of the bump map have: standard deviations of the glass's affinity
     * per standard deviation of the heights. Default 1. */
    float bump_affinity;
} virga_glass_shape;

VIRGA_API virga_glass_shape virga_default_glass_shape(void);

/* Fills the positions of a windshield: a part of a cylinder's wall, `width_m` x `height_m` along the surface. It leans
 * back by `rake_deg` [0; 85] from upright. Its middle bulges outward with a radius of `bend_m` (0: flat). x is to the
 * right seen from outside, y up, and z points where the car drives to. The middle of the lower edge is at the frame's
 * origin. Writes columns x rows x 3 floats, as virga_glass_shape takes them. Writes nothing if columns or rows are not
 * [2; 1025], or if a number is not finite. */
VIRGA_API void virga_glass_fill_windshield(float width_m, float height_m, float rake_deg, float bend_m,
                                           uint32_t columns, uint32_t rows, float *positions);

/* Fills positions and a mask from a mesh that has texture coordinates in metres, (0, 0) at the pane's lower left. Each
 * grid point gets the point of the triangle that covers it, or else of the nearest one. `mask` gets columns x rows
 * bytes. The largest grid with hardly a triangle takes seconds. VIRGA_ERROR_INVALID if an index is out of range, if no
 * triangle covers anything, if columns and rows are not [2; 1025], or if width_m and height_m are not (0; 10]. */
VIRGA_API virga_result virga_glass_fill_from_mesh(const float *positions, const float *uvs_m, uint32_t vertex_count,
                                                  const uint32_t *indices, uint32_t index_count, float width_m,
                                                  float height_m, uint32_t columns, uint32_t rows, float *grid,
                                                  uint8_t *mask);

/* Reads the rectangle that stands for the pane where drops are caught (virga_rain_pane): of the pane's width and
 * height, around the middle of its corners, in its own frame. along_u and along_v have unit length. */
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
    /* [-20; 20] axis of the arm; it may lie beyond the pane. */
    float pivot_m[2];

    /* [0.01; 10] from the axis to the far end of the blade. */
    float reach_m;

    /* [0.01; reach_m] length of the blade. */
    float blade_m;

    /* [0.001; 0.1] width of the blade where it touches the glass. Default 0.008. */
    float width_m;

    /* [-720; 720] the two ends of the arm's sweep. It starts at low_deg, whichever of the two is larger. */
    float low_deg, high_deg;

    /* [-180; 180] angle between arm and blade. Default 0. */
    float blade_deg;

    /* [0; 1] how much the blade keeps its own direction while the arm turns (a parallel linkage). 0: it turns with the
     * arm. 1: it keeps the direction that it has at low_deg. Default 0. */
    float blade_hold_direction;

    /* Default continuous. */
    virga_glass_drive drive;

    /* [0.1; 60] time from one end to the other (s). Default 0.6. */
    float sweep_s;

    /* [0; 3600] pause at low_deg (s) (intermittent). Default 3. */
    float pause_s;

    /* [0; 3600] how far into its cycle it is at time 0 (s). Two wipers with the same numbers move in tandem. With
     * mirrored angles they are opposed. Default 0. */
    float phase_s;

    /* (host) Angle at the end of the next step. The arm moves to it at constant speed from the one before. */
    float host_deg;

    /* [0; 0.5] mean thickness of the film (mm) that the blade leaves behind, of water that it has wiped up: a dry blade
     * leaves none. After film_break_s it breaks into fine drops. What covers the pane shows view.color alone, so a film
     * of some micrometres hides what that picture lacks, such as rain drawn later. Default 0.001. */
    float film_mm;

    /* [0; 1] 0 wipes evenly; worn blades leave streaks, which are arcs on the pane. Default 0.3. */
    float wear;
} virga_glass_wiper;

VIRGA_API virga_glass_wiper virga_default_glass_wiper(void);

/* Returns the angle of a wiper's arm at a time. With VIRGA_GLASS_HOST that is host_deg. Pure. A sweep_s below 0.1
 * counts as 0.1, and a time of NaN as 0. */
VIRGA_API double virga_glass_wiper_deg(const virga_glass_wiper *wiper, double time_s);

/* Density of a metaball with radius R at a distance h from its middle; x is h / R. */
typedef enum virga_glass_density {
    /* 1 / (1 + (h / R)^4), Goto et al., equation 1. Faded to 0 from 4/3 R to 2 R: beyond 1.32 R, where two drops that
     * meet end. */
    VIRGA_GLASS_DENSITY_GOTO = 0,

    /* exp(-ln 2 (h / R)^2), Chen and Zhang, equation 2. Faded in the same way. */
    VIRGA_GLASS_DENSITY_BLINN = 1,

    /* Chen and Zhang, equation 3, with its second branch for R / 3 to R (printed without the lower end). */
    VIRGA_GLASS_DENSITY_MURAKAMI = 2,

    /* Chen and Zhang, equation 4. */
    VIRGA_GLASS_DENSITY_WYVILL = 3,

    /* Chen and Zhang, equation 5 with the missing term: 1 - 22/9 x^2 + 17/9 x^4 - 4/9 x^6. That is Wyvill's polynomial;
     * the printed one is not 0 at R. */
    VIRGA_GLASS_DENSITY_NISHIMURA = 4,
} virga_glass_density;

typedef enum virga_glass_blend {
    VIRGA_GLASS_BLEND_SUM = 0,      /* their squares add up; in the paper's style densities do (Goto et al.) */
    VIRGA_GLASS_BLEND_WEIGHTED = 1, /* weighted by the depth inside each ball (Chen and Zhang, equations 6 to 10) */
} virga_glass_blend;

/* How drops show what is behind them. The "plate" is the picture behind the pane: view.color. */
typedef enum virga_glass_style {
    /* The plate displaced by the normal's x and y and mirrored at its borders, from a copy of 64 x 64 texels (Goto et
     * al., section 5.4). */
    VIRGA_GLASS_STYLE_PAPER = 0,

    /* Snell's law through glass and water, and Fresnel.
     * A ray that leaves the picture shows what is within its borders: mirrored, drawn together to a fifth of the
     * picture, and from smaller copies the farther out it is. From half a picture beyond the border on, the environment
     * blends in; from one and a half on, it is all there is. Where the picture shows something in the pane or on the
     * eye's side of it, such as a frame or pillars (view.depth tells), the ray shows what is beside that. */
    VIRGA_GLASS_STYLE_PHYSICAL = 1,

    /* Every drop is one quad with a texture, as in Sato et al. There is no height map: drops do not flow into each
     * other on the picture, all film is mist, and virga_glass_map_get is not filled. The cheapest by far, for panes
     * that are far away; create such a pane with a small max_texels. A surface that is not glass (opaque) is drawn in
     * the physical style instead. */
    VIRGA_GLASS_STYLE_TEXTURES = 2,

    /* The pane is the camera's front element: it moves with the camera, some centimetres before its opening and square
     * to its axis. Drops so near are far out of focus: each becomes a disc with a soft rim, about as large as the
     * opening seen from the pane, in which a share of the light is what the drop refracts. view.aperture_m and focus_m
     * say how large and how soft; with an aperture of 0 drops are sharp. The picture behind (view.color) should
     * already be out of focus itself, as virga_lens makes it. Drops are drawn over everything, whatever the depth. Film
     * is not drawn, and mist only as veil. There is no height map, so create such a pane with a
     * small max_texels. Cost: 32 look-ups for each pixel of each drop's disc. virga_glass_draw_refraction draws
     * nothing, as no pixel shows one other. */
    VIRGA_GLASS_STYLE_FRONT = 3,
} virga_glass_style;

/* The shape of drops in textures. */
typedef enum virga_glass_texture_shape {
    /* The same as in the physical style: as high as the contact angles say, with reflections and lamps. */
    VIRGA_GLASS_TEXTURE_CAP = 0,

    /* Hemispheres that show the plate alone, as in Sato et al. */
    VIRGA_GLASS_TEXTURE_HEMISPHERE = 1,
} virga_glass_texture_shape;

/* What drops sit on. The angles are the advancing and the receding contact angle in degrees. */
typedef enum virga_glass_kind {
    VIRGA_GLASS_KIND_PAPER = 0,  /* the paper's: on an upright pane, drops run from a radius of 2.2 mm on */
    VIRGA_GLASS_KIND_CLEAN = 1,  /* 35 and 15: flat drops that spread */
    VIRGA_GLASS_KIND_DIRTY = 2,  /* 65 and 20: drops that stick */
    VIRGA_GLASS_KIND_COATED = 3, /* 112 and 98: round drops that run early and fast */
    VIRGA_GLASS_KIND_METAL = 4,  /* painted metal, 80 and 50 */
    VIRGA_GLASS_KIND_LEAF = 5,   /* a waxy leaf, 130 and 115 */
    VIRGA_GLASS_KINDS
} virga_glass_kind;

typedef struct virga_glass_settings {
    uint32_t size, cookie;

    /* ---- What holds drops. A drop with a base of radius a is held by up to 24 / pi^3 x surface tension x 2 a x
     * (cos receding - cos advancing) (Furmidge 1962; the factor: ElSherbini and Jacobi 2006). */

    /* [5; 175] and [1; advancing] contact angles. Default those of VIRGA_GLASS_KIND_PAPER: 63 and 38. */
    float advancing_deg, receding_deg;

    /* [0.01; 100] multiplies the resistance of a running drop, which is that of its wedge and its bulk (Huh and Scriven
     * 1971; Kim, Lee and Kang 2002). Default 1. */
    float drag;

    /* [0; 1] share of the force that holds a resting drop which still holds a running one. Default 0.6. */
    float kinetic_hold;

    /* [0; 2] unevenness of the glass: standard deviation of the logarithm of the cells' affinity. Default 0.5. */
    float affinity;

    /* [0; 1] share of steps to the side, even on even glass. Default 0.1. */
    float meander;

    /* [0; 1] share by which a wet path before a drop lowers the force that holds it: by the contact angle on wet glass
     * (cos wet - cos advancing) / (cos receding - cos advancing). A path beside its way draws it in. Default 0.6. */
    float path_ease;

    /* [0.1; 600] time in which a path dries (s). Default 8. */
    float path_dry_s;

    /* [0; 2] drops merge when the distance of their middles is below this share of the sum of the radii of their bases.
     * 1: where these meet on the picture, with necks up to 1.3. 0: in one cell, as in Goto et al. Default 1.2. */
    float merge_distance;

    /* ---- What drops leave behind. */

    /* [0.001; 1] mean distance between the small drops that a running drop leaves behind (m). Default 0.006. */
    float tail_spacing_m;

    /* [0; 2] their largest radius (mm). 0: there are none. Default 0.5. */
    float tail_max_radius_mm;

    /* [0.1; 3600] time in which one of them shrinks away (s). Default 12. */
    float tail_lifetime_s;

    /* [0; 100] thickness of the film (micrometres) that a drop leaves at 0.1 m/s; fine drops in the end. By the law in
     * virga_glass_step_info.water it grows with the speed, and slow drops leave none. 12; metal: 3; coated, leaf: 0. */
    float film_um;

    /* [0; 60] time after which a film has broken (s). The thread behind a drop takes as long if it is 0.6 mm wide, and
     * 0.3 to 3 times as long by its width. Default 0.8. */
    float film_break_s;

    /* [0; 100] evaporation from all that is wet. Default 0.5. */
    float evaporation_mm_h;

    /* [0; 1] landing drops of a smaller diameter (mm) join the film as mist. Default 0.6. */
    float mist_max_mm;

    /* ---- Air. */

    /* [0; 2] share of the air flow along the surface that pulls at drops. Default 0.4. */
    float air_share;

    /* [0; 2] air that meets the outside of the pane head-on spreads along it, as before a camera's lens: it stands
     * still in the middle and has this share of its speed at the middle of each edge. It pulls at drops as air_share
     * says. A disc in a potential flow has 2 / pi. 0: only the part of the free air that is along the pane. Default
     * 0. */
    float air_outward;

    /* ---- Condensation. */

    virga_glass_condensation condensation;

    /* ---- Wipers. */

    virga_glass_wiper wipers[VIRGA_GLASS_MAX_WIPERS];

    /* [0; VIRGA_GLASS_MAX_WIPERS] wipers in use. Default 0. */
    uint32_t wiper_count;

    /* [0.2; 5] radius of the particles beside blades (mm). Each has a hemisphere of water, or more. Default 1.5. */
    float particle_radius_mm;

    /* [0; 1] particles that overlap push each other farther than just apart, by this factor times their overlap.
     * Default 0.1. */
    float penalty;

    /* [1; 16] width of the band of particles on each side of a blade, in diameters of a particle. Default 4. */
    float particle_band;

    /* [0; 20] a drop of that radius (mm), within hold_back_cells of a particle, keeps it from becoming a drop. Where
     * drops of that size do not run yet, the drops that just run do so instead. Default 2.2. */
    float hold_back_mm;

    /* [0; 8] cells on each side; 3 is the paper's 7 x 7. Default 3. */
    uint32_t hold_back_cells;

    /* ---- Shape. */

    /* Default Goto. */
    virga_glass_density density;

    /* Default sum. */
    virga_glass_blend blend;

    /* Compresses sums of densities (Goto et al., equation 2). Default true. */
    bool compress;

    /* [0; 2] V0. Default 0.5. */
    float compress_from;

    /* [0; 1] step, as a share of V0. Default 0.1. */
    float compress_step;

    /* [0; 1] k. Default 0.3. */
    float compress_k;

    /* [0; 16] number of steps. Default 5. */
    uint32_t compress_steps;

    /* [0.05; 0.95] density at which a drop ends. Default 0.5. */
    float threshold;

    /* [0; 1] how firmly uneven glass holds the rims of drops. 1: outlines vary, each with the area of its round cap;
     * drops are longer than wide, by 1 + 0.096 x Bond number (ElSherbini and Jacobi 2004), by 1.2 once they ran or met;
     * and as flat as what drew back: the receding angle behind, in front what holds half of the radius that runs. So
     * they are wider and merge sooner; all else changes the picture only. 0: circles with the mean angle. Costs time
     * for texels with drops. By kind: 0 (paper), 0.8 (clean), 1 (dirty), 0.15 (coated), 0.6 (metal), 0.1 (leaf). */
    float pinning;

    /* [0; 2] time in which a drop that has landed draws in its three sub-balls (s). Default 0.25. */
    float impact_s;

    /* ---- Picture. */

    /* Default physical. */
    virga_glass_style style;

    /* [0; 4] (paper) the plate is displaced by the normal's x and y, times this share of the picture's height. Default
     * 0.35. */
    float paper_shift;

    /* [0; 64] (physical) drops with a smaller diameter on the picture (px) are drawn as textures, each as one quad.
     * From that size down a drop's texture fades in, and from 0.85 of it on its shape in the height map fades out. 0:
     * none. Not on a surface that is not glass. 6 to 12 is where the two look the same; it saves time where a view has
     * thousands of small drops. Default 0. */
    float textured_px;

    /* Default cap. */
    virga_glass_texture_shape texture_shape;

    /* [0; 1024] textures that a prepare makes anew, in turn, if there is one prepare in a frame. 0: all of them, so
     * that they show what is behind the pane now. Fewer cost less and lag behind by (columns x rows / number) frames.
     * Frames then depend on the ones before. All are made at once in the first prepare, after a change of the contact
     * angles, the glass or the shape, and in frames with several prepares. Default 0. */
    uint32_t textures_per_frame;

    /* What is behind the pane does not change while the camera, the pane and the settings stay as they are, as with a
     * photo. Textures are then kept. Default false. */
    bool still_behind;

    /* [0; 1] (front) share of the lens's opening that mist and fine droplets cover: veiling glare of wet glass. Each
     * droplet is a lens of the pane's contact angle, so that share of the light of every pixel comes from a wide cone
     * around it, evenly: blacks get lighter near lamps, and lamps lose as much. Costs 32 look-ups a pixel of the
     * picture. 0: none. Default 0. */
    float veil;

    /* [0; 1] (front) share of the lens's opening that streaks of film cover, as a cloth leaves them: starbursts. A
     * streak spreads the light of a lamp across itself, to both sides, as far as film at the receding contact angle (at
     * most 40 degrees) bends it; lamps lose as much. Costs 64 starburst_rays look-ups a pixel of the picture. 0: none.
     * Default 0. */
    float starburst;

    /* [1; 8] directions of the rays, at equal angles; there are twice as many rays. Default 3. */
    uint32_t starburst_rays;

    /* [-360; 360] direction of the first ray, from u towards v. Default 15. */
    float starburst_deg;

    /* [0; 16] (front) blades of the lens's opening; below 3: it is round. Discs of drops get its shape, and the same
     * way up as virga_lens gives to discs in front of the focus: use the values of virga_lens_settings in these three.
     * Costs four arcs per blade and pixel of a disc, and four times as many if they are not straight. Default 0. */
    uint32_t opening_blades;

    /* [0; 1] how round the blades are: 0 is straight, 1 a circle. Default 0. */
    float opening_roundness;

    /* [-360; 360] rotation of the blades (degrees). Default 0. */
    float opening_deg;

    /* [0; 50] thickness of the glass (physical). Default 5. */
    float thickness_mm;

    /* [0; 1] transmission of the glass (physical); drops show it too. Default 1, 1, 1. */
    float tint[3];

    /* The surface is not glass: drops show what is under them, displaced, and without the gloss that it has when dry:
     * that of a coat with an index of 1.5, such as paint or wax, under the surroundings of `lighting`. At least two
     * fifths of its light are kept. Steep rims of drops mirror the surface. Default false. */
    bool opaque;

    /* [0; 100] multiplies what drops reflect. Default 1. */
    float gain;

    virga_lighting lighting;
} virga_glass_settings;

VIRGA_API virga_glass_settings virga_default_glass_settings(void);

/* Sets the contact angles of a kind of surface in `settings`, and the settings that go with them. */
VIRGA_API void virga_glass_apply_kind(virga_glass_kind kind, virga_glass_settings *settings);

/* ---- life ------------------------------------------------------------------------------------------------------ */

/* Allocates, and builds pipelines when virga_context_def.pipeline_build_mode says so. VIRGA_DEGRADED: pools (max_drops,
 * max_texels) were made smaller to fit the context's memory_budget; the log says how small. Errors as
 * virga_context_create; *glass is NULL then. */
VIRGA_API virga_result virga_glass_create(virga_context *context, const virga_glass_def *def, virga_glass **glass);

/* Destroys it and sets *glass to NULL. Accepts NULL. Frames in flight may still use it: their resources are freed when
 * they have completed. */
VIRGA_API void virga_glass_destroy(virga_glass **glass);

/* Gives the pane its shape, from the next step on. Drops keep their u and v. Allocates, so do not call it while
 * recording. Errors: INVALID (with a log line), HOST_MEMORY, DEVICE_MEMORY; nothing changes then. */
VIRGA_API virga_result virga_glass_shape_set(virga_glass *glass, const virga_glass_shape *shape);

/* Returns VIRGA_OK if its pipelines for stepping and preparing are built, VIRGA_NOT_READY if some are missing, or the
 * error of one that could not be built. See virga_pipelines_build. Without VIRGA_PIPELINES_DEFERRED or _AS_JOBS it is
 * always VIRGA_OK. Costs nothing. */
VIRGA_API virga_result virga_glass_ready(const virga_glass *glass);

/* Applies new settings at once. Out of range: clamped, logged, VIRGA_DEGRADED. NaN, infinity or a wrong cookie:
 * VIRGA_ERROR_INVALID, and nothing changes.
 *
 * A style that this pane has not had yet needs 2 to 20 pipelines for each attached target. A new density, blend or
 * style needs three more; so do a first pinning above 0, and more than five steps of compression. They are built as
 * virga_context_def.pipeline_build_mode says, and the pane is not drawn until they are there. Their errors are those of
 * virga_glass_create, and then nothing changes. */
VIRGA_API virga_result virga_glass_set(virga_glass *glass, const virga_glass_settings *settings);

/* Reads the current settings. */
VIRGA_API void virga_glass_get(const virga_glass *glass, virga_glass_settings *settings);

/* Returns the device memory in bytes that virga_glass_create will allocate at most, with eight frames in flight. */
VIRGA_API VkDeviceSize virga_glass_estimate(const virga_glass_def *def);

/* ---- steps ----------------------------------------------------------------------------------------------------- */

/* Arguments of one step. */
typedef struct virga_glass_step_info {
    /* See virga_rain_ticks; the first tick of the first step is number 1. They must follow those of earlier steps, else
     * the step is refused (VIRGA_LOG_FRAME_ORDER). */
    uint32_t first_tick, ticks;

    /* Rotation, column by column: the pane's axes in the world. All zero: no rotation. What is no rotation (to 2 %) is
     * refused. */
    float world_from_pane[9];

    /* Motion. Values out of range are clamped, logged, VIRGA_DEGRADED. */

    /* [-1000; 1000] of the pane in the world. */
    float velocity_m_s[3];

    /* [-1000; 1000] of the pane's origin, without gravity. */
    float acceleration_m_s2[3];

    /* [-100; 100] angular velocity of the pane, about the world's axes. */
    float angular_velocity_rad_s[3];

    /* [-1000; 1000] velocity of the air in the world. */
    float wind_m_s[3];

    /* [0; 200] rate of the rain that lands, on level ground. 0: none. A moving pane meets more of it. */
    float rate_mm_h;

    /* (optional) Distribution of its drop sizes; a wrong table is refused. NULL: Marshall and Palmer. */
    const virga_sizes *sizes;

    /* [0; 100] kg/m^3. 0: VIRGA_AIR_DENSITY. */
    float air_density;

    /* (optional) Drops that hit this pane, as virga_rain_find_hits returns them: virga_impacts_gpu and at most 8192
     * virga_impact_gpu, with positions (u, v, -) on the pane. They land in addition to those of the rate. Ready to be
     * read by compute shaders. */
    VkBuffer impacts;
    VkDeviceSize impacts_offset;

    /* (optional) Particles of simulated water, as virga_water_step takes them: `water_count` virga_particle_gpu from
     * `water_offset` on, a multiple of the device's minStorageBufferOffsetAlignment; ready to be read by compute
     * shaders. Needs glass_def.water.
     *
     * Water touches the pane where a particle is on its outside, less than `water_spacing_m` ([0; 10], their distance
     * at rest) from it, or no more than a quarter of that behind it: the cell below it and those within three quarters
     * of that distance, up to 64 along each axis. Water inside the pane does nothing to it.
     *
     * What is on these cells joins the water, and so does what lands on them: the pane is clear there. A cell that
     * nothing has touched for 0.06 s has a film, as thick as a plate has that is drawn out of water at the speed U of
     * the fastest particle that touched it last, along the pane and relative to it: 0.94 l Ca^(2/3), where l is the
     * capillary length, 2.7 mm, and Ca = mu U / sigma (Landau and Levich 1942; Derjaguin 1943). That is 26 micrometres
     * at 7 cm/s and 150 at 1 m/s. It holds below some 7 cm/s, Ca = 0.001; faster water leaves more at first, which runs
     * down within a second, and that is not simulated. Speeds above 4.1 m/s count as that. Below Ca = t^3 / (9 sqrt(3)
     * ln(L)), with the receding contact angle t and ln(L) = 15, the contact line keeps up with the water and the glass
     * stays dry (de Gennes 1986): on the paper's glass below 9 cm/s, on coated glass below 1.5 m/s.
     * Once film_break_s has passed, the film breaks into drops, of what is on squares of 4 to 16 mm (at least 1 to 4
     * cells); a twentieth stays as fine drops.
     *
     * The simulation neither gives this water nor gets that which joins it; both are counted, in
     * virga_glass_stats.touched_nl and joined_nl. VK_NULL_HANDLE: there is none. A step with 0 ticks does not read
     * them. Costs a pass over the particles, of which those near the pane cost more, and until the film has broken one
     * over blocks of cells, and one over sites of film in each tick. */
    VkBuffer water;
    VkDeviceSize water_offset;
    uint32_t water_count;
    float water_spacing_m;

    /* (water) [-1e9; 1e9] positions in the world (m) that the particles' are relative to, and of the pane's origin. */
    double water_origin_m[3], position_m[3];
} virga_glass_step_info;

/* Lets drops land, run, be wiped and dry. Outside rendering; once per frame. A frame with 0 ticks costs next to
 * nothing. */
VIRGA_API virga_result virga_glass_step(virga_glass *glass, VkCommandBuffer cmd, const virga_glass_step_info *info);

/* Lets somebody breathe on the pane, on the side that fogs. Its jet of some 2 m/s adds a coefficient of 28 W/(m^2 K) in
 * its middle, that of air which meets a wall. Has no effect while condensation is off. Up to VIRGA_GLASS_MAX_BREATHS
 * that have not ended may be there. Errors: VIRGA_ERROR_INVALID with a log line, and nothing changes, for a pane
 * without virga_glass_def.condensation, for values out of range, and if there are too many. */
VIRGA_API virga_result virga_glass_breathe(virga_glass *glass, const virga_glass_breath *breath);

/* Returns the simulated time (s) that draw times count from: the end of the newest tick. The first tick of the first
 * step began at 0. */
VIRGA_API double virga_glass_time(const virga_glass *glass);

/* A range of a buffer, in bytes. */
typedef struct virga_glass_buffer {
    VkBuffer buffer;
    VkDeviceSize offset, size;
} virga_glass_buffer;

/* Reads where the slots of the newest tick are: *count x virga_glass_drop_gpu, many of them VIRGA_GLASS_FREE. Ready to
 * be read by transfers and compute shaders. */
VIRGA_API void virga_glass_drops(const virga_glass *glass, virga_glass_buffer *drops, uint32_t *count);

/* Reads where the properties of the glass are, for display and checks: *columns x *rows unsigned integers of 32 bits,
 * row by row from v = 0 up. Each is a square with a side of def.cell_m:
 *  - bits 0 to 7: logarithm of its affinity, in standard deviations, times 32, plus 128;
 *  - bits 8 to 15 and 16 to 23: the bump map's normal along u and along v, times 128, plus 128;
 *  - bit 24: there is glass.
 * Valid from the first step on, and ready to be read by compute shaders after a step. All zero for NULL. Costs
 * nothing. */
VIRGA_API void virga_glass_surface(const virga_glass *glass, virga_glass_buffer *surface, uint32_t *columns,
                                   uint32_t *rows);

/* ---- pictures -------------------------------------------------------------------------------------------------- */

/* Where the pane is in the world when it is drawn. */
typedef struct virga_glass_pose {
    /* Position of the pane's origin. */
    double position_m[3];

    /* As in virga_glass_step_info. */
    float world_from_pane[9];

    /* The same two in the previous frame, for motion vectors (virga_temporal). If the rotation is all zero, the pane
     * has not moved since. */
    double previous_position_m[3];
    float previous_world_from_pane[9];
} virga_glass_pose;

/* Makes the height map of what a view sees of the pane at `time_s`: normally virga_glass_time, or a part of a tick
 * before it. Outside rendering, after the step. At most VIRGA_GLASS_MAX_VIEWS per frame. With def.max_views 1 the draw
 * of a view comes before the next prepare. If view.color is given it must hold the scene by then. */
VIRGA_API virga_result virga_glass_prepare(virga_glass *glass, VkCommandBuffer cmd, const virga_view *view,
                                           const virga_glass_pose *pose, double time_s);

/* The same, and *prepared (may be NULL) gets the view's handle for virga_glass_draw_view; 0 if nothing was prepared. Up
 * to def.max_views of them live at the same time. */
VIRGA_API virga_result virga_glass_prepare_view(virga_glass *glass, VkCommandBuffer cmd, const virga_view *view,
                                                const virga_glass_pose *pose, double time_s, virga_prepared *prepared);

/* A pane of virga_glass_prepare_panes. */
typedef struct virga_glass_pane {
    virga_glass *glass;
    virga_glass_pose pose;

    /* As in virga_glass_prepare. */
    double time_s;

    /* Written: the view's handle for virga_glass_draw_view; 0 if the pane was not prepared. */
    virga_prepared prepared;
} virga_glass_pane;

/* Prepares several panes for one view, for a host with many of them. The panes get the same pictures as by a
 * virga_glass_prepare_view each, but share the smaller copies that are made of view->color: these are made once and not
 * once per pane, which is 0.8 MB written, and all of view->color read.
 *
 * All show the picture that view->color holds now, without one another's drops. Where drops are to show those of a
 * pane behind theirs, prepare and draw the far panes first, copy the picture again, and prepare the near ones in
 * another call.
 *
 * Draw the panes before any of them is prepared again (with def.max_views above 1: that many times), as that may
 * replace the copies that the others show. Outside rendering, after the steps. The panes are of one context, in any
 * order; one more prepare of each counts, see VIRGA_GLASS_MAX_VIEWS.
 *
 * Returns the first error, after which no further pane is prepared, else the last remark of a pane; VIRGA_OK for a
 * count of 0. VIRGA_ERROR_INVALID, and nothing is prepared, if a glass is NULL or panes are of two contexts. */
VIRGA_API virga_result virga_glass_prepare_panes(VkCommandBuffer cmd, const virga_view *view, virga_glass_pane *panes,
                                                 uint32_t count);

/* Builds the pipelines for a target, any number of targets. Do not call it in a frame that must be on time. */
VIRGA_API virga_result virga_glass_attach(virga_glass *glass, const virga_target *target);

/* Draws the drops of the newest prepare of this frame: premultiplied, blended with ONE and ONE_MINUS_SRC_ALPHA. Over
 * the plate that gives the picture through the pane. Over nothing it gives a layer with alpha, without the background.
 * Inside rendering of `target`; virga/vulkan.h says what it changes in the command buffer. Returns VIRGA_NOT_READY, and
 * draws nothing, if the target was not attached or nothing was prepared in this frame. */
VIRGA_API virga_result virga_glass_draw(virga_glass *glass, VkCommandBuffer cmd, const virga_target *target);

/* The same for any view that was prepared in this frame, see virga_prepared. VIRGA_ERROR_INVALID for one that was not,
 * or that a later prepare has replaced. */
VIRGA_API virga_result virga_glass_draw_view(virga_glass *glass, VkCommandBuffer cmd, const virga_target *target,
                                             virga_prepared prepared);

/* The same, but draws where drops look up the plate: the offset from the pixel in pixels, as red (x, to the right) and
 * green (y, down), with the coverage in blue and alpha. Not blended. It is a layer with which a compositor distorts
 * another plate. Offsets may point beyond the borders of the picture, for a plate that is larger. */
VIRGA_API virga_result virga_glass_draw_refraction(virga_glass *glass, VkCommandBuffer cmd, const virga_target *target);

/* The same for any view that was prepared in this frame, as virga_glass_draw_view. */
VIRGA_API virga_result virga_glass_draw_refraction_view(virga_glass *glass, VkCommandBuffer cmd,
                                                        const virga_target *target, virga_prepared prepared);

/* The height map of the newest prepare, in VK_IMAGE_LAYOUT_GENERAL. All zero unless the pane was created with
 * virga_glass_def.height_map.
 *
 * R32G32B32A32_SFLOAT. Red: the density (compressed). Green: the height of the water (m); where red is below the
 * threshold, how deep the surface would lie if it went on. Blue: the share of the texel that is covered by water too
 * small to have a shape. Alpha: the thickness of the sheet of film (m). The first row is at v = 0. */
typedef struct virga_glass_map {
    VkImageView view;
    VkImage image;

    /* Part in use, from the first texel on. */
    uint32_t columns, rows;
} virga_glass_map;

VIRGA_API void virga_glass_map_get(const virga_glass *glass, virga_glass_map *map);

/* ---- statistics ------------------------------------------------------------------------------------------------ */

/* The newest statistics of completed frames, since creation unless the comment says otherwise. Water is in nanolitres:
 *     landed + touched + fog_given = drops + particles + film + run_off + wiped + evaporated + joined
 * Fog is thin, so it has a finer unit, picolitres:
 *     condensed_pl = fog_pl + fog_dried_pl + 1000 fog_given */
typedef struct virga_glass_stats {
    /* 0: none yet. */
    uint64_t frame_index;

    uint64_t landed_nl, run_off_nl, wiped_nl, evaporated_nl;

    /* Left by simulated water that receded from the pane, and taken up by it: the simulation misses neither. */
    uint64_t touched_nl, joined_nl;

    /* Condensation. Vapour that became fog; what is on the pane now; what has evaporated; and what became part of
     * drops, of blades' water or of film, joined simulated water, or ran off. */
    uint64_t condensed_pl, fog_pl, fog_dried_pl, fog_given_nl;

    /* On the pane now. Film includes what blades have gathered. */
    uint64_t drops_nl, particles_nl, film_nl;

    /* Drops. */
    uint64_t arrived, merged;

    /* Conversions (sections 4.4 and 4.5). */
    uint64_t to_particles, to_drops;

    /* Drops that found no free slot: their water joined the film. */
    uint64_t drops_without_slot;

    /* Now. held: particles that wait to become drops (section 4.6). */
    uint32_t drops, particles, particles_waiting;

    /* Of the newest prepare: metaballs; and entries of the lists of tiles that found no room. If there are any, tiles
     * with more than an equal share of the entries show no drops. */
    uint32_t balls, ball_entries_dropped;

    /* Prepares of that frame (at most VIRGA_MAX_VIEWS are listed), and the metaballs of each, in their order. */
    uint32_t views, view_balls[VIRGA_MAX_VIEWS];
} virga_glass_stats;

VIRGA_API void virga_glass_stats_get(virga_glass *glass, virga_glass_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
