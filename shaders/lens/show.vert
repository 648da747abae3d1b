// show.vert - one triangle over the viewport.
// One invocation per vertex.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/lens_gpu.h"

layout(scalar, set = 0, binding = 0) uniform View { virga_lens_gpu view; };

// For overlay.frag.
layout(location = 0) flat out uint has_near;
layout(location = 1) flat out vec4 near_limits;
layout(location = 2) flat out vec4 far_limits;
layout(location = 3) flat out uint layers_there;
layout(location = 4) flat out vec4 per_texel;

#include "gpu/own_view.glsl"

void main()
{
    has_near = layers_there = 0u;
    near_limits = far_limits = per_texel = vec4(0.0);
    gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 0.0, 1.0);
}
