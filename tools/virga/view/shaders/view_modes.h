/* view_modes.h - what view.frag shows, for C and for GLSL. */
#ifndef VIEW_MODES_H
#define VIEW_MODES_H

#define VIEW_PICTURE    0
#define VIEW_PLATE      1
#define VIEW_LAYER      2 /* one layer alone */
#define VIEW_OFFSETS    3 /* a layer of offsets in pixels, and coverage */
#define VIEW_DEPTH      4
#define VIEW_NORMAL     5
#define VIEW_VELOCITY   6
#define VIEW_ID         7
#define VIEW_MODE_COUNT 8

#endif
