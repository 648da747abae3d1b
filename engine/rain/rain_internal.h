/* rain/rain_internal.h - the object behind virga_rain, and the functions that its files share. Internal.
 *
 *   rain.c              create, destroy, settings
 *   classes.c           size classes: their slots, weights and motion
 *   wind.c              the uniform wind with its gusts
 *   walls.c             water on upright surfaces
 *   rain_descriptors.c  the bindings of all passes
 *   rain_frame.c        what the first call of a frame records
 *   rain_step.c         ticks and impacts
 *   rain_occlusion.c    maps of where no rain falls
 *   rain_hits.c         drops that hit a pane
 *   rain_state.c        checks a saved state
 *   rain_draw.c         prepare, attach, draw, haze alone */
#ifndef VIRGA_RAIN_INTERNAL_H
#define VIRGA_RAIN_INTERNAL_H

#include "gpu/context.h"
#include "gpu/effect.h"
#include "gpu/mesh_map.h"
#include "gpu/state.h"
#include "rain/rain.h"

#include <stddef.h>

#include <virga/rain.h>
#include <virga/shared/compact.h>
#include <virga/shared/drop.h>
#include <virga/shared/rain_gpu.h>
#include <virga/shared/view_gpu.h>

/* ---- classes.c: on the host, in double precision */

typedef struct rain_class {
    /* density_share: logarithmic width of the bin x diameter. */
    double diameter_m, terminal_m_s, density_share;
    double velocity[3];
    double drag;       /* of the newest tick, see virga_class_gpu */
    int64_t travel[3]; /* fixed point, see virga_class_gpu */
} rain_class;

typedef struct rain_classes {
    rain_class classes[VIRGA_RAIN_CLASSES];
    uint32_t slot_count[VIRGA_RAIN_MAX_LEVELS][VIRGA_RAIN_CLASSES];
    double per_m3[VIRGA_RAIN_CLASSES];      /* drops of the class per m^3, at this time */
    double per_m3_from[VIRGA_RAIN_CLASSES]; /* at the start of the transition */
    double per_m3_to[VIRGA_RAIN_CLASSES];
    double rate_mm_h, rate_from, rate_to; /* the rain rate in the same transition; haze uses it */
    /* Time since the start of the transition, and its duration; 0: no transition. */
    double eased_s, ease_s;
    virga_weight_gpu weights[VIRGA_RAIN_MAX_LEVELS * VIRGA_RAIN_CLASSES];
    uint32_t levels, slots_per_level;
    double side_m; /* side of the largest box */
} rain_classes;

/* Sets sizes, boxes, and the number of slots of each class in each box. */
void rain_classes_init(rain_classes *classes, uint32_t levels, uint32_t slots_per_level, double side_m);

/* Fills the slots, levels x slots_per_level of them. */
void rain_classes_fill_slots(const rain_classes *classes, uint32_t seed, virga_slot_gpu *slots);

/* Sets new densities, in a transition of `ease_s`; 0: at once. */
void rain_classes_set_rain(rain_classes *classes, const virga_sizes *sizes, double rate_mm_h, double air_density,
                           double ease_s);

/* Sets the air density: terminal speeds change at once, and velocities follow by drag. */
void rain_classes_set_air(rain_classes *classes, double air_density);

/* Sets velocities to their steady state in the wind. */
void rain_classes_settle(rain_classes *classes, const double wind[3]);

/* One tick: updates weights in a transition, velocities by drag, and travel by velocities. */
void rain_classes_tick(rain_classes *classes, const double wind[3], double tick_s);

/* Half the side of the box within which every slot is one drop; 0 if even slots of the innermost box represent
 * several. */
double rain_classes_real_drop_radius(const rain_classes *classes);

/* ---- wind.c */

typedef struct rain_wind {
    double phase; /* time, in knots of the gust noise */
} rain_wind;

void rain_wind_tick(rain_wind *wind, double tick_s, double gust_time_s);
void rain_wind_at(const rain_wind *wind, const virga_rain_settings *settings, uint32_t seed, double velocity[3]);

/* ---- walls.c */

enum { RAIN_WALL_FELL, RAIN_WALL_DRIED, RAIN_WALL_SUNK, RAIN_WALL_RAN_OFF, RAIN_WALL_WAYS };

/* Water on a square metre, in whole nanolitres. */
typedef struct rain_wall {
    uint64_t pores_nl, film_nl;
    uint64_t ways_nl[RAIN_WALL_WAYS]; /* since creation */
} rain_wall;

typedef struct rain_walls {
    rain_wall walls[VIRGA_WALL_ROWS][VIRGA_WALL_MATERIALS];
    double mm_s[VIRGA_WALL_ROWS]; /* rain that hits them at the newest tick */
    double slants[4];             /* sums of weights, of slants x and z, and of the slants' squares */
} rain_walls;

void rain_walls_default(virga_wall_material materials[VIRGA_WALL_MATERIALS]);
virga_result rain_walls_check(const virga_log *log, virga_wall_material materials[VIRGA_WALL_MATERIALS], bool *changed);

/* Water that hits each row (mm/s), by the velocities of the classes. */
void rain_walls_flux(const rain_classes *classes, double share, double mm_s[VIRGA_WALL_ROWS]);

/* Before the first tick: settings.walls.start_h of rain. */
void rain_walls_begin(rain_walls *walls, const rain_classes *classes, const virga_rain_settings *settings);
void rain_walls_tick(rain_walls *walls, const rain_classes *classes, const virga_rain_settings *settings,
                     double tick_s);

/* ---- the object */

typedef struct rain_map {
    double center[2]; /* in world coordinates, sheared about y = 0 */
    double slant[2];
    double half_m, top_m, height_m;
    double origin_m[3]; /* the camera by which it was placed. Positions are relative to it: it is redrawn alike */
} rain_map;

/* The pipelines of a target. Those of streaks come in pairs: without and with the scene's depth. */
enum {
    /* Streaks that are drawn as lines, if the context has lines. */
    RAIN_DRAW_LINES = 0,
    RAIN_DRAW_THIN = 2,
    RAIN_DRAW_WIDE = 4,
    RAIN_DRAW_HAZE = 7,
    RAIN_DRAW_GLOW = 8,
    RAIN_DRAW_ROWS = 5
};

/* Bytes of a streak: four texels. The motion of all streaks is stored behind all streaks, one texel each. */
#define RAIN_STREAK_BYTES ((uint32_t)sizeof(virga_streak_gpu) + 16)

enum { RAIN_STEP_SET = VIRGA_RAIN_MAX_VIEWS, RAIN_SETS = VIRGA_RAIN_MAX_VIEWS + 1 };

enum { RAIN_BINDINGS = 24 };

/* The statistics that are read back for one frame. */
typedef struct rain_readback {
    virga_impacts_gpu impacts;                    /* of its step */
    virga_rain_total_gpu total;                   /* of all steps before it */
    virga_prepared_gpu prepared[VIRGA_MAX_VIEWS]; /* of its prepares */
} rain_readback;

enum { RAIN_PART_STEP, RAIN_PART_PREPARE }; /* of the statistics */

enum { RAIN_DID_MAPS = VIRGA_DID_OWN }; /* the occlusion maps, in the journal */

/* What draws need of a view besides virga_effect_view. */
typedef struct rain_prepared {
    uint32_t tick_offset;
    float line_px; /* width of line streaks */
    bool haze, depth, lens;
    uint32_t glows; /* number of lamps that glow */
} rain_prepared;

/* The host's statistics of a frame's step. */
typedef struct rain_frame_stats {
    double time_s;
    uint32_t ticks;
    float wind_m_s[3];
} rain_frame_stats;

struct virga_rain {
    virga_effect base; /* first */
    virga_rain_def def;
    virga_rain_settings settings;
    virga_image wind_image;                  /* copy of what settings.wind_texture points to */
    double *table_diameter_m, *table_number; /* copies of the host's sizes */

    rain_classes *classes;
    rain_wind wind;
    double wind_now[3];
    rain_walls walls;
    uint32_t levels, groups_per_level, groups, slots;
    uint64_t ticks;         /* ticks run since creation */
    uint32_t ticks_of_step; /* ticks run in the newest step */
    double left_over_s;     /* time of the host that no tick covers yet */
    double origin[3];       /* of the newest tick */
    bool stepped, sway_on;
    double slant_smooth[VIRGA_RAIN_MAX_SLANTS][2];

    virga_buffer *slot_buffer, *slot_upload, *drop_buffer, *impact_buffer, *selection_buffer, *list_buffer, *hit_buffer,
        *hit_offset_buffer, *sway_buffer, *point_buffer, *total_buffer;
    VIRGA_PER_VIEW(virga_buffer, streak_buffer);
    VIRGA_PER_VIEW(virga_buffer, prepared_buffer);
    VIRGA_PER_VIEW(virga_buffer, order_buffer);
    virga_ring tick_ring, view_ring;
    uint32_t tick_offset, view_offset; /* offsets of the newest blocks */
    uint64_t tick_frame;               /* the frame whose part of the ring has the newest tick */
    virga_mesh_map *map;
    virga_image_2d *blank;      /* depth, if a view has no scene depth */
    virga_image_2d *blank_wind; /* a 3D image of one texel, if the host gave no wind */

    rain_map maps[VIRGA_RAIN_MAX_MAPS];
    uint32_t map_count; /* maps that are drawn and in use */
    bool maps_drawn;    /* the rain's own images match `maps` */
    bool maps_loaded;   /* a state was loaded: the next call draws all maps, most of them where they were */
    uint32_t next_map;  /* counts calls, for settings.occlusion_interval */
    uint64_t still;     /* def.occlusion_keeps: hash of the list of meshes that stand still */
    bool maps_moving;   /* meshes that move are in the maps */
    bool host_maps;
    virga_image host_map_image;

    virga_bindings *bindings;
    VkDescriptorSet step_set; /* written in the frame step_set_frame */
    uint64_t step_set_frame;
    virga_pipeline *move, *sway, *impact_near_mark, *impact_near_scan, *impact_mark, *impact_scan, *impact_write,
        *streak_mark, *streak_scan, *streak_write, *order_count, *order_scan, *order_indices, *compact, *points,
        *hit_mark, *hit_scan, *hit_count, *hit_offsets, *hit_write;

    uint64_t hits_frame; /* the frame that hits_panes belongs to */
    uint32_t hits_panes, hits_offset;
    rain_prepared prepared[VIRGA_MAX_VIEWS]; /* by index of the view */
    double unseen_s[VIRGA_MAX_VIEWS];        /* time of rain since a drop was last visible in this view */
    double unseen_at_s;                      /* time of the newest frame that was read */
    bool unseen_logged;
    rain_frame_stats frame_stats[VIRGA_MAX_FRAMES_IN_FLIGHT];
    virga_rain_stats stats;
};

/* What the passes of a tick read besides travels and weights: fits into the smallest uniform buffer range that Vulkan
 * guarantees. */
typedef struct rain_tick_tables {
    virga_tick_gpu tick;
    virga_map_gpu maps[VIRGA_RAIN_MAX_MAPS];
    virga_class_gpu classes[VIRGA_RAIN_CLASSES];
} rain_tick_tables;

/* A tick's block in its ring. Each part has a binding of its own, and its offset is a multiple of 256 bytes, the
 * largest alignment that Vulkan may require. */
typedef struct rain_tick_block {
    virga_travel_gpu travels[VIRGA_RAIN_CLASSES];
    virga_weight_gpu weights[VIRGA_RAIN_MAX_LEVELS * VIRGA_RAIN_CLASSES];
    rain_tick_tables tables;
} rain_tick_block;

_Static_assert(sizeof(rain_tick_tables) <= 16384, "a uniform buffer's range");
_Static_assert(offsetof(rain_tick_block, weights) % 256 == 0, "a storage buffer's offset");
_Static_assert(offsetof(rain_tick_block, tables) % 256 == 0, "a uniform buffer's offset");

/* A view's block in its ring. */
typedef struct rain_view_block {
    virga_view_gpu view;
    virga_rain_look_gpu look;
} rain_view_block;

/* Bytes of the hits of one pane, see rain_hits.c. */
#define RAIN_HITS_SIZE  (sizeof(virga_impacts_gpu) + VIRGA_RAIN_MAX_HITS * sizeof(virga_impact_gpu))
#define RAIN_HITS_BYTES ((RAIN_HITS_SIZE + VIRGA_RING_ALIGNMENT - 1) / VIRGA_RING_ALIGNMENT * VIRGA_RING_ALIGNMENT)

/* ---- rain.c */

/* ---- rain_descriptors.c */
extern const virga_binding_kind rain_bindings[RAIN_BINDINGS];

/* Writes a set of this frame. `scene_depth` NULL: a blank image is bound. */
VkDescriptorSet rain_write_set(virga_rain *rain, uint32_t index, const virga_image *scene_depth);
/* Binds a set for passes, with the newest tick and view. */
void rain_bind(virga_rain *rain, VkCommandBuffer cmd, VkDescriptorSet set);
/* Binds it for draws. */
void rain_bind_view(virga_rain *rain, VkCommandBuffer cmd, VkDescriptorSet set, uint32_t tick_offset,
                    uint32_t view_offset);

/* ---- rain_step.c */

/* Writes the newest tick into this frame's part of the ring. The host may overwrite an earlier frame's part before the
 * device reads it. */
void rain_keep_tick(virga_rain *rain);

/* Before a call records: fills buffers in the first call, and reads the statistics of completed frames. */
void rain_begin_frame(virga_rain *rain, VkCommandBuffer cmd);
void rain_lost(void *rain, uint64_t frame, uint32_t did);
void rain_state_loaded(void *rain);
void rain_read_statistics(void *rain, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);

/* ---- rain_occlusion.c */
virga_result rain_occlusion_create(virga_rain *rain);
uint32_t rain_class_slant(const virga_rain *rain, double diameter_m);
void rain_occlusion_tick(virga_rain *rain);
void rain_fill_maps(const virga_rain *rain, virga_tick_gpu *tick, virga_map_gpu maps[VIRGA_RAIN_MAX_MAPS]);

/* ---- rain_draw.c */
extern const virga_effect_draw rain_draws[RAIN_DRAW_ROWS];
virga_result rain_prepare(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view, double time_s,
                          virga_prepared *prepared);
virga_result rain_draw(virga_rain *rain, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared,
                       const char *call);

/* ---- rain_state.c */

struct virga_state_check;
void rain_check_state(const void *rain, struct virga_state_check *check);

#endif
