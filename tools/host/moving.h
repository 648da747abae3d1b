/* moving.h - where on the picture meshes are that move by themselves, and how far they go on it. Sub-frames share no
 * shading there, unless ids tell these meshes from what is behind them. */
#ifndef VIRGA_HOST_MOVING_H
#define VIRGA_HOST_MOVING_H

#include "camera.h"
#include "mesh.h"
#include "shaders/frame_gpu.h"

typedef struct host_moving {
    uint32_t count;
    struct {
        int32_t low[2], high[2]; /* pixels; the high ones are outside */
    } rects[HOST_REUSE_RECTS];
} host_moving;

/* Adds the rectangle around a mesh, from its bounds, and the one around what a mirror at the height `mirror_m` shows of
 * it. */
void host_moving_add(host_moving *moving, const host_mesh *mesh, const host_camera *camera);
void host_moving_add_mirrored(host_moving *moving, const host_mesh *mesh, const host_camera *camera, double mirror_m);

/* Whether a mesh shows what is behind it: no id tells where. */
bool host_moving_shows_behind(const host_mesh *mesh);

/* How far a mesh goes at most on the picture while the shutter is open, in pixels; 0 if it does not move. */
double host_moving_travel_px(const host_mesh *mesh, const host_camera *camera);

/* Packs them for shaders. */
void host_moving_push(const host_moving *moving, struct host_reuse_gpu *push);

#endif
