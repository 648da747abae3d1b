#version 460
// shelter.vert - depth along the line on which driving rain comes.
#extension GL_GOOGLE_include_directive : require
#include "drive_gpu.h"

layout(push_constant) uniform Surface { drive_surface_gpu surface; }; // from_mesh: to the map

layout(location = 0) in vec3 in_position;

void main()
{
    const vec4 position = vec4(in_position, 1.0);
    gl_Position = vec4(dot(surface.from_mesh[0], position), dot(surface.from_mesh[1], position),
                       dot(surface.from_mesh[2], position), 1.0);
}
