/* surroundings.h - the light around a place: the scene as it is seen from there, as harmonics.
 *
 * An environment is what is around where nothing stands. In a street, houses hide most of it: a drop there shows house
 * fronts and road. The scene is drawn from the place in six directions, and what hides the environment takes its part
 * of the harmonics.
 */
#ifndef VIRGA_HOST_SURROUNDINGS_H
#define VIRGA_HOST_SURROUNDINGS_H

#include "renderer.h"

typedef struct host_surroundings {
    host_target target; /* of one direction */
    double above_m;
} host_surroundings;

bool host_surroundings_create(host_device *device, host_surroundings *surroundings, char *error, size_t error_size);
void host_surroundings_destroy(host_device *device, host_surroundings *surroundings); /* accepts an empty one */

/* Light around `position_m`, in the order and unit of virga_lighting.environment_sh: the environment where nothing
 * hides it, which is exactly the environment's own harmonics in the open, else what stands there, dry. Meshes that
 * move or that move with the camera are left out. Surfaces are lit by the environment and by the renderer's lights.
 *
 * Draws twelve small pictures, each of which it waits for: not while a frame is being recorded. The same scene and
 * place give the same bits, whatever was drawn before. */
bool host_surroundings_light(host_surroundings *surroundings, host_renderer *renderer, const double position_m[3],
                             float sh[9][3], char *error, size_t error_size);

/* Metres straight up from there to what stands still, in the picture of direction 3 that the last call has drawn;
 * INFINITY for the sky. */
double host_surroundings_above(const host_surroundings *surroundings);

/* The camera of one of the pictures, 90 degrees wide: directions 0 to 5 look along -X, +X, -Y, +Y, -Z, +Z. */
void host_surroundings_look(const double position_m[3], uint32_t direction, host_camera *camera);

#endif
