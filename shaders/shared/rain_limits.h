/* rain_limits.h - sizes that rain's C and GLSL agree on. */
#ifndef VIRGA_SHARED_RAIN_LIMITS_H
#define VIRGA_SHARED_RAIN_LIMITS_H

#define VIRGA_RAIN_GROUP        256 /* slots to a workgroup: a whole number of them to a box, so a group has one box */
#define VIRGA_RAIN_BUCKETS      256 /* by which streaks are drawn in order: as many as a workgroup has lanes */
#define VIRGA_RAIN_ORDER_LANES  64  /* of a workgroup that scans them, a lane for each */
#define VIRGA_RAIN_CLASSES      512 /* sizes of drops, spaced evenly in the logarithm from 0.2 to 6.8 mm: 0.7 % apart */
#define VIRGA_RAIN_MAX_LEVELS   12  /* boxes */
#define VIRGA_RAIN_MAX_CASCADES 4
#define VIRGA_RAIN_MAX_SLANTS   4
#define VIRGA_RAIN_MAX_MAPS     16 /* cascades x slants */
/* What rain's compute pipelines are made for: their specialisation constant. */
#define VIRGA_RAIN_FORM(cascades, slants, sways) ((cascades) | (slants) << 3 | ((sways) ? 64 : 0))
/* And what its pipelines of streaks are made for. */
#define VIRGA_RAIN_STREAKS_DEPTH 1    /* the scene's depth is there to be read */
#define VIRGA_RAIN_STREAKS_LINES 2    /* lines from end to end instead of two triangles around them */
#define VIRGA_RAIN_MAX_PANES     8    /* that drops are caught on in a frame */
#define VIRGA_RAIN_MAX_HITS      8192 /* drops that meet one of them in a step */
#define VIRGA_RAIN_MAX_VIEWS     16   /* prepares a frame */
#define VIRGA_RAIN_MAX_TARGETS   8    /* kinds of target attached at once */
#define VIRGA_RAIN_ID_SLOT_BITS  22   /* low bits of an id: the slot; the rest tells the slot's drops apart */

#endif
