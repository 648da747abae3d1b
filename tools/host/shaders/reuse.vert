#version 460
// reuse.vert - one triangle over the whole picture, at the far end. From vertex 3 on another one, which is seen where
// the depth is at least HOST_REUSE_TAKEN.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

void main()
{
    const int corner = gl_VertexIndex % 3;
    const float depth = gl_VertexIndex < 3 ? 1.0 : 0.5 * HOST_REUSE_TAKEN;
    gl_Position = vec4(corner == 1 ? 3.0 : -1.0, corner == 2 ? 3.0 : -1.0, depth, 1.0);
}
