/* boxes.h - meshes made of boxes, for simple and for moving things. */
#ifndef DRIVE_BOXES_H
#define DRIVE_BOXES_H

#include "mesh.h"

/* Vertices and indices of boxes. */
#define MAX_BOXES 64
typedef struct boxes {
    host_vertex vertices[MAX_BOXES * 24];
    uint32_t indices[MAX_BOXES * 36];
    uint32_t count;
} boxes;

/* Corners 0 to 3 around the bottom, 4 to 7 above them. */
void boxes_put(boxes *b, const float corners[8][3]);
void boxes_put_cuboid(boxes *b, const float low[3], const float high[3]);

/* A bar from one point to another, with a width and a height along `up`. */
void boxes_put_bar(boxes *b, const float from[3], const float to[3], const float up[3], float width, float height);

#endif
