#version 460
// skylight.vert - the scene as one direction of the sky sees it.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

layout(push_constant) uniform Draw { host_skylight_draw_gpu draw; };

layout(location = 0) in vec3 in_position;
layout(location = 2) in vec2 in_uv;

layout(location = 0) out vec2 out_uv;

void main()
{
    out_uv = in_uv;
    gl_Position = draw.map_from_world * vec4(in_position, 1.0);
}
