/* swept.h - bars that move while the shutter is open, drawn over the plate by the share of that time for which a pixel
 * sees them. Drawn where it is at one time of each sub-frame, a wiper is as many lines as a picture has sub-frames.
 *
 * A bar is a ribbon over all of its way. A vertex has, as its texture coordinates, how far it is to the side of the
 * bar's middle line as the shutter opens and as it closes, in half widths of the bar: see shaders/swept.glsl. A second,
 * wider one is not seen. It tells sub-frames that share shading where the bar has been, see reuse.h. */
#ifndef VIRGA_HOST_SWEPT_H
#define VIRGA_HOST_SWEPT_H

#include "mesh.h"

/* A place on the middle line of a bar, and unit vectors at it: across the bar, and away from what it moves along. */
typedef struct host_swept_place {
    double middle[3], across[3], normal[3];
} host_swept_place;

typedef struct host_swept_bar {
    /* `count` places each along the bar, at least 2: where it is as the shutter opens and as it closes, and where it
     * was at a time before, from which on the second ribbon reaches */
    const host_swept_place *before, *open, *close;
    uint32_t count;
    double half_width_m, half_height_m; /* of its cross-section, a rectangle along `across` and `normal` */
} host_swept_bar;

/* Who looks at it. */
typedef struct host_swept_view {
    double eye_m[3];
    double margin_rad; /* the second ribbon reaches beyond its way by this all around */
} host_swept_view;

/* Of both ribbons. The last are a strip before each end of the second. */
#define HOST_SWEPT_VERTICES(count) (4 * (count) + 8)
#define HOST_SWEPT_INDICES(count)  (12 * (count))

void host_swept_put(const host_swept_bar *bar, const host_swept_view *view, host_vertex *vertices);

/* Appends the triangles of a bar whose vertices begin at `first`, and returns their number of indices. */
uint32_t host_swept_indices(uint32_t first, uint32_t count, uint32_t *indices);

#endif
