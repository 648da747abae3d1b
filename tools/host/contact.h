/* contact.h - shade where things stand on the ground: at the foot of a post, under a car.
 *
 * The skylight's voxels are wider than a metre. A map of the ground around the camera has what they leave out: the
 * share of the sky that things up to 1.3 m high and near take away. It is made from three maps of depth: the ground
 * and all else as seen from below, and all else from above. It depends on the camera's position. What moves on it has
 * maps of its own: when it has moved only these are drawn, and only the part of the map around it is made again.
 */
#ifndef VIRGA_HOST_CONTACT_H
#define VIRGA_HOST_CONTACT_H

#include "camera.h"
#include "descriptors.h"
#include "passes.h"
#include "shaders/frame_gpu.h"

typedef enum host_contact_map {
    HOST_CONTACT_GROUND,       /* the lowest ground */
    HOST_CONTACT_UNDER,        /* undersides of all else */
    HOST_CONTACT_OVER,         /* tops of it */
    HOST_CONTACT_MOVING_UNDER, /* the same of what moves */
    HOST_CONTACT_MOVING_OVER,
    HOST_CONTACT_MAPS,
} host_contact_map;

#define HOST_CONTACT_LOOKS  5    /* of maps from below; maps from above and of the ground have one */
#define HOST_CONTACT_STEP_M 2.0  /* it moves in steps, so that it is not made in every frame */
#define HOST_CONTACT_NEAR_M 20.0 /* from the camera, it covers no more */

/* Boxes around things. */
typedef struct host_contact_box {
    double low_m[2], high_m[2]; /* x and z, of all of them together; nothing: low_m is above high_m */
    double places[3];           /* sum of where each is: it changes when one moves */
} host_contact_box;

typedef struct host_contact {
    host_image maps[HOST_CONTACT_MAPS]; /* depth; no image: there is no wet ground */
    host_slice slices[HOST_CONTACT_MAPS];
    /* x: share of the sky that is left; y: height of the ground above low_m; z, w: from where to where above it
     * something stands */
    host_image shade;
    /* By workgroup of the pass that makes it: the highest top on its texels, and within reach of them. */
    host_image tiles, near_tiles;
    host_bindings bindings;
    VkSampler sampler;
    VkPipeline find_tiles, find_near, gather;

    bool has_layout;        /* `shade` has that in which it is sampled */
    bool ready;             /* it is made, so: */
    double low_m[3];        /* its low corner, and the height of depth 0 as seen from below */
    double height_m;        /* from there to depth 1 */
    double level_m;         /* about that of level ground: slanted looks move nothing there */
    double tilt_m[3];       /* a place on sloping ground, in place of level_m ... */
    double slope[2];        /* ... and how it rises along x and z from there; 0: level_m counts */
    uint32_t moving_count;  /* meshes that are in none of the first three maps */
    host_contact_box moved; /* around what moves on it, when it was made */
} host_contact;

/* `pass` draws depth alone, as the skylight's does. */
bool host_contact_create(host_device *device, VkRenderPass pass, host_contact *contact, char *error, size_t error_size);
void host_contact_destroy(host_device *device, host_contact *contact);

/* Says how the ground slopes, before host_contact_place: a place on it, and its rise per metre along x and z. What
 * hardly slopes is level. */
void host_contact_tilt(host_contact *contact, const double middle_m[3], const double slope[2]);

/* Chooses the place of the map, for ground between two heights and a scene up to `high_m` of which so many meshes move.
 * Returns whether it must be made again. */
bool host_contact_place(host_contact *contact, const host_camera *camera, const double ground_m[2], double high_m,
                        uint32_t moving_count);

/* Adds a thing to `box` if it throws shade on the map where it is placed now. `number`: of the thing, from 1. */
void host_contact_add(const host_contact *contact, const float low_m[3], const float high_m[3], uint32_t number,
                      host_contact_box *box);

host_contact_box host_contact_no_box(void);

/* Records how it is made: for each map begin, draws for each of its looks, end; then gather. Where it has not been
 * placed anew, only the last two maps are drawn, and `moving` says where the things on them are. */
uint32_t host_contact_looks(host_contact_map map);
void host_contact_begin(const host_contact *contact, VkCommandBuffer cmd, VkRenderPass pass, host_contact_map map);
void host_contact_look(const host_contact *contact, host_contact_map map, uint32_t look, float map_from_world[16]);
void host_contact_end(VkCommandBuffer cmd);
void host_contact_gather(host_contact *contact, VkCommandBuffer cmd, bool placed, const host_contact_box *moving);

/* Records that `shade` may be bound, if it has not been made yet: then nothing reads it. */
void host_contact_bind(host_contact *contact, VkCommandBuffer cmd);

/* Fills what the plate's shaders need to sample it. */
void host_contact_frame(const host_contact *contact, const double camera_m[3], struct host_frame_gpu *frame);

#endif
