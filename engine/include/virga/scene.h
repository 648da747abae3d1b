/* virga/scene.h - the effects of one place, wired along their events, in the order that a frame needs.
 *
 * A host that wants all of it calls scene functions; one that wants a single effect uses that effect's header
 * alone. A scene holds rain and, where asked for, the ground that it wets, the splashes that it makes there, and
 * panes with drops.
 */
#ifndef VIRGA_SCENE_H
#define VIRGA_SCENE_H

#include <virga/glass.h>
#include <virga/ground.h>
#include <virga/rain.h>
#include <virga/splash.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_scene virga_scene; /* opaque */

#define VIRGA_SCENE_MAX_PANES 16

typedef struct virga_scene_def {
    uint32_t size, cookie;
    virga_rain_def rain;
    bool with_ground;        /* default false */
    virga_ground_def ground; /* seed, ticks, impacts and strides are taken from `rain` */
    bool with_splash;        /* needs the ground. Default false */
    virga_splash_def splash; /* ticks are taken from `rain`, spawns and returns from `ground` */
    const virga_glass_def *panes; /* (optional) pane_count definitions, far ones first. Ticks are taken from `rain`, and
                              * seeds: its own for the first pane, one more for each that follows. The first
                              * rain.max_panes of them catch the drops that are seen to fall (virga_rain_hits), with
                              * their ids, none under cover; the others get drops of their own at the rain's rate.
                              * Copied. Default NULL */
    uint32_t pane_count;     /* [0; VIRGA_SCENE_MAX_PANES]. Default 0 */
} virga_scene_def;

VIRGA_API virga_scene_def virga_default_scene_def(void);

/* Device memory in bytes that virga_scene_create will use at most, with eight frames in flight: the sum of its effects'
 * estimates. As a memory_budget it is enough for all of them with the default of three. 0 for a definition that it
 * would refuse. Thread-safety: any thread. */
VIRGA_API VkDeviceSize virga_scene_estimate(const virga_scene_def *def);

/* Creates all effects of the definition: rain, ground, splash, panes. VIRGA_DEGRADED where the context's memory_budget
 * made them smaller, each in proportion, see the log. Errors as virga_context_create;
 * *scene is NULL then. */
VIRGA_API virga_result virga_scene_create(virga_context *context, const virga_scene_def *def, virga_scene **scene);

/* Destroys the scene and its effects, sets *scene to NULL; accepts NULL. */
VIRGA_API void virga_scene_destroy(virga_scene **scene);

/* The rain of the scene, for its settings, buffers and statistics. Never NULL; owned by the scene. */
VIRGA_API virga_rain *virga_scene_rain(virga_scene *scene);

/* The ground of the scene; NULL without one. Owned by the scene. */
VIRGA_API virga_ground *virga_scene_ground(virga_scene *scene);

/* The splashes of the scene; NULL without any. Owned by the scene. */
VIRGA_API virga_splash *virga_scene_splash(virga_scene *scene);

/* A pane of the scene, for its shape, settings, buffers and statistics. NULL where there is none of that number.
 * Owned by the scene. */
VIRGA_API virga_glass *virga_scene_glass(virga_scene *scene, uint32_t index);

/* Gives all effects the same light, in place of each one's own `lighting`; their other settings stay. At any time, at
 * once; costs microseconds, so that lamps may move every frame. The worst of the effects' results is returned. */
VIRGA_API virga_result virga_scene_light(virga_scene *scene, const virga_lighting *lighting);

/* Where a pane is at the frame's end and how it moves; all zero: it rests at the world's origin with the world's
 * axes, in the open. A host that draws more than one view, or wants panes to show the picture of this very frame,
 * prepares them itself (virga_glass_prepare). */
typedef struct virga_scene_pane {
    virga_glass_pose pose;
    float velocity_m_s[3];      /* [-1000; 1000] of the pane in the world. These three: clamped, logged,
                                 * VIRGA_DEGRADED */
    float acceleration_m_s2[3]; /* [-1000; 1000] of its origin, without gravity */
    float turn_rad_s[3];        /* [-100; 100] about the world's axes */
    float shelter;              /* [0; 1] share of the rain that does not reach it, beside what covers keep off. Above
                                 * 0: the pane gets drops of its own */
} virga_scene_pane;

/* What a frame needs outside rendering. */
typedef struct virga_scene_frame {
    double dt_s; /* [0; 10] host time since the last frame */
    double camera_m[3]; /* middle of what is simulated: drops, occlusion maps, ground. As a rule view->position_m; given
                         * apart as there may be no view, or several; one farther off than rain.range_m sees no drops,
                         * which is logged. May jump */
    double focus_m[3];               /* middle of the map of ripples: on the ground some metres ahead of the camera. All
                                      * zero is the world's origin. Not used without ground */
    const virga_occluder *occluders; /* (optional) all of the host's near the camera: drawn into the occlusion maps, and
                                      * surveyed where the ground's window moves. NULL: the last maps stay, and what
                                      * comes into the window has no ground: give them whenever the camera has moved */
    uint32_t occluder_count;         /* 0 with `occluders` given: there are none, also in the maps */
    virga_ground_material_map materials; /* (optional) of the ground, over its meshes' */
    const virga_view *view; /* (optional) the view to prepare; NULL: the scene is stepped only */
    const virga_scene_pane *panes; /* as many as the scene has; may be NULL where it has none */
    bool panes_later;       /* panes are stepped but not prepared. Else view.color, where given, is read here already,
                             * so it must hold a picture by now: that of the frame before is fine for a game.
                             * Default false. Then call virga_scene_prepare_panes once the picture is there */
} virga_scene_frame;

/* Whether the pipelines of all effects are there for stepping and preparing, see virga_rain_ready. */
VIRGA_API virga_result virga_scene_ready(const virga_scene *scene);

/* Occlusion, rain, ground, splash, panes and prepare, in that order. Panes get the rate, sizes, air and wind of the
 * rain's settings. VIRGA_NOT_READY, and nothing recorded or stepped, until virga_scene_ready; and for a view of no
 * pixels, where all else is done. Else the worst of the effects' results is returned. VIRGA_ERROR_INVALID for a scene
 * with panes and none in `frame`, and for numbers out of range: nothing is recorded then. */
VIRGA_API virga_result virga_scene_record(virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame);

/* Prepares the panes of a frame with `panes_later`, at their own time: outside rendering, once view->color holds the
 * picture behind them, after virga_scene_record and before virga_scene_draw. `panes`: as many as the scene has, as in
 * the frame. Costs what virga_glass_prepare does for each. The worst of their results is returned;
 * VIRGA_ERROR_INVALID for NULL. Nothing to do, and VIRGA_OK, for a scene without panes. */
VIRGA_API virga_result virga_scene_prepare_panes(virga_scene *scene, VkCommandBuffer cmd, const virga_view *view,
                                                 const virga_scene_pane *panes);

/* Builds the pipelines of all effects for a target, see virga_rain_attach. */
VIRGA_API virga_result virga_scene_attach(virga_scene *scene, const virga_target *target);

/* All draws, inside rendering of `target`: splashes, then rain, then panes in the order of their definitions. A
 * host that wants them apart (layers) draws each by its own function. VIRGA_NOT_READY where something was not
 * prepared or `target` not attached; the rest is drawn. Where that is not for want of pipelines it is logged once
 * (VIRGA_LOG_NOT_DRAWN). */
VIRGA_API virga_result virga_scene_draw(virga_scene *scene, VkCommandBuffer cmd, const virga_target *target);

#ifdef __cplusplus
}
#endif
#endif
