/* shelter.h - where walls stay dry: a map of depth along the line on which driving rain came, around what the camera
 * sees. The map depends only on the camera and the rain of its frame. */
#ifndef VIRGA_HOST_SHELTER_H
#define VIRGA_HOST_SHELTER_H

#include <virga/walls.h>

#include "camera.h"
#include "passes.h"
#include "shaders/frame_gpu.h"

typedef struct host_shelter {
    host_image map; /* depth 0 at the top of the scene; no image: walls were never given */
    host_slice slice;

    bool ready;                /* it is drawn, so: */
    double low_m[2], slant[2]; /* low corner of the map, in coordinates (x, z) + slant y */
    double top_m, height_m;    /* from depth 0 to depth 1 */
    float map_from_world[16];
} host_shelter;

/* `pass` draws depth alone, as the skylight's does. */
bool host_shelter_create(host_device *device, VkRenderPass pass, host_shelter *shelter, char *error, size_t error_size);
void host_shelter_destroy(host_device *device, host_shelter *shelter);

/* Chooses the place of the map, for a scene of these heights. Returns whether it must be drawn again. */
bool host_shelter_place(host_shelter *shelter, const virga_walls *walls, const host_camera *camera, double low_m,
                        double high_m);

void host_shelter_begin(const host_shelter *shelter, VkCommandBuffer cmd, VkRenderPass pass);
void host_shelter_end(host_shelter *shelter, VkCommandBuffer cmd);

/* Fills what the plate's shaders need of it and of the walls. */
void host_shelter_frame(const host_shelter *shelter, const virga_walls *walls, const double camera_m[3],
                        struct host_frame_gpu *frame);

#endif
