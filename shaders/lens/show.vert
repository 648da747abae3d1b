// show.vert - one triangle over the viewport.
// One invocation per vertex.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/lens_gpu.h"

layout(scalar, set = 0, binding = 0) uniform View { virga_lens_gpu view; };

layout(location = 0) flat out uint has_near; // for overlay.frag

#include "gpu/own_view.glsl"

void main()
{
    has_near = 0u;
    gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 0.0, 1.0);
}
