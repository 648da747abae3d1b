/* cull.h - which boxes a camera does not see, so that their triangles need not be drawn. */
#ifndef VIRGA_HOST_CULL_H
#define VIRGA_HOST_CULL_H

#include <stdbool.h>

typedef struct host_cull {
    float clip_from_relative[16]; /* relative: world axes, the eye at the origin */
    double eye_m[3];
    bool mirrored; /* the world is turned upside down at the plane y = mirror_m before that */
    double mirror_m;
} host_cull;

/* Whether all of a box (m, in the world) is beside the picture or before its near plane. A box that is not seen may be
 * told to be seen, and one at the very edge is. */
bool host_cull_hides(const host_cull *cull, const float low[3], const float high[3]);

#endif
