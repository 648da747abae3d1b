/* virga/scene.h - the effects of one place, wired along their events, in the order that a frame needs.
 *
 * A host that wants all of it calls scene functions; one that wants a single effect uses that effect's header alone.
 * A scene holds rain and, where asked for, the ground that it wets and the splashes that it makes there.
 */
#ifndef VIRGA_SCENE_H
#define VIRGA_SCENE_H

#include <virga/ground.h>
#include <virga/rain.h>
#include <virga/splash.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_scene virga_scene; /* opaque */

typedef struct virga_scene_def {
    uint32_t size, cookie;
    virga_rain_def rain;
    bool with_ground;        /* default false */
    virga_ground_def ground; /* seed, ticks, impacts and strides are taken from `rain` */
    bool with_splash;        /* needs the ground. Default false */
    virga_splash_def splash; /* ticks are taken from `rain`, spawns and returns from `ground` */
} virga_scene_def;

VIRGA_API virga_scene_def virga_default_scene_def(void);

/* Creates all effects of the definition. Errors as virga_context_create; *scene is NULL then. */
VIRGA_API virga_result virga_scene_create(virga_context *context, const virga_scene_def *def, virga_scene **scene);

/* Destroys the scene and its effects, sets *scene to NULL; accepts NULL. */
VIRGA_API void virga_scene_destroy(virga_scene **scene);

/* The rain of the scene, for its settings, buffers and statistics. Never NULL; owned by the scene. */
VIRGA_API virga_rain *virga_scene_rain(virga_scene *scene);

/* The ground of the scene; NULL without one. Owned by the scene. */
VIRGA_API virga_ground *virga_scene_ground(virga_scene *scene);

/* The splashes of the scene; NULL without any. Owned by the scene. */
VIRGA_API virga_splash *virga_scene_splash(virga_scene *scene);

/* What a frame needs outside rendering. */
typedef struct virga_scene_frame {
    double dt_s; /* [0; 10] host time since the last frame */
    double camera_m[3];
    double focus_m[3];               /* middle of what is near enough for ripples, see virga_ground_step_info */
    const virga_occluder *occluders; /* (optional) drawn into the occlusion maps; NULL: the last maps stay */
    uint32_t occluder_count;
    virga_ground_material_map materials; /* (optional) of the ground, over its meshes' */
    const virga_view *view; /* (optional) the view to prepare; NULL: the scene is stepped only */
} virga_scene_frame;

/* Occlusion, rain, ground, splash and prepare, in that order. The worst of their results is returned. */
VIRGA_API virga_result virga_scene_record(virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame);

/* Builds the pipelines of all effects for a target, see virga_rain_attach. */
VIRGA_API virga_result virga_scene_attach(virga_scene *scene, const virga_target *target);

/* All draws, inside rendering of `target`: splashes, then rain. A host that wants them apart (layers) draws each by its own
 * function. */
VIRGA_API virga_result virga_scene_draw(virga_scene *scene, VkCommandBuffer cmd, const virga_target *target);

#ifdef __cplusplus
}
#endif
#endif
