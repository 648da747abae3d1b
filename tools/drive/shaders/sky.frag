#version 460
// sky.frag - the panorama where nothing else was drawn.
#extension GL_GOOGLE_include_directive : require
#include "drive_gpu.h"

layout(set = 0, binding = 0, std140) uniform Frame { drive_frame_gpu frame; };
layout(set = 0, binding = 1) uniform sampler2D sky;

layout(location = 0) in vec2 in_clip;
layout(location = 0) out vec4 out_color;

void main()
{
    vec3 d = normalize(frame.ray_z.xyz + in_clip.x * frame.ray_x.xyz + in_clip.y * frame.ray_y.xyz);
    vec2 at = vec2(atan(d.x, -d.z) / 6.2831853 + 0.5, acos(clamp(d.y, -1.0, 1.0)) / 3.1415927);
    out_color = vec4(textureLod(sky, at, 0.0).rgb, 0.0); // alpha: 1 / distance
}
