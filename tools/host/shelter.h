/* shelter.h - where walls stay dry: a map of depth along the line on which driving rain came, around what the camera
 * sees. The map depends only on the camera and the rain of its frame. */
#ifndef VIRGA_HOST_SHELTER_H
#define VIRGA_HOST_SHELTER_H

#include <virga/material.h>
#include <virga/walls.h>

#include "camera.h"
#include "mesh.h"
#include "passes.h"
#include "shaders/frame_gpu.h"

typedef struct host_shelter {
    host_image map; /* depth 0 at the top of the scene; no image: walls were never given */
    host_slice slice;
    uint32_t size; /* texels along a side of the map */

    bool ready;                /* it is drawn, so: */
    double low_m[2], slant[2]; /* low corner of the map, in coordinates (x, z) + slant y */
    double top_m, height_m;    /* from depth 0 to depth 1 */
    float map_from_world[16];
} host_shelter;

/* virga_occluder.material of a surface as a wall; -1: glass, whose drops are another effect's. Where names say nothing,
 * what is smooth is painted. */
int32_t host_wall_material(const host_primitive *primitive, const host_material *material);

/* `pass` draws depth alone, as the skylight's does. The map is 32 m wide, so 2048 texels are 16 mm each. */
bool host_shelter_create(host_device *device, VkRenderPass pass, uint32_t size, host_shelter *shelter, char *error,
                         size_t error_size);
void host_shelter_destroy(host_device *device, host_shelter *shelter);

/* Chooses the place of the map, for a scene of these heights. Returns whether it must be drawn again. */
bool host_shelter_place(host_shelter *shelter, const virga_walls *walls, const host_camera *camera, double low_m,
                        double high_m);

void host_shelter_begin(const host_shelter *shelter, VkCommandBuffer cmd, VkRenderPass pass);
void host_shelter_end(host_shelter *shelter, VkCommandBuffer cmd);

/* What shaders need of the map: a point (x, y, z) relative to the camera is at (x, z) + slant y + low.xz metres from
 * its corner, and depth 0 is low.y above the camera; low.w is the height of depth 1 below it. slant: x and z of the
 * mean slant, the standard deviation, and 1 / the map's side. */
void host_shelter_coordinates(const host_shelter *shelter, const virga_walls *walls, const double camera_m[3],
                              float low[4], float slant[4]);

/* Fills what the plate's shaders need of it and of the walls. */
void host_shelter_frame(const host_shelter *shelter, const virga_walls *walls, const double camera_m[3],
                        struct host_frame_gpu *frame);

#endif
