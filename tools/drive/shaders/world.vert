#version 460
// world.vert - places a vertex relative to the camera, so that floats stay precise far from the origin.
#extension GL_GOOGLE_include_directive : require
#include "drive_gpu.h"

layout(set = 0, binding = 0, std140) uniform Frame { drive_frame_gpu frame; };
layout(push_constant) uniform Surface { drive_surface_gpu surface; };

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec2 in_uv;

layout(location = 0) out vec3 out_relative;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec2 out_uv;

void main()
{
    vec4 position = vec4(in_position, 1.0);
    out_relative = vec3(dot(surface.from_mesh[0], position), dot(surface.from_mesh[1], position),
                        dot(surface.from_mesh[2], position));
    out_normal = vec3(dot(surface.from_mesh[0].xyz, in_normal), dot(surface.from_mesh[1].xyz, in_normal),
                      dot(surface.from_mesh[2].xyz, in_normal));
    out_uv = in_uv;
    gl_Position = frame.clip_from_relative * vec4(out_relative, 1.0);
}
