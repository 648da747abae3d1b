/* renderer.h - draws the plate: meshes under an environment and lights, forward, depth first. */
#ifndef VIRGA_HOST_RENDERER_H
#define VIRGA_HOST_RENDERER_H

#include <virga/ground.h>
#include <virga/light.h>
#include <virga/walls.h>

#include "camera.h"
#include "environment.h"
#include "mesh.h"
#include "target.h"

typedef struct host_renderer host_renderer; /* opaque */

/* A renderer for any targets. */
bool host_renderer_create(host_device *device, host_renderer **renderer, char *error, size_t error_size);
void host_renderer_destroy(host_renderer **renderer); /* accepts a pointer to NULL; the device must be idle */

/* Adds a mesh, which must outlive the renderer. Its primitives get the next ids. */
bool host_renderer_add(host_renderer *renderer, const host_mesh *mesh, char *error, size_t error_size);

/* Sets the environment, which must outlive the renderer. Needed before the first plate. The device must be idle. */
bool host_renderer_set_environment(host_renderer *renderer, const host_environment *environment, char *error,
                                   size_t error_size);

/* Sets up to 16 lights, as many as the rain reads. The rest is ignored. */
void host_renderer_set_lights(host_renderer *renderer, const virga_light *lights, uint32_t count);

/* Sets the maps of wet ground that the shaders of meshes sample; NULL for none. The device must be idle when the images
 * change. Their position in the world may change every frame. */
void host_renderer_set_ground(host_renderer *renderer, const virga_ground_maps *maps);

/* Whether wet ground is darker where things stand on it. A map of the 20 m around the camera is drawn for that, where
 * it has moved by some metres. Off at first. */
void host_renderer_set_contact(host_renderer *renderer, bool on);

/* Whether water that stands on the ground climbs walls, posts and kerbs, as high as surface tension holds it: 3 mm. It
 * is only drawn. Needs the map above, within its 20 m. Off at first. */
void host_renderer_set_meniscus(host_renderer *renderer, bool on);

/* Sets how wet walls are, for the next plates; NULL: dry. A map of what shelters them is drawn where the camera has
 * moved by some metres or the rain has turned. The device must be idle in the first call with walls. */
bool host_renderer_set_walls(host_renderer *renderer, const virga_walls *walls, char *error, size_t error_size);

/* Turns on planar reflections: puddles then mirror the scene, not only the sky. Before each plate with a ground, a
 * picture of half the size of `target` is drawn with the world mirrored at the plane y = height_m. The reflection fades
 * out where water is 0.6 to 1.4 m above the plane, and that of the sky from 0.3 to 0.8 m on. Does nothing on devices
 * without clip distances. The device must be idle. */
bool host_renderer_set_mirror(host_renderer *renderer, const host_target *target, double height_m, char *error,
                              size_t error_size);

/* Lets sub-frames share shading, see host_camera.shares and reuse.h, for plates that are drawn into `target`. Without
 * it each is shaded. The target must not be created anew. Once, while the device is idle. */
bool host_renderer_set_reuse(host_renderer *renderer, const host_target *target, char *error, size_t error_size);

/* Draws haze over the mirror's picture, within its pass: virga_rain_draw_haze with this view and the plane in which the
 * rays of the mirror begin. */
typedef void (*host_draw_haze)(void *user, VkCommandBuffer cmd, const virga_view *view, const double plane[4]);

/* Calls `draw` while a plate with a mirror is recorded, from now on; NULL: no longer. The rain must have recorded its
 * step or prepare of the frame before the plate. */
void host_renderer_haze_mirror(host_renderer *renderer, host_draw_haze draw, void *user);

/* What virga_target_create needs for that pass, into a default definition. False: there is no mirror. */
bool host_renderer_describe_mirror(const host_renderer *renderer, virga_target_def *def);

/* What of a plate is drawn. What is not is as the pass clears it. */
typedef enum host_plate_parts {
    HOST_PLATE_WHOLE,
    HOST_PLATE_DATA,  /* no color: nothing is lit or mirrored */
    HOST_PLATE_DEPTH, /* only depth */
} host_plate_parts;

/* For host_renderer_plate from now on; at first all. What is drawn has the same bits as in a whole plate whose
 * sub-frames do not share shading; depth always has. */
void host_renderer_set_parts(host_renderer *renderer, host_plate_parts parts);

/* Records the whole plate pass. `previous` is the camera one frame ago, for velocities. Builds the pipelines that are
 * drawn with for the first time; fails if the device can not. */
bool host_renderer_plate(host_renderer *renderer, VkCommandBuffer cmd, const host_target *target,
                         const host_camera *camera, const host_camera *previous, char *error, size_t error_size);

/* Sets the mesh that is the ground on a picture which replaces the plate; it was added before. Its material has a base
 * texture, over the whole picture: red is the share of a pixel that is ground. Fails on devices without independent
 * blending. The device must be idle. Before host_renderer_set_mirror: the mirror shows the picture, by
 * its depth. */
bool host_renderer_set_footage(host_renderer *renderer, const host_target *target, const host_mesh *ground, char *error,
                               size_t error_size);

/* Records what water on that ground changes of the picture: it darkens what is soaked, and mirrors the environment and
 * other meshes where it stands. Also normal, velocity, water and id of the ground. After host_target_fill_plate. Does
 * nothing without maps of wet ground. Builds pipelines as host_renderer_plate does. */
bool host_renderer_footage(host_renderer *renderer, VkCommandBuffer cmd, const host_target *target,
                           const host_camera *camera, const host_camera *previous, char *error, size_t error_size);

/* The primitive behind an id of the plate (HOST_ID), or NULL for the sky. */
const host_primitive *host_renderer_primitive(const host_renderer *renderer, uint32_t id);

#endif
