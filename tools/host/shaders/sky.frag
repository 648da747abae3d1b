#version 460
// sky.frag - the environment where nothing else was drawn; with MIRROR upside down.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

layout(set = 0, binding = 0, std140) uniform Frame { host_frame_gpu frame; };
layout(set = 0, binding = 1) uniform sampler2D sky_texture;

layout(location = 0) in vec2 in_clip;

#ifdef MIRROR
#include "mirror_jitter.glsl"
layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_near;
#else
#include "outputs.glsl"
#endif

const float PI = 3.14159265;

void main()
{
    vec2 clip = in_clip;
#ifdef MIRROR
    clip = (clip - mirror_jitter()) / frame.mirror.y;
#endif
    vec3 ray = frame.ray_z.xyz + clip.x * frame.ray_x.xyz + clip.y * frame.ray_y.xyz;
    vec3 d = normalize(ray);
#ifdef MIRROR
    d.y = -d.y;
#endif
    float u = atan(d.x, -d.z) / (2.0 * PI) + 0.5 + frame.environment.x;
    float v = acos(clamp(d.y, -1.0, 1.0)) / PI;
    vec3 color = textureLod(sky_texture, vec2(u, v), 0.0).rgb;
#ifdef MIRROR
    out_color = vec4(color, 1.0);
    out_near = 1.0 / HOST_MIRROR_FAR;
#else
    out_color = vec4(color, 1.0);
    out_normal = vec4(0.0);
    out_velocity = velocity_of(vec4(d, 0.0), vec4(d, 0.0));
    out_water = vec2(0.0);
    out_id = 0;
#endif
}
