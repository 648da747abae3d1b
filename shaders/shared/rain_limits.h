/* rain_limits.h - limits that rain's C and GLSL share. */
#ifndef VIRGA_SHARED_RAIN_LIMITS_H
#define VIRGA_SHARED_RAIN_LIMITS_H

/* Slots per workgroup. A box is a whole number of groups, so all slots of a group have the same box. */
#define VIRGA_RAIN_GROUP        256
#define VIRGA_RAIN_BUCKETS      256 /* of the counting sort of streaks: as many as a workgroup has invocations */
#define VIRGA_RAIN_ORDER_LANES  64  /* invocations per workgroup of the prefix sum over the buckets, one per bucket */
#define VIRGA_RAIN_CLASSES      512 /* drop sizes from 0.2 to 6.8 mm, evenly spaced in the logarithm: 0.7 % apart */
#define VIRGA_RAIN_MAX_LEVELS   12  /* nested boxes */
#define VIRGA_RAIN_MAX_CASCADES 4
#define VIRGA_RAIN_MAX_SLANTS   4
#define VIRGA_RAIN_MAX_MAPS     16 /* cascades x slants */
/* Specialisation constant of rain's compute pipelines. */
#define VIRGA_RAIN_FORM(cascades, slants, sways) ((cascades) | (slants) << 3 | ((sways) ? 64 : 0))
/* Flags of rain's streak pipelines. */
#define VIRGA_RAIN_STREAKS_DEPTH 1    /* the scene's depth can be read */
#define VIRGA_RAIN_STREAKS_LINES 2    /* line primitives instead of quads of two triangles */
#define VIRGA_RAIN_STREAKS_LENS  4    /* (wide) the view has an aperture: the scene's edges are out of focus, too */
#define VIRGA_RAIN_MAX_PANES     8    /* that catch drops in a frame */
#define VIRGA_RAIN_MAX_HITS      8192 /* drops that hit a pane in a step */
#define VIRGA_RAIN_MAX_VIEWS     16   /* prepares per frame */
#define VIRGA_RAIN_MAX_TARGETS   8    /* kinds of target that are attached at once */
#define VIRGA_RAIN_ID_SLOT_BITS  22   /* low bits of an id: the slot; the rest distinguishes the drops of a slot */

#endif
