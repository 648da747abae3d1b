#version 460
// skylight.frag - holes of cut-out surfaces let the sky through.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

layout(set = 0, binding = 0) uniform sampler2D base_texture;
layout(push_constant) uniform Draw { host_skylight_draw_gpu draw; };

layout(location = 0) in vec2 in_uv;

void main()
{
    if (texture(base_texture, in_uv).a * draw.cutout.x < draw.cutout.y)
        discard;
}
