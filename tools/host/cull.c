/* cull.c - see cull.h. */
#include "cull.h"

#include <math.h>

#define EDGE 1e-3 /* of the picture, beyond its edges: rounding moves no vertex so far */

/* Clip coordinates of corner i. */
static void project(const host_cull *cull, const float low[3], const float high[3], int i, double clip[4])
{
    const float *m = cull->clip_from_relative;
    double at[3];
    for (int axis = 0; axis < 3; axis++)
        at[axis] = (double)(i >> axis & 1 ? high[axis] : low[axis]) - cull->eye_m[axis];
    if (cull->mirrored)
        at[1] = 2 * (cull->mirror_m - cull->eye_m[1]) - at[1];
    for (int row = 0; row < 4; row++)
        clip[row] =
            (double)m[row] * at[0] + (double)m[4 + row] * at[1] + (double)m[8 + row] * at[2] + (double)m[12 + row];
}

/* What is seen has -w <= x <= w, -w <= y <= w and 0 <= z. Each is a half space: a box is outside of it if all of its
 * corners are. */
bool host_cull_hides(const host_cull *cull, const float low[3], const float high[3])
{
    unsigned outside = 0x1f;
    for (int i = 0; i < 8 && outside; i++) {
        double clip[4];
        project(cull, low, high, i, clip);
        const double edge = EDGE * fmax(fabs(clip[3]), 1);
        unsigned beyond = 0;
        for (int axis = 0; axis < 2; axis++) {
            beyond |= clip[axis] > clip[3] + edge ? 1u << (2 * axis) : 0;
            beyond |= -clip[axis] > clip[3] + edge ? 2u << (2 * axis) : 0;
        }
        beyond |= clip[2] < -edge ? 0x10 : 0;
        outside &= beyond;
    }
    return outside;
}
