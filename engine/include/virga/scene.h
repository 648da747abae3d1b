/* virga/scene.h - all effects together, wired along their events, in the order that a frame needs.
 *
 * A host that wants all effects calls the functions of a scene. A host that wants a single effect needs only the header
 * of that effect. A scene holds rain and, optionally, the ground that it wets, the splashes that it makes there, panes
 * with drops, and water from the particles of a simulation. Focus is a filter of the host's finished picture and has an
 * object of its own, virga/lens.h.
 */
#ifndef VIRGA_SCENE_H
#define VIRGA_SCENE_H

#include <virga/fluid.h>
#include <virga/glass.h>
#include <virga/ground.h>
#include <virga/rain.h>
#include <virga/splash.h>
#include <virga/water.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_scene virga_scene; /* opaque */

#define VIRGA_SCENE_MAX_PANES 128

typedef struct virga_scene_def {
    uint32_t size, cookie;

    virga_rain_def rain;

    /* Default false. */
    bool with_ground;

    /* seed, tick_s, max_ticks_per_step, max_impacts and occluder_strides are copied from `rain`. */
    virga_ground_def ground;

    /* Needs the ground. Default false. */
    bool with_splash;

    /* tick_s and max_ticks_per_step are copied from `rain`, max_spawns and max_returned_droplets from `ground`. */
    virga_splash_def splash;

    /* (optional) pane_count definitions, distant panes first; they are copied. Ticks are copied from `rain`. The first
     * pane gets the seed of the rain, each further one a seed that is one higher. The first rain.max_panes of them
     * catch the drops that are seen to fall (virga_rain_find_hits): with their ids, and none under cover. The others
     * get drops of their own, at the rate of the rain. In a scene with water all of them take it (glass_def.water).
     * Default NULL. */
    const virga_glass_def *panes;

    /* [0; VIRGA_SCENE_MAX_PANES]. All panes share their pipelines. Each has memory (virga_glass_estimate) and passes of
     * its own: many small panes cost as many dispatches, whatever is on them. Default 0. */
    uint32_t pane_count;

    /* Water from particles that each frame has. Default false. */
    bool with_water;

    virga_water_def water;

    /* The wheels and feet of frames throw droplets: room for 65536 of them in a frame, 3 MiB. Else they push water
     * aside and throw none. Needs ground and splashes. Default false. */
    bool with_contacts;

    /* [1; VIRGA_MAX_VIEWS] views of a frame. It is copied to all effects, and costs what their max_views costs. Default
     * 1. */
    uint32_t max_views;
} virga_scene_def;

VIRGA_API virga_scene_def virga_default_scene_def(void);

/* Returns the device memory in bytes that virga_scene_create will use at most, with eight frames in flight: the sum of
 * the estimates of its effects. As a memory_budget it is enough for all of them with the default of three frames.
 * Returns 0 for a definition that virga_scene_create would refuse. Thread-safety: any thread. */
VIRGA_API VkDeviceSize virga_scene_estimate(const virga_scene_def *def);

/* Creates all effects of the definition: water, rain, ground, splash, panes. VIRGA_DEGRADED: effects were made smaller,
 * in proportion, to fit the context's memory_budget; see the log. Errors as virga_context_create; *scene is NULL
 * then. */
VIRGA_API virga_result virga_scene_create(virga_context *context, const virga_scene_def *def, virga_scene **scene);

/* Destroys the scene and its effects, and sets *scene to NULL. Accepts NULL. */
VIRGA_API void virga_scene_destroy(virga_scene **scene);

/* Returns the rain of the scene, for its settings, buffers and statistics. Never NULL. Owned by the scene. */
VIRGA_API virga_rain *virga_scene_rain(virga_scene *scene);

/* Returns the ground of the scene, or NULL if it has none. Owned by the scene. */
VIRGA_API virga_ground *virga_scene_ground(virga_scene *scene);

/* Returns the splashes of the scene, or NULL if it has none. Owned by the scene. */
VIRGA_API virga_splash *virga_scene_splash(virga_scene *scene);

/* Returns a pane of the scene, for its shape, settings, buffers and statistics; NULL if there is none with that index.
 * Owned by the scene. */
VIRGA_API virga_glass *virga_scene_glass(virga_scene *scene, uint32_t index);

/* Returns the water of the scene, for its settings, buffers and statistics; NULL if it has none. Owned by the scene. */
VIRGA_API virga_water *virga_scene_water(virga_scene *scene);

/* Gives all effects the same light, in place of their own `lighting`; their other settings stay. It may be called at
 * any time and applies at once. Costs microseconds, so lamps may move every frame. Returns the first error
 * of the effects, else their last remark. */
VIRGA_API virga_result virga_scene_lighting_set(virga_scene *scene, const virga_lighting *lighting);

/* Where a pane is at the end of the frame, and how it moves. All zero: at rest in the open, at the world's origin and
 * with the world's axes. A host that draws more than one view, or wants panes to show the picture of this very frame,
 * prepares them itself (virga_glass_prepare). */
typedef struct virga_scene_pane {
    virga_glass_pose pose;

    /* [-1000; 1000] of the pane in the world. These three are clamped, logged, VIRGA_DEGRADED. */
    float velocity_m_s[3];

    /* [-1000; 1000] of its origin, without gravity. */
    float acceleration_m_s2[3];

    /* [-100; 100] angular velocity about the world's axes. */
    float angular_velocity_rad_s[3];

    /* [0; 1] share of the rain that does not reach the pane, in addition to what covers keep off. Above 0 the pane gets
     * drops of its own. */
    float shelter;
} virga_scene_pane;

/* Water that goes from the ground's cells into a solver of the host, and back. */
typedef struct virga_scene_exchange {
    /* Of the context of the scene, with fluid_def.max_exchanged above 0. Stepped by the host in the same frame, before
     * virga_scene_record. NULL: none. */
    virga_fluid *fluid;

    /* [-1e9; 1e9] position in the world (m) of the origin of its particles. */
    double origin_m[3];
} virga_scene_exchange;

/* What a frame needs outside rendering. */
typedef struct virga_scene_frame {
    /* [0; 10] host time since the last frame (s). */
    double dt_s;

    /* [0; 1000] device time that the ticks of this frame may take (ms). A slow frame otherwise runs more ticks, which
     * make the next one slower. The time of a tick is known from the newest measured frame, so it needs
     * virga_context_def.timings; until a frame was measured, one tick is run. At least one tick is run in each frame
     * that has one. The rest of the time is dropped, see virga_rain_step.
     * With a budget the number of ticks depends on measured times, so two runs differ: recordings and films use 0. What
     * a tick does never depends on it. 0: no budget. Default 0. */
    float step_budget_ms;

    /* Middle of what is simulated: drops, occlusion maps, ground. Normally view->position_m; it is separate because a
     * frame may have no view or several. A view farther from it than rain.range_m sees no drops, which is logged. It
     * may jump. */
    double camera_m[3];

    /* Middle of the ripple map: a point on the ground some metres ahead of the camera. All zero means the world's
     * origin. Not used without ground. */
    double ripple_center_m[3];

    /* (optional) All of the host's meshes near the camera. They are drawn into the occlusion maps and, where the window
     * of the ground moves, into its height map. NULL: the last maps stay, and cells that come into the window have no
     * ground; so give them whenever the camera has moved. */
    const virga_occluder *occluders;

    /* 0 with `occluders` not NULL: there are none, and the maps become empty. */
    uint32_t occluder_count;

    /* (optional) Materials of the ground, over those of its meshes. */
    virga_ground_material_map materials;

    /* (optional) The views to prepare: view_count of them, for virga_scene_draw_view. More than scene_def.max_views are
     * refused. They share one step: `camera_m` should be near all of them. NULL and 0: the scene is only stepped, or
     * has the one view of `view`. Each costs one prepare of each effect. */
    const virga_view *views;
    uint32_t view_count;

    /* (optional) The view to prepare, for hosts with one; not together with `views`. NULL: the scene is only
     * stepped. */
    const virga_view *view;

    /* One per pane of the scene. May be NULL if it has none. */
    const virga_scene_pane *panes;

    /* The particles of the scene's water, as virga_water_step takes them. They are read when the device executes the
     * frame. They wet the ground and the panes that they touch, see virga_ground_step_info.water and
     * virga_glass_step_info.water. All zero: there is no water in this frame. Not used in a scene without water. */
    virga_water_step_info water;

    /* (optional) The ground's water in the region of that solver's step becomes particles of the next one, and
     * particles at rest become water of the ground again, see virga_fluid_exchange_get. The ground then gets no film
     * from the particles that touch it, as all water is counted; panes get theirs as without it. Not used in a scene
     * without ground. */
    virga_scene_exchange exchange;

    /* (optional) What rolls and walks over the ground, where it is at the end of the frame: at most
     * VIRGA_GROUND_MAX_CONTACTS together, see virga/contact.h. Not used in a scene without ground. */
    const virga_wheel *wheels;
    uint32_t wheel_count;
    const virga_foot *feet;
    uint32_t foot_count;

    /* false: panes are prepared in virga_scene_record, which reads view->color if it is given. So it must hold a
     * picture by then; in a game that of the previous frame is fine. true: panes are stepped, but not prepared. Call
     * virga_scene_prepare_panes once the picture is there. Default false. */
    bool defer_panes;

    /* No picture is drawn before the next frame, as in a pre-roll: see virga_ground_step_info.is_unseen. Default
     * false. */
    bool is_unseen;
} virga_scene_frame;

/* Returns VIRGA_OK if the pipelines of all effects for stepping and preparing are built, see virga_rain_ready. */
VIRGA_API virga_result virga_scene_ready(const virga_scene *scene);

/* Records water, occlusion, rain, ground, splash, panes and prepare, in that order. Panes get rate, drop sizes, air
 * density and wind of the rain. On GPUs, without virga_context_def.timings, passes of the ground, of splashes and of
 * panes are recorded side by side after the rain, and share barriers. The results are the same bits.
 *
 * VIRGA_NOT_READY, and nothing is recorded or stepped, until virga_scene_ready returns VIRGA_OK. Also for a view of no
 * pixels; then all else is done. Otherwise it returns the first error of the effects, else their last remark.
 * VIRGA_ERROR_INVALID for a scene with panes where `frame` has none, and for numbers out of range: then nothing is
 * recorded. Also for a second call in a frame. */
VIRGA_API virga_result virga_scene_record(virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame);

/* Prepares the panes of a frame with `defer_panes`, at their own time. Outside rendering, once view->color holds the
 * picture behind them, after virga_scene_record and before virga_scene_draw. `panes`: one per pane of the scene, as in
 * the frame. Costs as virga_glass_prepare_panes, whose rule for draws holds here too. Returns the first error of them,
 * else the last remark; VIRGA_ERROR_INVALID for NULL; and VIRGA_OK for a scene without panes, where there is nothing to
 * do.
 *
 * Drops show what view->color holds. Where that lacks rain and haze, they are dark spots before haze that is bright. So
 * draw splashes and rain with their own functions, copy the picture, and prepare and draw the panes last, as the sample
 * game does. */
VIRGA_API virga_result virga_scene_prepare_panes(virga_scene *scene, VkCommandBuffer cmd, const virga_view *view,
                                                 const virga_scene_pane *panes);

/* The same for one of several views: the one at `index` of the frame's views. */
VIRGA_API virga_result virga_scene_prepare_panes_view(virga_scene *scene, VkCommandBuffer cmd, uint32_t index,
                                                      const virga_view *view, const virga_scene_pane *panes);

/* Builds the pipelines of all effects for a target, see virga_rain_attach. */
VIRGA_API virga_result virga_scene_attach(virga_scene *scene, const virga_target *target);

/* Draws everything inside rendering of `target`: splashes, then rain, then panes in the order of their definitions. A
 * host that wants them in separate layers draws each with its own function.
 *
 * VIRGA_NOT_READY: something was not prepared, or `target` was not attached to it; the rest is drawn. Unless pipelines
 * are still being built, that is logged once (VIRGA_LOG_NOT_DRAWN). VIRGA_ERROR_INVALID: the frame has several
 * views. */
VIRGA_API virga_result virga_scene_draw(virga_scene *scene, VkCommandBuffer cmd, const virga_target *target);

/* The same for one of several views: the one at `index` of the frame's views. In any order, in one pass or several.
 * VIRGA_ERROR_INVALID: the frame has fewer views. */
VIRGA_API virga_result virga_scene_draw_view(virga_scene *scene, VkCommandBuffer cmd, const virga_target *target,
                                             uint32_t index);

#ifdef __cplusplus
}
#endif
#endif
