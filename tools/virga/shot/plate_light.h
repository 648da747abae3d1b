/* plate_light.h - a panorama that is made of a plate's picture: the light of a place that is known from one picture. */
#ifndef VIRGA_TOOL_PLATE_LIGHT_H
#define VIRGA_TOOL_PLATE_LIGHT_H

#include "host.h"

/* Fills an equirectangular panorama of `width` x `height` RGB floats, as host_environment_def has them. `rgba` is the
 * picture that `camera` sees. Inside it a direction has the picture's light. Beside it the picture goes on mirrored, by
 * angle, all around. Above and below it fades within 20 degrees into the mean of the upper and of the lower tenth of
 * its rows, as skies and floors go on. */
void plate_light_panorama(const float *rgba, const host_camera *camera, float *rgb, uint32_t width, uint32_t height);

#endif
