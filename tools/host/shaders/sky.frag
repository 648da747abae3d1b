#version 460
// sky.frag - the environment where nothing else was drawn.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

layout(set = 0, binding = 0, std140) uniform Frame { host_frame_gpu frame; };
layout(set = 0, binding = 1) uniform sampler2D sky_texture;

layout(location = 0) in vec2 in_clip;

#include "outputs.glsl"

const float PI = 3.14159265;

void main()
{
    vec3 ray = frame.ray_z.xyz + in_clip.x * frame.ray_x.xyz + in_clip.y * frame.ray_y.xyz;
    vec3 d = normalize(ray);
    float u = atan(d.x, -d.z) / (2.0 * PI) + 0.5 + frame.environment.x;
    float v = acos(clamp(d.y, -1.0, 1.0)) / PI;
    out_color = vec4(textureLod(sky_texture, vec2(u, v), 0.0).rgb, 1.0);
    out_normal = vec4(0.0);
    out_velocity = velocity_of(vec4(d, 0.0));
    out_water = vec2(0.0);
    out_id = 0;
}
