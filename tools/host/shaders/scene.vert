#version 460
// scene.vert - places a vertex. Positions are taken relative to the camera first: floats stay precise far away.
// With MIRROR it is upside down, as the mirror's plane shows it.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

layout(set = 0, binding = 0, std140) uniform Frame { host_frame_gpu frame; };

#ifdef MIRROR
#include "mirror_jitter.glsl"
#endif

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec2 in_uv;

layout(location = 0) out vec3 out_relative;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec2 out_uv;

void main()
{
    out_normal = in_normal;
    out_uv = in_uv;
    // Depth is drawn first and then tested for equality, so every pipeline must come to the same bits.
    precise vec3 relative = in_position - frame.camera.xyz;
    mat4 m = frame.clip_from_relative;
    precise vec3 position = relative;
#ifdef MIRROR
    position.y = 2.0 * frame.mirror.x - relative.y;
    // What is under the plane is not mirrored. Nor is the floor a little above it, which is seen from below.
    const float floor_m = 0.5 * smoothstep(0.5, 0.8, in_normal.y);
    gl_ClipDistance[0] = relative.y - frame.mirror.x - floor_m;
#endif
    precise vec4 clip = m[0] * position.x + m[1] * position.y + m[2] * position.z + m[3];
#ifdef MIRROR
    clip.xy = clip.xy * frame.mirror.y + clip.w * mirror_jitter();
#endif
    gl_Position = clip;
    out_relative = relative;
}
