/* boxes.c - meshes made of boxes: wipers and walls. */
#include "boxes.h"

#include <math.h>
#include <string.h>

static void subtract(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

static void cross(const float a[3], const float b[3], float out[3])
{
    const float made[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const float length = sqrtf(made[0] * made[0] + made[1] * made[1] + made[2] * made[2]);
    for (int i = 0; i < 3; i++)
        out[i] = length > 0 ? made[i] / length : 0;
}

void boxes_put(boxes *b, const float corners[8][3])
{
    static const int sides[6][4] = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    static const uint32_t triangles[6] = {0, 1, 2, 2, 3, 0};
    if (b->count == MAX_BOXES)
        return;
    for (uint32_t side = 0; side < 6; side++) {
        const uint32_t first = b->count * 24 + side * 4;
        float across[3], up[3], normal[3];
        subtract(corners[sides[side][2]], corners[sides[side][0]], across);
        subtract(corners[sides[side][3]], corners[sides[side][1]], up);
        cross(across, up, normal);
        for (uint32_t i = 0; i < 4; i++) {
            host_vertex *to = &b->vertices[first + i];
            *to = (host_vertex){.uv = {0, 0}};
            memcpy(to->position, corners[sides[side][i]], sizeof to->position);
            memcpy(to->normal, normal, sizeof normal);
        }
        for (uint32_t i = 0; i < 6; i++)
            b->indices[b->count * 36 + side * 6 + i] = first + triangles[i];
    }
    b->count++;
}

void boxes_put_cuboid(boxes *b, const float low[3], const float high[3])
{
    float corners[8][3];
    for (int i = 0; i < 8; i++) {
        corners[i][0] = (i & 3) == 1 || (i & 3) == 2 ? high[0] : low[0];
        corners[i][1] = i & 4 ? high[1] : low[1];
        corners[i][2] = (i & 3) < 2 ? high[2] : low[2]; /* counter-clockwise from above */
    }
    boxes_put(b, corners);
}

void boxes_put_bar(boxes *b, const float from[3], const float to[3], const float up[3], float width, float height)
{
    float along[3], side[3], over[3], corners[8][3];
    subtract(to, from, along);
    cross(along, up, side);
    cross(side, along, over);
    for (int i = 0; i < 8; i++)
        for (int axis = 0; axis < 3; axis++)
            corners[i][axis] = ((i & 3) == 0 || (i & 3) == 1 ? from[axis] : to[axis]) +
                               ((i & 3) == 1 || (i & 3) == 2 ? 0.5f : -0.5f) * width * side[axis] +
                               (i & 4 ? 0.5f : -0.5f) * height * over[axis];
    boxes_put(b, corners);
}
