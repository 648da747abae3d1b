#version 460
// swept.frag - beside its colour, a bar that moves is where it is for more than half of the time.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"
#include "swept.glsl"

layout(set = 0, binding = 0, std140) uniform Frame { host_frame_gpu frame; };
layout(push_constant) uniform Surface { host_surface_gpu surface; };

layout(location = 0) in vec3 in_relative;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec2 in_uv;

#include "outputs.glsl"

void main()
{
    if (swept_share(in_uv) <= 0.5)
        discard;
    out_color = vec4(0.0);
    out_normal = vec4(normalize(in_normal), 1.0);
    out_velocity = velocity_of(vec4(in_relative, 1.0), vec4(in_relative + frame.moved.xyz, 1.0));
    out_water = vec2(0.0);
    out_id = uint(surface.traits.z);
}
