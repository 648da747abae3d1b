/* contact.h - shade where things stand on the ground: at the foot of a post, under a car.
 *
 * The skylight's voxels are wider than a metre. A map of the ground around the camera has what they leave out: the
 * share of the sky that things up to 1.3 m high and near take away. It is made from three maps of depth: the ground
 * and all else as seen from below, and all else from above. It depends on the camera's position, and on what moves on
 * it: then it is made once in each frame.
 */
#ifndef VIRGA_HOST_CONTACT_H
#define VIRGA_HOST_CONTACT_H

#include "camera.h"
#include "descriptors.h"
#include "passes.h"
#include "shaders/frame_gpu.h"

typedef enum host_contact_map {
    HOST_CONTACT_GROUND, /* the lowest ground */
    HOST_CONTACT_UNDER,  /* undersides of all else */
    HOST_CONTACT_OVER,   /* tops of it */
    HOST_CONTACT_MAPS,
} host_contact_map;

#define HOST_CONTACT_LOOKS  5
#define HOST_CONTACT_NEAR_M 20.0 /* from the camera, it covers no more */

typedef struct host_contact {
    host_image maps[HOST_CONTACT_MAPS]; /* depth; no image: there is no wet ground */
    host_slice slices[HOST_CONTACT_MAPS];
    /* x: share of the sky that is left; y: height of the ground above low_m; z, w: from where to where above it
     * something stands */
    host_image shade;
    host_bindings bindings;
    VkSampler sampler;
    VkPipeline gather;

    bool ready;       /* it is made, so: */
    double low_m[3];  /* its low corner, and the height of depth 0 as seen from below */
    double height_m;  /* from there to depth 1 */
    double moving[3]; /* where what moves on it was, as a sum */
    double level_m;   /* about that of the ground: slanted looks move nothing there */
} host_contact;

/* `pass` draws depth alone, as the skylight's does. */
bool host_contact_create(host_device *device, VkRenderPass pass, host_contact *contact, char *error, size_t error_size);
void host_contact_destroy(host_device *device, host_contact *contact);

/* Chooses the place of the map, for ground between two heights and a scene up to `high_m`. Returns whether it must be
 * made again. */
bool host_contact_place(host_contact *contact, const host_camera *camera, const double ground_m[2], double high_m);

/* Whether a box throws shade on the map where it is placed now. */
bool host_contact_covers(const host_contact *contact, const float low_m[3], const float high_m[3]);

/* Records how it is made: for each map begin, draws for each of its looks, end; then gather. HOST_CONTACT_UNDER has
 * HOST_CONTACT_LOOKS looks, the others one. */
void host_contact_begin(const host_contact *contact, VkCommandBuffer cmd, VkRenderPass pass, host_contact_map map);
void host_contact_look(const host_contact *contact, host_contact_map map, uint32_t look, float map_from_world[16]);
void host_contact_end(VkCommandBuffer cmd);
void host_contact_gather(host_contact *contact, VkCommandBuffer cmd);

/* Fills what the plate's shaders need to sample it. */
void host_contact_frame(const host_contact *contact, const double camera_m[3], struct host_frame_gpu *frame);

#endif
