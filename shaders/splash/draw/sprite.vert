// sprite.vert - vertices of sprites.
// One invocation per vertex. Reads: sprites. Writes: position, colour and shape.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "gpu/vectors.glsl"
#include "shared/splash_gpu.h"
#include "shared/view_gpu.h"
layout(scalar, set = 0, binding = 1) uniform View
{
    virga_view_gpu view;
    virga_splash_look_gpu look;
};
#include "sprite_corner.glsl"

#include "gpu/own_view.glsl"

void main() { set_corner(uint(gl_VertexIndex)); }
